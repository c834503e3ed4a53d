#include "emulator/cycle/operator/place_on_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "machine/file/tree.h"

namespace kadr::cycle {
namespace {

/// Where motions begin, by block and by line of the program.
class MotionStarts {
 public:
  MotionStarts(const planner::Path& path, std::uint32_t program) {
    const std::size_t begin = path.approach_size();
    // the approach is none of the program's blocks
    const std::uint32_t first = begin > 0 ? path.segments[begin - 1].block + 1 : 0;
    for (std::size_t i = begin; i < path.size(); i = path.block_end(i)) {
      const planner::PathSegment& s = path.segments[i];
      of_block_.try_emplace(s.block - first, i);
      if (s.span.file == program) of_line_[s.span.line].push_back(i);
    }
  }

  /// First segment of the motion that a step names, or nothing.
  std::optional<std::size_t> find(const PathPlace& place) const {
    const auto number = static_cast<std::uint32_t>(place.number);
    if (place.kind == PathPlace::Kind::block) {
      const auto block = of_block_.find(number);
      return block == of_block_.end() || place.pass != 1 ? std::nullopt : std::optional(block->second);
    }
    const auto line = of_line_.find(number);
    const auto pass = static_cast<std::size_t>(place.pass);
    if (line == of_line_.end() || pass < 1 || pass > line->second.size()) return {};
    return line->second[pass - 1];
  }

 private:
  std::unordered_map<std::uint32_t, std::size_t> of_block_;
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> of_line_;
};

/// Path length s at a distance after the beginning of a segment, the distance as feeds measure it.
std::optional<double> ahead_of(const planner::Path& path, std::size_t segment, double distance_u) {
  for (; segment < path.size(); ++segment) {
    const planner::PathSegment& s = path.segments[segment];
    if (distance_u <= s.feed_length_u)
      return path.start_s_u[segment] + s.length_u * (distance_u / s.feed_length_u);
    distance_u -= s.feed_length_u;
  }
  return {};
}

std::string place_text(const PathPlace& place) {
  switch (place.kind) {
    case PathPlace::Kind::block:
      return fmt::format("block {:.0f}", place.number);
    case PathPlace::Kind::line:
      return place.pass > 1 ? fmt::format("pass {} of line {:.0f}", place.pass, place.number)
                            : fmt::format("line {:.0f}", place.number);
    case PathPlace::Kind::length:
      break;
  }
  return fmt::format("path length {:.6g}", place.number);
}

}  // namespace

std::vector<double> place_on_path(const std::vector<OperatorStep>& steps, const planner::Path& path,
                                  std::uint32_t blocks, std::uint32_t program, Diagnostics& diagnostics) {
  std::vector<double> places_u(steps.size(), 0.0);
  if (std::none_of(steps.begin(), steps.end(), [](const OperatorStep& s) { return s.place.has_value(); }))
    return places_u;
  const MotionStarts starts(path, program);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!steps[i].place) continue;
    const PathPlace& place = *steps[i].place;
    std::optional<std::size_t> segment = path.approach_size();
    double distance_u = place.after_u;
    if (place.kind == PathPlace::Kind::length)
      distance_u += place.number;
    else
      segment = starts.find(place);
    const auto path_u = segment ? ahead_of(path, *segment, distance_u) : std::nullopt;
    if (path_u) {
      places_u[i] = *path_u;
      continue;
    }
    Diagnostic d = machine::file_diagnostic(
        Code::scenario_step, steps[i].span,
        segment ? fmt::format("{} and {:.6g} after it is beyond the path", place_text(place), place.after_u)
                : fmt::format("{} of the program starts no motion", place_text(place)));
    d.notes.push_back(fmt::format("the program has {} motion blocks and a path of {:.6g}", blocks,
                                  path.length_u() - path.program_begin_u()));
    d.help = "kadr plan shows the lines that move";
    diagnostics.add(std::move(d));
  }
  return places_u;
}

}  // namespace kadr::cycle
