#include "emulator/studies/time_law/tube_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/studies/time_law/law_report.h"
#include "emulator/text/chart_page.h"
#include "emulator/text/line_chart.h"
#include "emulator/text/text.h"

namespace kadr::studies {
namespace {

constexpr std::size_t kTubesShown = 3;  ///< the last passes, whose edges are drawn
constexpr double kCloseUp = 0.025;      ///< of the length, to either side
constexpr std::size_t kTableRows = 24;  ///< of the tables beside the charts, less one
constexpr double kFaintest = 0.4;       ///< opacity of the first pass between

constexpr std::string_view kStyle =
    R"css(.line { fill: none; stroke: var(--blue); stroke-width: 1.3; stroke-linejoin: round; }
.cap { stroke: var(--soft); stroke-width: 1; } .first { stroke: var(--orange); stroke-dasharray: 7 3; }
.last { stroke-width: 2.2; } .tube { fill: var(--band); fill-opacity: 0.16; stroke: var(--band); stroke-width: 0.8; }
.classical { stroke: var(--orange); stroke-dasharray: 7 3; stroke-width: 1.8; } .tube-law { stroke-width: 1.6; }
.greedy { stroke: var(--green); stroke-dasharray: 2 3; stroke-width: 2; }
.optimum { stroke: var(--pink); stroke-width: 5; stroke-opacity: 0.5; }
.certified { stroke: var(--ink); stroke-width: 0.9; } .jerk-limited { stroke: var(--brown); stroke-width: 2; stroke-dasharray: 10 3 2 3; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { padding: 0.15rem 0.6rem; text-align: right; border-bottom: 1px solid var(--rule); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
caption { text-align: left; color: var(--soft); padding-bottom: 0.25rem; }
summary { cursor: pointer; color: var(--soft); margin: 0.25rem 0; } pre { overflow-x: auto; font-size: 13px; }
)css";

/// A table of HTML; the first row is its head.
std::string html_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows) {
  std::string out =
      fmt::format("<div class=\"scroll\"><table><caption>{}</caption>\n", text::xml_text(caption));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += "<tr>";
    for (std::size_t k = 0; k < rows[i].size(); ++k)
      out += i == 0   ? fmt::format("<th scope=\"col\">{}</th>", text::xml_text(rows[i][k]))
             : k == 0 ? fmt::format("<th scope=\"row\">{}</th>", text::xml_text(rows[i][k]))
                      : fmt::format("<td>{}</td>", text::xml_text(rows[i][k]));
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string folded_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows) {
  return fmt::format("<details><summary>{} as numbers</summary>\n{}</details>\n", text::xml_text(caption),
                     html_table(caption, rows));
}

class Page {
 public:
  Page(const LawStudy& study, const TimeLawProblem& problem)
      : study_(study), p_(problem), caps_(planner::node_caps(problem.law)) {}

  std::string text(std::string_view file) {
    std::string out = law_page_head(fmt::format("{} - time laws", p_.name));
    out += fmt::format("<h1>{}</h1>\n<p>{}</p>\n", text::xml_text(p_.name),
                       text::xml_text(render_problem(p_, file)));
    out += methods();
    const bool passes = !study_.tube.profiles_mm_s.empty();
    out += passes ? pass_charts() : method_chart_over_path();
    out += time_chart();
    out += fmt::format("<h2>What the check found</h2>\n<pre>{}</pre>\n",
                       text::xml_text(render_law_checks(study_, p_)));
    if (passes) out += pass_table();
    return out + fmt::format("<p>kadr {}, <code>kadr tube {}</code></p>\n</body>\n</html>\n", KADR_VERSION,
                             text::xml_text(file));
  }

