#include "emulator/studies/teach/bezier_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/text/text.h"
#include "machine/base/parse_number.h"

namespace kadr::studies {
namespace {

constexpr int kPlaces = 2000;

using ReadPoints = tl::expected<std::vector<planner::BezierVector>, std::string>;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    if (end > begin || at == ',') out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

ReadPoints read_points(const std::string& text, std::size_t& axes) {
  std::vector<planner::BezierVector> points;
  for (const std::string& word : split(text, ' ')) {
    const std::vector<std::string> numbers = split(word, ',');
    if (axes == 0) axes = numbers.size();
    if (numbers.size() != axes || axes < 2 || axes > planner::kMostBezierAxes)
      return tl::unexpected(
          fmt::format("point '{}' of '{}' has {}, {} are needed", word, text,
                      text::counted(static_cast<std::int64_t>(numbers.size()), "coordinate"),
                      axes >= 2 && axes <= planner::kMostBezierAxes ? std::to_string(axes) : "2 to 9"));
    points.emplace_back();
    for (std::size_t k = 0; k < axes; ++k) {
      const auto value = parse_number(numbers[k]);
      if (!value || !std::isfinite(*value))
        return tl::unexpected(fmt::format("'{}' in '{}' is not a number", numbers[k], text));
      points.back()[k] = *value;
    }
  }
  if (points.size() < 2 || points.size() > 4)
    return tl::unexpected(fmt::format("'{}' has {}; a curve takes 2 to 4", text,
                                      text::counted(static_cast<std::int64_t>(points.size()), "point")));
  if (std::all_of(points.begin(), points.end(), [&](const auto& p) { return p == points.front(); }))
    return tl::unexpected(fmt::format("'{}' has no length: all its points coincide", text));
  return points;
}

void add_length_tables(BezierSegment& segment, const planner::ArcLength& arc) {
  const auto add = [&](std::string name, const auto& t_of) {
    segment.length_tables.push_back({std::move(name), planner::measure_error(arc, t_of)});
  };
  for (const int degree : {5, 6, 7, 8})
    add(fmt::format("Newton degree {}", degree), planner::NewtonOfLength(arc, degree));
  const auto newton = planner::places_of(planner::NewtonOfLength(arc, 8));
  for (const int degree : {2, 3, 4, 5, 6, 7})
    add(fmt::format("minimax degree {} of Newton 8", degree), planner::MinimaxOfLength(newton, degree));
  const auto exact = planner::exact_places(arc);
  for (const int degree : {7, 12})
    add(fmt::format("minimax degree {} of the exact t(S)", degree), planner::MinimaxOfLength(exact, degree));
  for (const int parts : {16, 32, 64}) {
    const planner::ArcTable table(arc, parts);
    add(fmt::format("quintic table, {} parts", parts), [&](double u) { return table.t(u * arc.length_u()); });
  }
}

}  // namespace

tl::expected<std::vector<planner::Bezier>, std::string> read_beziers(const std::vector<std::string>& texts) {
  std::vector<planner::Bezier> curves;
  std::size_t axes = 0;
  for (const std::string& text : texts) {
    const auto points = read_points(text, axes);
    if (!points) return tl::unexpected(points.error());
    curves.emplace_back(static_cast<int>(axes), *points);
  }
  return curves;
}

BezierStudy study_beziers(const std::vector<planner::Bezier>& curves, bool paper) {
  BezierStudy study;
  for (const planner::Bezier& curve : curves) {
    const planner::ArcLength arc(curve);
    BezierSegment segment{curve, arc.length_u(), planner::smallest_radius(curve), curve.speed(0), 0, {}, 0};
    for (int i = 0; i <= kPlaces; ++i) {
      const double speed = curve.speed(static_cast<double>(i) / kPlaces);
      segment.slowest_mm = std::min(segment.slowest_mm, speed);
      segment.fastest_mm = std::max(segment.fastest_mm, speed);
    }
    segment.fitted_parts = planner::ArcTable::fitted(arc).parts();
    if (paper) add_length_tables(segment, arc);
    if (!study.segments.empty())
      study.joints.push_back(planner::joint_report(study.segments.back().curve, curve));
    study.segments.push_back(std::move(segment));
  }
  return study;
}

}  // namespace kadr::studies
