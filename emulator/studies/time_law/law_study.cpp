#include "emulator/studies/time_law/law_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "emulator/text/text.h"
#include "machine/file/tree.h"

namespace kadr::studies {
namespace {

using planner::LawResult;

constexpr double kMostMemory_bytes = 4e9;
constexpr double kMostTransitions = 1e12;  ///< planner::LawWork
constexpr double kMostJerkRows = 1e7;
constexpr double kManyDerivatives =
    1e6;  ///< nodes times axes, from which on fewer inner points are looked at

planner::LawSettings settings_of(const TimeLawProblem& problem, bool keeps_profiles) {
  return {problem.classical_levels, problem.tube, keeps_profiles, problem.jerk_mm_s3};
}

LawResult solve(const TimeLawProblem& problem, PlanMethod method, bool keep_profiles, TubeStory& story,
                const StudyProgress& progress) {
  const auto solver = planner::law_method(method).solver(settings_of(problem, keep_profiles));
  if (progress)
    solver->on_progress([&](std::string_view stage, double done) { progress(method, stage, done); });
  LawResult law = solver->solve(problem.law);
  if (const auto* tube = dynamic_cast<const planner::TubeDp*>(solver.get()))
    story = {tube->passes(), tube->profiles(), tube->lost(), tube->capped()};
  return law;
}

void measure(const TimeLawProblem& problem, std::uint32_t inner_points, MethodOutcome& out) {
  if (!out.law) return;
  out.metrics = planner::law_metrics(problem.law, *out.law, problem.scale_mm_s());
  planner::LawCheckOptions options;
  options.inner_points = inner_points;
  out.check = planner::verify_law(problem.law, *out.law, problem.path(), options);
  if (out.method != PlanMethod::jerk_limited) return;
  const double jerk = planner::node_jerk_u_s3(problem.law, out.law->speed_u_s);
  if (!(jerk <= *problem.jerk_mm_s3 * (1 + options.tolerance)))
    out.check.broken.push_back({"path jerk", problem.law.s_u.front(), jerk, *problem.jerk_mm_s3});
}

}  // namespace

std::vector<PlanMethod> methods_of(const TimeLawProblem& problem) {
  std::vector<PlanMethod> all;
  for (const auto& method : kLawMethods)
    if (method.value != PlanMethod::jerk_limited || problem.jerk_mm_s3) all.push_back(method.value);
  return all;
}

double TubeStory::next_half_width_mm_s() const {
  if (passes.empty()) return 0;
  return passes.back().touched ? passes.back().half_width_u_s : 0.5 * passes.back().half_width_u_s;
}

bool LawStudy::good() const {
  return std::all_of(outcomes.begin(), outcomes.end(), [](const MethodOutcome& o) { return o.good(); });
}

std::optional<Diagnostic> check_size(const TimeLawProblem& problem, const std::vector<PlanMethod>& methods,
                                     bool keep_profiles) {
  for (const PlanMethod method : methods) {
    const planner::LawWork work =
        planner::law_method(method).work(problem.law, settings_of(problem, keep_profiles));
    std::string measured, allowed;
    if (work.memory_bytes > kMostMemory_bytes) {
      measured =
          fmt::format("needs about {} for {} nodes",
                      text::bytes_text(static_cast<std::int64_t>(work.memory_bytes)), problem.law.nodes());
      allowed = text::bytes_text(static_cast<std::int64_t>(kMostMemory_bytes));
    } else if (work.transitions > kMostTransitions) {
      measured = fmt::format("looks at up to {:.1e} transitions per pass, nodes times levels squared",
                             work.transitions);
      allowed = fmt::format("{:.0e} transitions", kMostTransitions);
    } else if (work.jerk_rows > kMostJerkRows) {
      measured = fmt::format("has {:.1e} limits to keep, two per node, axis and end", work.jerk_rows);
      allowed = fmt::format("{:.0e} limits", kMostJerkRows);
    } else {
      continue;
    }
    Diagnostic d = machine::file_diagnostic(Code::problem_too_large, problem.size_span,
                                            fmt::format("method {} {}", kLawMethods.word(method), measured));
    d.notes.push_back("allowed: " + allowed);
    d.help = "use fewer nodes or levels, or choose other methods with --method";
    return d;
  }
  return {};
}

LawStudy study_laws(const TimeLawProblem& problem, const std::vector<PlanMethod>& methods, bool keep_profiles,
                    const StudyProgress& progress) {
  LawStudy out;
  const double derivatives = static_cast<double>(problem.law.nodes() * problem.law.axes);
  out.inner_points = derivatives > kManyDerivatives ? 2 : 10;
  for (const PlanMethod method : methods) {
    const auto begin = std::chrono::steady_clock::now();
    MethodOutcome outcome{method, solve(problem, method, keep_profiles, out.tube, progress), {}, {}, 0};
    outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (outcome.law) out.lower_bound_s = std::max(out.lower_bound_s, outcome.law->lower_bound_s);
    measure(problem, out.inner_points, outcome);
    out.outcomes.push_back(std::move(outcome));
  }
  return out;
}

}  // namespace kadr::studies