 private:
  std::vector<text::ChartPoint> over_path(const std::vector<double>& speed_mm_s) const {
    std::vector<text::ChartPoint> points(speed_mm_s.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {p_.law.s_u[i], speed_mm_s[i]};
    return points;
  }

  text::ChartLine cap_line() const {
    text::ChartLine line{"highest speed of a node", "cap", {}, 1};
    for (std::size_t i = 0; i < caps_.size(); ++i) line.points.push_back({p_.law.s_u[i], caps_[i].speed_u_s});
    return line;
  }

  /// Edges of the tube of a pass: around the previous profile, within 0 and the caps.
  text::ChartBand tube_band(std::size_t pass) const {
    text::ChartBand band{"", "tube", {}, {}};
    const std::vector<double>& middle = study_.tube.profiles_mm_s[pass - 1];
    const double half = study_.tube.passes[pass].half_width_u_s;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      const bool end = i == 0 || i + 1 == middle.size();
      const double s = p_.law.s_u[i];
      band.lower.push_back({s, end ? middle[i] : std::max(middle[i] - half, 0.0)});
      band.upper.push_back({s, end ? middle[i] : std::min(middle[i] + half, caps_[i].speed_u_s)});
    }
    return band;
  }

  /// Lines of all passes from `first` on, and the tubes of the last ones.
  text::LineChart pass_chart(const std::string& id, std::size_t first) const {
    text::LineChart chart;
    chart.id = id;
    chart.x_label = "s, mm";
    chart.y_label = "speed along the path, mm/s";
    const auto& profiles = study_.tube.profiles_mm_s;
    const std::size_t count = profiles.size();
    for (std::size_t pass = std::max<std::size_t>(1, count - std::min(count, kTubesShown)); pass < count;
         ++pass)
      chart.bands.push_back(tube_band(pass));
    if (!chart.bands.empty())
      chart.bands.back().label = chart.bands.size() == 1 ? fmt::format("tube of pass {}", count)
                                                         : fmt::format("tubes of passes {} to {}",
                                                                       count - chart.bands.size() + 1, count);
    chart.lines.push_back(cap_line());
    for (std::size_t pass = first; pass < count; ++pass) {
      const bool last = pass + 1 == count;
      text::ChartLine line{"", last ? "last" : pass == 0 ? "first" : "pass", over_path(profiles[pass]), 1};
      if (pass == 0 || last) line.label = fmt::format("pass {}", pass + 1);
      if (pass > 0 && !last) {
        const std::size_t from = std::max<std::size_t>(first, 1);
        line.opacity = kFaintest + (0.85 - kFaintest) * static_cast<double>(pass - from) /
                                       static_cast<double>(count - from);
        if (pass + 2 == count)
          line.label = from == pass ? fmt::format("pass {}", pass + 1)
                                    : fmt::format("passes {} to {}, the faintest first", from + 1, pass + 1);
      }
      chart.lines.push_back(std::move(line));
    }
    return chart;
  }

  std::string pass_charts() const {
    text::LineChart chart = pass_chart("passes", 0);
    const std::size_t count = study_.tube.profiles_mm_s.size();
    chart.description = fmt::format(
        "Speed along the path in each of {} passes of the tube, below the highest "
        "speed of every node. The table below has the numbers.",
        count);
    std::string out = fmt::format(
        "<h2>Speed along the path, pass by pass</h2>\n<p>Each pass looks for the best "
        "law in a tube around the previous one.</p>\n{}",
        text::render_svg(chart));
    std::vector<std::vector<std::string>> rows{{"s, mm", "highest"}};
    for (std::size_t pass = 0; pass < count; ++pass) rows[0].push_back(fmt::format("pass {}", pass + 1));
    for (const std::size_t i : table_nodes()) {
      rows.push_back({text::fixed(p_.law.s_u[i], 1), text::fixed(caps_[i].speed_u_s, 2)});
      for (const auto& profile : study_.tube.profiles_mm_s) rows.back().push_back(text::fixed(profile[i], 2));
    }
    out += folded_table("Speed in mm/s in each pass", rows);
    return count > 1 ? out + close_up() : out;
  }

