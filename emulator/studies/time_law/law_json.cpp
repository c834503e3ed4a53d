#include "emulator/studies/time_law/law_report.h"

namespace kadr::studies {
namespace {

using text::Json;

Json failure_json(const planner::LawFailure& failure) {
  return {{"node", failure.node}, {"s_mm", failure.s_u}, {"reason", failure.reason}};
}

Json outcome_json(const MethodOutcome& o, const LawStudy& study, const TimeLawProblem& problem) {
  Json j;
  j["method"] = kLawMethods.word(o.method);
  j["failure"] = o.law ? Json(nullptr) : failure_json(o.law.error());
  if (!o.law) return j;
  j["time_s"] = o.law->time_s;
  j["cost_s"] = o.law->cost_s;
  j["gap_to_bound"] = study.lower_bound_s > 0 ? Json(o.law->cost_s / study.lower_bound_s - 1) : Json(nullptr);
  j["iterations"] = o.law->iterations;
  j["relative_energy"] = o.metrics.relative_energy;
  j["curve_energy"] = o.metrics.curve_energy;
  j["rms_jerk_mm_s3"] = o.metrics.rms_jerk_u_s3;
  j["peak_jerk_mm_s3"] = o.metrics.peak_jerk_u_s3;
  j["node_excess"] = o.check.node_excess;
  j["between_excess"] = o.check.dense_excess;
  j["held_by"] = Json::array();
  for (const auto& [name, nodes] : law_shares(*o.law, problem))
    j["held_by"].push_back({{"limit", name}, {"nodes", nodes}});
  j["broken"] = Json::array();
  for (const planner::LawViolation& b : o.check.broken) {
    const LimitText text = limit_text(b, problem);
    j["broken"].push_back(
        {{"what", text.what}, {"s_mm", b.s_u}, {"value", b.value}, {"limit", b.limit}, {"unit", text.unit}});
  }
  return j;
}

Json tube_json(const TubeStory& tube) {
  Json passes = Json::array();
  for (const planner::TubePass& p : tube.passes)
    passes.push_back({{"number", p.number},
                      {"time_s", p.time_s},
                      {"cost_s", p.cost_s},
                      {"half_width_mm_s", p.half_width_u_s},
                      {"touched", p.touched},
                      {"fall_pct", p.compared ? Json(p.fall_percent) : Json(nullptr)}});
  return {{"passes", std::move(passes)},
          {"next_half_width_mm_s", tube.next_half_width_mm_s()},
          {"capped", tube.capped},
          {"lost", tube.lost ? failure_json(*tube.lost) : Json(nullptr)}};
}

Json program_json(const TimeLawProblem& problem) {
  if (!problem.program) return nullptr;
  const ProgramPath& p = *problem.program;
  Json j = {
      {"file", p.program},          {"machine", p.machine},     {"pieces", p.run.last - p.run.first + 1},
      {"first_line", p.first_line}, {"last_line", p.last_line}, {"fit", nullptr}};
  if (!p.fit) return j;
  j["fit"] = {
      {"points", p.fit->path.rows()},           {"deviation_mm", p.fit->deviation_u},
      {"deviation_s_mm", p.fit->deviation_s_u}, {"deviation_line", p.path.segments[p.fit->segment].span.line},
      {"tolerance_mm", p.tolerance_mm},         {"least_slope", p.fit->least_slope},
      {"most_slope", p.fit->most_slope}};
  return j;
}

}  // namespace

Json json_of(const LawStudy& study, const TimeLawProblem& problem) {
  Json axes = Json::array();
  for (const PathAxis& axis : problem.axes) axes.push_back({{"name", axis.name}, {"unit", axis.unit}});
  Json methods = Json::array();
  for (const MethodOutcome& o : study.outcomes) methods.push_back(outcome_json(o, study, problem));
  Json j;
  j["name"] = problem.name;
  j["axes"] = std::move(axes);
  j["program"] = program_json(problem);
  j["nodes"] = problem.law.nodes();
  j["length_mm"] = problem.law.length_u();
  j["accel_test"] = problem.law.accel_test == planner::AccelTest::end_node ? "end_node" : "both_nodes";
  j["lower_bound_s"] = study.lower_bound_s > 0 ? Json(study.lower_bound_s) : Json(nullptr);
  j["methods"] = std::move(methods);
  j["tube"] = study.tube.passes.empty() ? Json(nullptr) : tube_json(study.tube);
  j["inner_points"] = study.inner_points;
  return j;
}

}  // namespace kadr::studies
