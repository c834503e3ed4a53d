#include "emulator/studies/time_law/law_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/text/text.h"
#include "machine/base/parse_number.h"
#include "machine/base/terminal_text.h"

namespace kadr::studies {
namespace {

constexpr std::size_t kLineLength = 100;

/// Figures of any size in a column: whole from 100 on.
std::string figure(double value) {
  if (value >= 1e9) return fmt::format("{:.3e}", value);
  return value >= 100 ? text::fixed(value, 0) : text::significant(value);
}

std::string seconds(double value) {
  return value < 1e5 ? text::fixed(value, 5) : fmt::format("{:.6g}", value);
}

const MethodOutcome* worst_between(const LawStudy& study) {
  const MethodOutcome* worst = nullptr;
  for (const MethodOutcome& o : study.outcomes)
    if (o.law && (!worst || o.check.dense_excess > worst->check.dense_excess)) worst = &o;
  return worst;
}

/// "held by  A1 acceleration 25 %   A6 acceleration 22 % ...": of the fastest law.
std::string render_shares(const LawStudy& study, const TimeLawProblem& problem) {
  const MethodOutcome* fastest = nullptr;
  for (const MethodOutcome& o : study.outcomes)
    if (o.law && (!fastest || o.law->time_s < fastest->law->time_s)) fastest = &o;
  std::string out, line = "held by  ";
  const auto add = [&](const std::string& text) {
    if (line.size() + text.size() > kLineLength) {
      out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
      line = "         ";
    }
    line += text;
  };
  for (const auto& [name, nodes] : law_shares(*fastest->law, problem)) {
    const double percent = 100 * static_cast<double>(nodes) / static_cast<double>(problem.law.nodes() - 1);
    add(fmt::format("{} {} %   ", name, text::fixed(percent, percent < 1 ? 1 : 0)));
  }
  add(fmt::format("(of nodes, {})", kLawMethods.word(fastest->method)));
  return out + line + '\n';
}

/// "axis 3 acceleration" -> 2; nothing if it is a limit of the path.
std::optional<std::size_t> axis_of(std::string_view what) {
  if (!what.starts_with("axis ")) return {};
  const auto number = parse_number(what.substr(5, what.find(' ', 5) - 5));
  if (!number) return {};
  return static_cast<std::size_t>(*number) - 1;
}

}  // namespace

std::string signed_percent(double ratio) {
  const std::string text = text::fixed(100 * ratio, 4);
  return ratio > 0 && text.find_first_of("123456789") != text.npos ? "+" + text : text;
}

std::string held_by(const planner::NodeCap& cap, std::size_t node, const TimeLawProblem& problem) {
  if (cap.reason == planner::NodeCap::kZone) return "zone";
  if (cap.reason == planner::NodeCap::kGiven && problem.program)
    return problem.program->reasons[problem.program->held_by[node]];
  if (cap.reason < 0) return "path";
  return problem.axes[static_cast<std::size_t>(cap.reason)].name;
}

std::vector<std::pair<std::string, std::size_t>> law_shares(const planner::LawSolution& law,
                                                            const TimeLawProblem& problem) {
  using Kind = planner::ActiveLimit::Kind;
  const std::vector<planner::ActiveLimit> active = planner::active_limits(problem.law, law.speed_u_s);
  std::vector<std::pair<std::string, std::size_t>> shares;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const planner::ActiveLimit& a = active[i];
    std::string name = "no limit";
    if (a.kind == Kind::speed) {
      name = held_by({0, a.of}, i + 1, problem);
      if (a.of >= 0 || a.of == planner::NodeCap::kPathFeed) name += " speed";
    } else if (a.kind == Kind::path_acceleration) {
      name = "path acceleration";
    } else if (a.kind == Kind::axis_acceleration) {
      name = problem.axes[static_cast<std::size_t>(a.of)].name + " acceleration";
    }
    const auto known =
        std::find_if(shares.begin(), shares.end(), [&](const auto& share) { return share.first == name; });
    if (known == shares.end())
      shares.emplace_back(std::move(name), 1);
    else
      ++known->second;
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return shares;
}

LimitText limit_text(const planner::LawViolation& violation, const TimeLawProblem& problem) {
  const std::string& what = violation.what;
  const auto axis = axis_of(what);
  const std::string unit = axis ? problem.axes[*axis].unit : "mm";
  const std::string name =
      axis ? fmt::format("axis {}{}", problem.axes[*axis].name, what.substr(what.find(' ', 5))) : what;
  if (what.ends_with("acceleration")) return {name, unit + "/s2"};
  if (what.ends_with("jerk")) return {name, unit + "/s3"};
  if (what == "time" || what == "cost" || what == "lower bound") return {name, "s"};
  if (what == "number of speeds" || what == "time that does not pass") return {name, ""};
  return {name, unit + "/s"};
}

std::string render_problem(const TimeLawProblem& p, std::string_view file) {
  std::string out = fmt::format(
      "{}: {}, {} nodes over {} mm, {}, accelerations held at {}\n", displayable(file), displayable(p.name),
      text::grouped(static_cast<std::int64_t>(p.law.nodes())), text::fixed(p.law.length_u(), 3),
      text::counted(static_cast<std::int64_t>(p.law.axes), "axis", "axes"),
      p.law.accel_test == planner::AccelTest::end_node ? "end nodes" : "both nodes");
  if (!p.program) return out;
  const ProgramPath& program = *p.program;
  out += fmt::format("program  {} on {}, {} pieces of lines {} to {}\n", displayable(program.program),
                     displayable(program.machine),
                     text::grouped(static_cast<std::int64_t>(program.run.last - program.run.first + 1)),
                     program.first_line, program.last_line);
  if (!program.fit) return out;
  const planner::SplineFit& fit = *program.fit;
  return out + fmt::format(
                   "spline   through {} points, {} mm from the lines at most (line {}), allowed {:g} mm; "
                   "s runs {} to {} of its length\n",
                   text::grouped(static_cast<std::int64_t>(fit.path.rows())),
                   text::significant(fit.deviation_u), program.path.segments[fit.segment].span.line,
                   program.tolerance_mm, text::fixed(1 / fit.most_slope, 6),
                   text::fixed(1 / fit.least_slope, 6));
}

std::string render_tube_log(const TubeStory& tube, const planner::LawSolution* law, double length_mm,
                            const planner::TubeOptions& options) {
  std::string out;
  bool settled = false;
  for (const planner::TubePass& pass : tube.passes) {
    out += fmt::format("Pass {}. Time per length {:.7f} s/mm (total {:.5g} s)\n", pass.number,
                       pass.time_s / length_mm, pass.time_s);
    if (pass.number > 1) out += fmt::format("Half width of the tube: {:.5g} mm/s\n", pass.half_width_u_s);
    if (pass.number > 1 && !pass.touched) out += "> No touches.\n";
    if (!pass.compared) continue;
    settled = pass.fall_percent < options.stop_percent;
    out += ">> No touches twice in a row.\n";
    if (settled) out += "--- >>> Calculation ended <<< ---\n";
    out += fmt::format(">> Fall of time per length: {:.5g} %\n", pass.fall_percent);
  }
  if (tube.passes.empty()) return out;
  if (tube.lost)
    out += fmt::format(">> The next pass finds no law at node {}, s = {} mm.\n", tube.lost->node,
                       text::fixed(tube.lost->s_u, 3));
  else if (tube.capped && !settled)
    out += fmt::format(">> Ended by the number of passes, {}.\n", options.most_passes);
  else if (!settled)
    out += fmt::format(">> Ended by the half width, the next one is below {:g} mm/s.\n",
                       options.least_half_width_u_s);
  if (law) {
    const auto best = std::find_if(tube.passes.begin(), tube.passes.end(),
                                   [&](const planner::TubePass& p) { return p.cost_s == law->cost_s; });
    if (best != tube.passes.end() && best + 1 != tube.passes.end())
      out += fmt::format(">> Pass {} has the least J and is kept.\n", best->number);
    out += fmt::format(">> FINAL TIME OF THE PATH: {:.5g} s\n", law->time_s);
  }
  out += fmt::format(">> Half width of the tube: {:.5g} mm/s\n", tube.next_half_width_mm_s());
  return out;
}

std::string render_law_table(const LawStudy& study, bool timing) {
  using Align = text::TextTable::Align;
  std::vector<text::TextTable::Column> columns = {
      {"method", Align::left}, {"T s"},        {"J s"},      {"gap %"}, {"Enorm"}, {"rms jerk"},
      {"peak jerk"},           {"at nodes %"}, {"between %"}};
  if (timing) columns.push_back({"wall ms"});
  text::TextTable table(std::move(columns));
  for (const MethodOutcome& o : study.outcomes) {
    std::vector<std::string> cells(9, "-");
    cells[0] = kLawMethods.word(o.method);
    if (o.law) {
      cells[1] = seconds(o.law->time_s);
      cells[2] = seconds(o.law->cost_s);
      if (study.lower_bound_s > 0) cells[3] = text::fixed(100 * (o.law->cost_s / study.lower_bound_s - 1), 4);
      cells[4] = figure(o.metrics.relative_energy);
      cells[5] = figure(o.metrics.rms_jerk_u_s3);
      cells[6] = figure(o.metrics.peak_jerk_u_s3);
      cells[7] = signed_percent(o.check.node_excess);
      cells[8] = signed_percent(o.check.dense_excess);
    }
    if (timing) cells.push_back(text::fixed(1000 * o.wall_s, 2));
    table.add(std::move(cells));
  }
  return table.render();
}

std::string render_law_checks(const LawStudy& study, const TimeLawProblem& problem) {
  std::string out;
  if (study.lower_bound_s > 0)
    out += fmt::format("bound    no law that keeps the limits at these nodes has J below {:.6f} s\n",
                       study.lower_bound_s);
  for (const MethodOutcome& o : study.outcomes) {
    if (!o.law)
      out += fmt::format("no law   {}: node {}, s = {} mm: {}\n", kLawMethods.word(o.method),
                         o.law.error().node, text::fixed(o.law.error().s_u, 3), o.law.error().reason);
    for (const planner::LawViolation& b : o.check.broken) {
      const LimitText text = limit_text(b, problem);
      out += fmt::format("broken   {}: {} at s = {} mm is {:.8g} {}, allowed {:.8g}\n",
                         kLawMethods.word(o.method), text.what, text::fixed(b.s_u, 3), b.value, text.unit,
                         b.limit);
    }
  }
  const MethodOutcome* worst = worst_between(study);
  if (!worst) return out;
  if (std::all_of(study.outcomes.begin(), study.outcomes.end(),
                  [](const MethodOutcome& o) { return o.check.broken.empty(); }))
    out += "limits   every law found keeps every limit at nodes, zones and both ends\n";
  if (worst->check.dense_excess > 0)
    out +=
        fmt::format("between  nodes, where nothing is promised, a limit is exceeded by {} % at most ({})\n",
                    text::fixed(100 * worst->check.dense_excess, 4), kLawMethods.word(worst->method));
  else
    out += "between  nodes, where nothing is promised, every limit is kept as well\n";
  if (problem.law.accel_test == planner::AccelTest::end_node && worst->check.dense_excess > 1e-3)
    out += "         path.accel_test = \"both_nodes\" holds both ends of every interval\n";
  return out + render_shares(study, problem);
}

void write_law_csv(const LawStudy& study, const TimeLawProblem& problem,
                   const std::function<void(std::string_view)>& sink) {
  std::string out = problem.program ? "s_mm,line,cap_mm_s,held_by" : "s_mm,cap_mm_s,held_by";
  std::vector<const planner::LawSolution*> laws;
  for (const MethodOutcome& o : study.outcomes) {
    if (!o.law) continue;
    laws.push_back(&*o.law);
    // a name of columns has no dash
    std::string name(kLawMethods.word(o.method));
    std::replace(name.begin(), name.end(), '-', '_');
    out += fmt::format(",{0}_mm_s,{0}_t_s", name);
  }
  out += '\n';
  const std::vector<planner::NodeCap> caps = planner::node_caps(problem.law);
  std::vector<double> time_s(laws.size(), 0.0);
  for (std::size_t i = 0; i < problem.law.nodes(); ++i) {
    out += fmt::format("{}", problem.law.s_u[i]);
    if (problem.program) out += fmt::format(",{}", problem.program->line[i]);
    out += fmt::format(",{},{}", caps[i].speed_u_s, held_by(caps[i], i, problem));
    for (std::size_t k = 0; k < laws.size(); ++k) {
      const std::vector<double>& v = laws[k]->speed_u_s;
      if (i > 0) time_s[k] += 2.0 * problem.law.ds_u(i) / (v[i - 1] + v[i]);
      out += fmt::format(",{},{}", v[i], time_s[k]);
    }
    out += '\n';
    if (out.size() < 60'000) continue;
    sink(out);
    out.clear();
  }
  sink(out);
}

}  // namespace kadr::studies