  /// The last passes where they differ most.
  std::string close_up() const {
    const auto& profiles = study_.tube.profiles_mm_s;
    const std::size_t count = profiles.size();
    const std::vector<double>&last = profiles[count - 1], &before = profiles[count - 2];
    std::size_t at = 0;
    for (std::size_t i = 0; i < last.size(); ++i)
      if (std::fabs(last[i] - before[i]) > std::fabs(last[at] - before[at])) at = i;
    text::LineChart chart = pass_chart("closeup", count - std::min(count, kTubesShown));
    const double length = p_.law.length_u(), width = 2 * kCloseUp * length;
    const double low =
        std::clamp(p_.law.s_u[at] - kCloseUp * length, p_.law.s_u.front(), p_.law.s_u.back() - width);
    chart.x = text::ChartRange{low, low + width};
    text::ChartRange y{last[at], last[at]};
    for (const text::ChartBand& band : chart.bands)
      for (std::size_t i = 0; i < band.lower.size(); ++i) {
        if (band.lower[i].x < low || band.lower[i].x > low + width) continue;
        y = {std::min(y.low, band.lower[i].y), std::max(y.high, band.upper[i].y)};
      }
    const double margin = 0.06 * (y.high - y.low);
    chart.y = text::ChartRange{y.low - margin, y.high + margin};
    chart.description =
        fmt::format("The same near s = {} mm, where the last two passes differ most: by {} mm/s.",
                    text::fixed(p_.law.s_u[at], 1), text::fixed(std::fabs(last[at] - before[at]), 2));
    return fmt::format("<h2>Close-up of the last passes</h2>\n<p>{}</p>\n{}", chart.description,
                       text::render_svg(chart));
  }

  std::string method_chart_over_path() const {
    text::LineChart chart;
    chart.id = "path";
    chart.x_label = "s, mm";
    chart.y_label = "speed along the path, mm/s";
    chart.description = "Speed along the path of every method, below the highest speed of every node.";
    chart.lines.push_back(cap_line());
    std::vector<std::vector<std::string>> rows{{"s, mm", "highest"}};
    for (const std::size_t i : table_nodes())
      rows.push_back({text::fixed(p_.law.s_u[i], 1), text::fixed(caps_[i].speed_u_s, 2)});
    for (const MethodOutcome* o : found()) {
      chart.lines.push_back(
          {std::string(kLawMethods.word(o->method)), style(o->method), over_path(o->law->speed_u_s), 1});
      rows[0].emplace_back(kLawMethods.word(o->method));
      std::size_t row = 0;
      for (const std::size_t i : table_nodes()) rows[++row].push_back(text::fixed(o->law->speed_u_s[i], 2));
    }
    return fmt::format("<h2>Speed along the path</h2>\n{}{}", text::render_svg(chart),
                       folded_table("Speed in mm/s of every method", rows));
  }

  std::string time_chart() const {
    text::LineChart chart;
    chart.id = "time";
    chart.x_label = "t, s";
    chart.y_label = "speed along the path, mm/s";
    chart.description = "Speed along the path over time, of every method.";
    double longest_s = 0;
    for (const MethodOutcome* o : found()) {
      chart.lines.push_back(
          {fmt::format("{}, {} s", kLawMethods.word(o->method), text::fixed(o->law->time_s, 4)),
           style(o->method), over_time(*o->law), 1});
      longest_s = std::max(longest_s, o->law->time_s);
    }
    if (chart.lines.empty()) return "<p>No method found a law.</p>\n";
    std::vector<std::vector<std::string>> rows{{"t, s"}};
    for (std::size_t k = 0; k <= kTableRows; ++k) {
      const double t = longest_s * static_cast<double>(k) / kTableRows;
      rows.push_back({text::fixed(t, 4)});
      for (const text::ChartLine& line : chart.lines)
        rows.back().push_back(t <= line.points.back().x ? text::fixed(value_at(line.points, t), 2) : "");
    }
    for (const MethodOutcome* o : found()) rows[0].emplace_back(kLawMethods.word(o->method));
    return fmt::format("<h2>Speed over time</h2>\n{}{}", text::render_svg(chart),
                       folded_table("Speed in mm/s over time", rows));
  }

  /// Acceleration is constant between nodes, so speed is linear in time.
  std::vector<text::ChartPoint> over_time(const planner::LawSolution& law) const {
    std::vector<text::ChartPoint> points{{0.0, law.speed_u_s[0]}};
    for (std::size_t i = 1; i < law.speed_u_s.size(); ++i) {
      const double v0 = law.speed_u_s[i - 1], v1 = law.speed_u_s[i];
      points.push_back({points.back().x + 2.0 * p_.law.ds_u(i) / (v0 + v1), v1});
    }
    return points;
  }

