#include "emulator/studies/point_to_point/point_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/studies/point_to_point/point_report.h"
#include "emulator/text/chart_page.h"
#include "emulator/text/line_chart.h"
#include "emulator/text/text.h"

namespace kadr::studies {
namespace {

using planner::PointLaw;

constexpr std::size_t kMostLines = 6;  ///< that can be told apart in a chart
constexpr int kPointsPerPeriod = 24;
constexpr double kPeriodsAfter = 10;  ///< of vibration, shown after the end
constexpr int kMostPoints = 20'000;   ///< of a line
constexpr const char* kStyles[kMostLines] = {"a", "b", "c", "d", "e", "f"};

constexpr std::string_view kPointStyle =
    R"css(.line { fill: none; stroke-width: 1.5; stroke-linejoin: round; }
.a { stroke: var(--blue); stroke-width: 2.2; } .b { stroke: var(--orange); stroke-dasharray: 7 3; }
.c { stroke: var(--green); stroke-dasharray: 2 3; stroke-width: 2; } .d { stroke: var(--pink); }
.e { stroke: var(--brown); stroke-dasharray: 10 3 2 3; } .f { stroke: var(--ink); stroke-width: 0.9; }
pre { overflow-x: auto; font-size: 12px; }
)css";

/// The chosen law first, then those that differ most in kind.
std::vector<const PointRow*> shown(const PointStudy& study) {
  std::vector<const PointRow*> rows{&study.rows[study.chosen]};
  for (const char* kind :
       {"T, xi given", "bang-bang", "T, steepest", "ZVD", "S-curve, 1", "double", "T, least"})
    for (const PointRow& r : study.rows)
      if (rows.size() < kMostLines && &r != rows.front() && r.name.starts_with(kind)) rows.push_back(&r);
  return rows;
}

/// Moments of a law: ends of pieces twice, so that jumps stand upright, and evenly between.
template <class Value>
std::vector<text::ChartPoint> over_time(const PointLaw& law, Value&& value) {
  constexpr int kInner = 24;
  std::vector<text::ChartPoint> points{{0, 0}};
  for (const planner::PointPiece& p : law.pieces())
    for (int i = 0; i <= kInner; ++i) {
      const double t = p.duration_s * i / kInner;
      points.push_back({p.begin_s + t, value(p.at(t))});
    }
  points.push_back({law.duration_s(), 0});
  return points;
}

class PointPage {
 public:
  PointPage(const PointQuestion& question, const PointStudy& study)
      : q_(question), study_(study), rows_(shown(study)) {}

  std::string text() const {
    const planner::Load& load = study_.load;
    std::string out =
        text::chart_page_head("Laws from rest to rest", kPointStyle) + "<h1>Laws from rest to rest</h1>\n";
    out +=
        fmt::format("<pre>{}</pre>\n<pre>{}\n{}</pre>\n", text::xml_text(render_point_question(q_, study_)),
                    text::xml_text(render_point_table(study_)), text::xml_text(render_point_answer(study_)));
    out += chart("accel", "Acceleration", "acceleration, m/s2",
                 [](const planner::PointState& s) { return s.accel_u_s2; });
    out += chart("speed", "Speed", "speed, m/s", [](const planner::PointState& s) { return s.speed_u_s; });
    out += chart("power", "Power of the drive", "power, W", [&](const planner::PointState& s) {
      return load.mass_kg * s.speed_u_s * (load.inertia_ratio() * s.accel_u_s2 + load.weight_m_s2());
    });
    out += swing();
    return out + fmt::format("<p>kadr {}, <code>kadr law</code></p>\n</body>\n</html>\n", KADR_VERSION);
  }

 private:
  /// A frame wide enough for all lines, from below zero if one goes there.
  static void frame(text::LineChart& chart) {
    double low = 0, high = 0;
    for (const text::ChartLine& line : chart.lines)
      for (const text::ChartPoint& p : line.points) low = std::min(low, p.y), high = std::max(high, p.y);
    const double margin = 0.05 * (high - low);
    chart.y = text::ChartRange{low < 0 ? low - margin : 0, high + (margin > 0 ? margin : 1)};
  }

  template <class Value>
  std::string chart(const std::string& id, const std::string& title, const std::string& label,
                    Value value) const {
    text::LineChart chart;
    chart.id = id;
    chart.x_label = "t, s";
    chart.y_label = label;
    chart.description = title + " over time; the table above has the peaks.";
    for (std::size_t i = 0; i < rows_.size(); ++i)
      chart.lines.push_back({rows_[i]->name, kStyles[i], over_time(rows_[i]->law, value), 1});
    frame(chart);
    return fmt::format("<h2>{}</h2>\n{}", text::xml_text(title), text::render_svg(chart));
  }

  /// The load relative to its base, and its residual vibration, each law's end at 0.
  std::string swing() const {
    text::LineChart whole, rest;
    whole.id = "swing";
    rest.id = "rest";
    whole.x_label = "t, s";
    rest.x_label = "t after the end, s";
    whole.y_label = rest.y_label = "load relative to base, mm";
    whole.description = "The load relative to its base over time.";
    rest.description = "The load relative to its base after the end of each law.";
    const double period_s = study_.driven.mode.period_s(), after_s = kPeriodsAfter * period_s;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const PointLaw& law = rows_[i]->law;
      const double total_s = law.duration_s() + after_s;
      const int n = std::min(kMostPoints, static_cast<int>(std::ceil(kPointsPerPeriod * total_s / period_s)));
      text::ChartLine line{rows_[i]->name, kStyles[i], {}, 1};
      text::ChartLine tail = line;
      for (int k = 0; k <= n; ++k) {
        const double t = total_s * k / n;
        line.points.push_back({t, 1e3 * planner::link_at(law, study_.driven, t).link_u});
      }
      constexpr int kTail = static_cast<int>(kPeriodsAfter) * kPointsPerPeriod;
      for (int k = 0; k <= kTail; ++k) {
        const double t = after_s * k / kTail;
        tail.points.push_back({t, 1e3 * planner::link_at(law, study_.driven, law.duration_s() + t).link_u});
      }
      whole.lines.push_back(std::move(line));
      rest.lines.push_back(std::move(tail));
    }
    frame(whole);
    frame(rest);
    return fmt::format("<h2>Load</h2>\n{}<h2>What is left</h2>\n{}", text::render_svg(whole),
                       text::render_svg(rest));
  }

  const PointQuestion& q_;
  const PointStudy& study_;
  std::vector<const PointRow*> rows_;
};

}  // namespace

std::string render_point_page(const PointQuestion& question, const PointStudy& study) {
  return PointPage(question, study).text();
}

}  // namespace kadr::studies
