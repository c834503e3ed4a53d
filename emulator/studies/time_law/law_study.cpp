#include "emulator/studies/time_law/law_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "emulator/text/text.h"
#include "machine/file/tree.h"

namespace kadr::emulator {
namespace {

using planner::LawResult;

constexpr double kMostMemory_bytes = 4e9;
constexpr double kMostTransitions = 1e12;  ///< of one pass, if every transition were admissible
constexpr double kMostJerkRows = 1e7;      ///< their tangents are some hundred steps over all rows
/// nodes times axes, from which on fewer inner points are looked at
constexpr double kManyDerivatives = 1e6;

double tube_bytes(const TimeLawProblem& p, bool keep_profiles) {
  const auto nodes = static_cast<double>(p.law.nodes());
  return nodes * (12.0 * (p.tube.levels + 16) + (keep_profiles ? 8.0 * p.tube.most_passes : 0.0));
}

/// Rows of the interior point method: both sides of every limit, the caps, the jerk.
double rows(const TimeLawProblem& p, bool jerk) {
  const auto nodes = static_cast<double>(p.law.nodes()), axes = static_cast<double>(p.law.axes);
  const double ends = p.law.accel_test == planner::AccelTest::both_nodes ? 2 : 1;
  return nodes * (2 * (1 + axes * ends) + 1 + (jerk ? 2 : 0));
}

/// Per row: multiplier, slack, their Newton steps, one certificate entry.
constexpr double kRow_bytes = 128;

double bytes(const TimeLawProblem& p, LawMethod method, bool keep_profiles) {
  switch (method) {
    case LawMethod::classical:
      return static_cast<double>(p.law.nodes()) * 12.0 * (p.classical_levels + 16);
    case LawMethod::tube:
      return tube_bytes(p, keep_profiles);
    case LawMethod::greedy:
      return 0;
    case LawMethod::optimum:
    case LawMethod::certified:
      return rows(p, false) * kRow_bytes;
    case LawMethod::jerk_limited:
      return rows(p, true) * kRow_bytes;
  }
  return 0;
}

double transitions(const TimeLawProblem& p, LawMethod method) {
  const double levels = method == LawMethod::classical ? p.classical_levels
                        : method == LawMethod::tube    ? p.tube.levels
                                                       : 0;
  return static_cast<double>(p.law.nodes()) * levels * levels;
}

std::unique_ptr<planner::LawSolver> solver_of(const TimeLawProblem& problem, LawMethod method) {
  switch (method) {
    case LawMethod::classical:
      return std::make_unique<planner::ClassicalDp>(problem.classical_levels);
    case LawMethod::tube:
      return std::make_unique<planner::TubeDp>(problem.tube);
    case LawMethod::greedy:
      return std::make_unique<planner::GreedyOptimum>();
    case LawMethod::optimum:
      return std::make_unique<planner::InteriorPointOptimum>();
    case LawMethod::certified:
      return std::make_unique<planner::CertifiedLaw>();
    case LawMethod::jerk_limited:
      break;
  }
  return std::make_unique<planner::JerkLimitedLaw>(*problem.jerk_mm_s3);
}

LawResult solve(const TimeLawProblem& problem, LawMethod method, bool keep_profiles, TubeStory& story,
                const StudyProgress& progress) {
  const auto solver = solver_of(problem, method);
  if (progress)
    solver->on_progress([&](std::string_view stage, double done) { progress(method, stage, done); });
  auto* tube = dynamic_cast<planner::TubeDp*>(solver.get());
  if (tube) tube->keep_profiles(keep_profiles);
  LawResult law = solver->solve(problem.law);
  if (tube) story = {tube->passes(), tube->profiles(), tube->lost(), tube->capped()};
  return law;
}

void measure(const TimeLawProblem& problem, std::uint32_t inner_points, MethodOutcome& out) {
  if (!out.law) return;
  out.metrics = planner::law_metrics(problem.law, *out.law, problem.scale_mm_s());
  planner::LawCheckOptions options;
  options.inner_points = inner_points;
  out.check = planner::verify_law(problem.law, *out.law, problem.path(), options);
  if (out.method != LawMethod::jerk_limited) return;
  const double jerk = planner::node_jerk_u_s3(problem.law, out.law->speed_u_s);
  if (!(jerk <= *problem.jerk_mm_s3 * (1 + options.tolerance)))
    out.check.broken.push_back({"path jerk", problem.law.s_u.front(), jerk, *problem.jerk_mm_s3});
}

}  // namespace

std::vector<LawMethod> methods_of(const TimeLawProblem& problem) {
  std::vector<LawMethod> all;
  for (const auto& method : kLawMethods)
    if (method.value != LawMethod::jerk_limited || problem.jerk_mm_s3) all.push_back(method.value);
  return all;
}

double TubeStory::next_half_width_mm_s() const {
  if (passes.empty()) return 0;
  return passes.back().touched ? passes.back().half_width_u_s : 0.5 * passes.back().half_width_u_s;
}

bool LawStudy::good() const {
  return std::all_of(outcomes.begin(), outcomes.end(), [](const MethodOutcome& o) { return o.good(); });
}

std::optional<Diagnostic> check_size(const TimeLawProblem& problem, const std::vector<LawMethod>& methods,
                                     bool keep_profiles) {
  for (const LawMethod method : methods) {
    const double memory = bytes(problem, method, keep_profiles), work = transitions(problem, method);
    const double jerk_rows = method == LawMethod::jerk_limited ? rows(problem, true) : 0;
    std::string measured, allowed;
    if (memory > kMostMemory_bytes) {
      measured = fmt::format("needs about {} for {} nodes", bytes_text(static_cast<std::int64_t>(memory)),
                             problem.law.nodes());
      allowed = bytes_text(static_cast<std::int64_t>(kMostMemory_bytes));
    } else if (work > kMostTransitions) {
      measured = fmt::format("looks at up to {:.1e} transitions per pass, nodes times levels squared", work);
      allowed = fmt::format("{:.0e} transitions", kMostTransitions);
    } else if (jerk_rows > kMostJerkRows) {
      measured = fmt::format("has {:.1e} limits to keep, two per node, axis and end", jerk_rows);
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

LawStudy study_laws(const TimeLawProblem& problem, const std::vector<LawMethod>& methods, bool keep_profiles,
                    const StudyProgress& progress) {
  LawStudy out;
  const double derivatives = static_cast<double>(problem.law.nodes() * problem.law.axes);
  out.inner_points = derivatives > kManyDerivatives ? 2 : 10;
  for (const LawMethod method : methods) {
    const auto begin = std::chrono::steady_clock::now();
    MethodOutcome outcome{method, solve(problem, method, keep_profiles, out.tube, progress), {}, {}, 0};
    outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (outcome.law) out.lower_bound_s = std::max(out.lower_bound_s, outcome.law->lower_bound_s);
    measure(problem, out.inner_points, outcome);
    out.outcomes.push_back(std::move(outcome));
  }
  return out;
}

}  // namespace kadr::emulator
