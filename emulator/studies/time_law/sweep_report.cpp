#include "emulator/studies/time_law/sweep_report.h"

#include <fmt/format.h>

#include "emulator/studies/time_law/law_report.h"
#include "emulator/studies/time_law/tube_page.h"
#include "emulator/text/line_chart.h"
#include "emulator/text/text.h"

namespace kadr::studies {
namespace {

using text::Json;

std::string gap(const LevelSweep& sweep, const planner::LawSolution& law) {
  return sweep.lower_bound_s > 0 ? text::fixed(100 * (law.cost_s / sweep.lower_bound_s - 1), 4) : "-";
}

const char* ended_by(const SweepRow& row) { return row.capped ? "cap" : "rule"; }

std::vector<std::string> cells(const LevelSweep& sweep, const SweepRow& row) {
  if (!row.law) return {std::to_string(row.levels), "-", "-", "-", "-", "no law"};
  return {std::to_string(row.levels), text::fixed(row.law->time_s, 5), text::fixed(row.law->cost_s, 5),
          gap(sweep, *row.law),       std::to_string(row.passes),      ended_by(row)};
}

text::LineChart chart(const char* id, const char* y_label, std::string description) {
  text::LineChart out;
  out.id = id;
  out.x_label = "levels";
  out.y_label = y_label;
  out.description = std::move(description);
  return out;
}

}  // namespace

std::string render_sweep_table(const LevelSweep& sweep) {
  text::TextTable table({{"levels"}, {"T s"}, {"J s"}, {"gap %"}, {"passes"}, {"ended by"}});
  std::size_t capped = 0, lost = 0;
  for (const SweepRow& row : sweep.rows) {
    table.add(cells(sweep, row));
    capped += row.capped ? 1 : 0;
    lost += row.law ? 0 : 1;
  }
  return table.render() + fmt::format("{} of {} ended by the cap on passes or half width, {} found no law\n",
                                      capped, sweep.rows.size(), lost);
}

Json json_of(const LevelSweep& sweep) {
  Json rows = Json::array();
  for (const SweepRow& row : sweep.rows) {
    Json j = {{"levels", row.levels}, {"passes", row.passes}, {"capped", row.capped}, {"kept", row.kept}};
    j["time_s"] = row.law ? Json(row.law->time_s) : Json();
    j["cost_s"] = row.law ? Json(row.law->cost_s) : Json();
    rows.push_back(std::move(j));
  }
  return {{"lower_bound_s", sweep.lower_bound_s}, {"sweep", std::move(rows)}};
}

std::string sweep_csv(const LevelSweep& sweep) {
  std::string out = "levels,time_s,cost_s,gap_pct,passes,capped\n";
  for (const SweepRow& row : sweep.rows) {
    if (row.law)
      out += fmt::format(
          "{},{},{},{},{},{}\n", row.levels, row.law->time_s, row.law->cost_s,
          sweep.lower_bound_s > 0 ? fmt::format("{}", 100 * (row.law->cost_s / sweep.lower_bound_s - 1)) : "",
          row.passes, row.capped ? 1 : 0);
    else
      out += fmt::format("{},,,,{},{}\n", row.levels, row.passes, row.capped ? 1 : 0);
  }
  return out;
}

std::string render_sweep_page(const LevelSweep& sweep, const TimeLawProblem& problem, std::string_view file) {
  text::LineChart time =
      chart("time", "time of the path, s", "Time of the tube's law over the number of levels.");
  text::LineChart passes =
      chart("passes", "passes", "Passes of the tube until it ended, by its rule or by the cap.");
  text::ChartLine found{"time", "tube-law", {}, 1}, count{"passes", "line", {}, 1},
      cap{"ended by the cap", "cap", {}, 1};
  std::vector<std::vector<std::string>> rows{{"levels", "T, s", "J, s", "gap, %", "passes", "ended by"}};
  for (const SweepRow& row : sweep.rows) {
    rows.push_back(cells(sweep, row));
    const auto x = static_cast<double>(row.levels);
    if (row.law) found.points.push_back({x, row.law->time_s});
    count.points.push_back({x, static_cast<double>(row.passes)});
    cap.points.push_back({x, row.capped ? static_cast<double>(row.passes) : 0.0});
  }
  if (!found.points.empty()) time.lines.push_back(std::move(found));
  passes.lines = {std::move(cap), std::move(count)};
  const std::string title = fmt::format("{}: levels of the tube", problem.name);
  std::string out = law_page_head(title);
  out += fmt::format("<h1>{}</h1>\n<p>{}</p>\n", text::xml_text(title),
                     text::xml_text(render_problem(problem, file)));
  if (!time.lines.empty()) out += "<h2>Time over levels</h2>\n" + text::render_svg(time);
  out += "<h2>Passes over levels</h2>\n" + text::render_svg(passes);
  out += law_page_table("The tube by levels. Gap: of J to the proved bound.", rows);
  return out +
         fmt::format("<p>kadr {}, <code>kadr tube {} --sweep-levels {}..{}</code></p>\n</body>\n</html>\n",
                     KADR_VERSION, text::xml_text(file), sweep.rows.front().levels, sweep.rows.back().levels);
}

}  // namespace kadr::studies