  static double value_at(const std::vector<text::ChartPoint>& points, double x) {
    const auto before = [](const text::ChartPoint& p, double at) { return p.x < at; };
    const auto next = std::lower_bound(points.begin() + 1, points.end() - 1, x, before);
    const text::ChartPoint &a = *(next - 1), &b = *next;
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
  }

  std::string methods() const {
    std::vector<std::vector<std::string>> rows{{"method", "T, s", "J, s", "gap, %", "relative energy",
                                                "rms jerk", "peak jerk", "at nodes, %", "between, %"}};
    for (const MethodOutcome& o : study_.outcomes) {
      rows.push_back({std::string(kLawMethods.word(o.method))});
      if (!o.law) {
        rows.back().push_back("no law");
        continue;
      }
      const auto bound = study_.lower_bound_s;
      for (const std::string& cell :
           {text::fixed(o.law->time_s, 5), text::fixed(o.law->cost_s, 5),
            bound > 0 ? text::fixed(100 * (o.law->cost_s / bound - 1), 4) : std::string("-"),
            text::fixed(o.metrics.relative_energy, 0), text::fixed(o.metrics.rms_jerk_u_s3, 0),
            text::fixed(o.metrics.peak_jerk_u_s3, 0), signed_percent(o.check.node_excess),
            signed_percent(o.check.dense_excess)})
        rows.back().push_back(cell);
    }
    return html_table(
        "Laws found. Gap: of J to the proved bound. Jerk in mm/s3. At nodes and between them: how far the "
        "highest value is above its limit.",
        rows);
  }

  std::string pass_table() const {
    std::vector<std::vector<std::string>> rows{
        {"pass", "T, s", "J, s", "half width, mm/s", "touches", "fall, %"}};
    for (const planner::TubePass& pass : study_.tube.passes)
      rows.push_back({std::to_string(pass.number), text::fixed(pass.time_s, 5), text::fixed(pass.cost_s, 5),
                      pass.number > 1 ? text::fixed(pass.half_width_u_s, 3) : "-",
                      pass.number == 1 ? "-"
                      : pass.touched   ? "yes"
                                       : "no",
                      pass.compared ? text::fixed(pass.fall_percent, 4) : "-"});
    return "<h2>Passes of the tube</h2>\n" + html_table("Passes of the tube", rows);
  }

  /// Nodes of the tables: evenly by number, both ends among them.
  std::vector<std::size_t> table_nodes() const {
    std::vector<std::size_t> nodes;
    const std::size_t last = p_.law.nodes() - 1, rows = std::min(last, kTableRows);
    for (std::size_t k = 0; k <= rows; ++k) nodes.push_back(last * k / rows);
    return nodes;
  }

  /// Outcomes that are laws; wide lines first, so that narrow ones lie on them.
  std::vector<const MethodOutcome*> found() const {
    std::vector<const MethodOutcome*> list;
    for (const MethodOutcome& o : study_.outcomes)
      if (o.law) list.push_back(&o);
    std::stable_partition(list.begin(), list.end(),
                          [](const MethodOutcome* o) { return o->method == PlanMethod::optimum; });
    return list;
  }

  static std::string style(PlanMethod method) {
    return method == PlanMethod::tube ? "tube-law" : std::string(kLawMethods.word(method));
  }

  const LawStudy& study_;
  const TimeLawProblem& p_;
  std::vector<planner::NodeCap> caps_;
};

}  // namespace

std::string law_page_head(std::string_view title) { return text::chart_page_head(title, kStyle); }

std::string law_page_table(const std::string& caption, const std::vector<std::vector<std::string>>& rows) {
  return html_table(caption, rows);
}

std::string render_tube_page(const LawStudy& study, const TimeLawProblem& problem, std::string_view file) {
  return Page(study, problem).text(file);
}

}  // namespace kadr::studies
