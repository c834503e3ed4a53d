#include "planner/time_law/law_methods.h"

#include <algorithm>
#include <iterator>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/time_law/certified.h"
#include "planner/time_law/dynamic_programme.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/jerk_plan.h"
#include "planner/time_law/path_law.h"
#include "planner/time_law/tube.h"

namespace kadr::planner {
namespace {

using machine::PlanMethod;

// ---- estimates

/// Of a dynamic programme: a cost and two level numbers a node and level, and room for the levels to grow.
constexpr double kLevel_bytes = 12;
constexpr int kSpareLevels = 16;
constexpr double kKeptSpeed_bytes = 8;
/// A row has its multiplier, slack and their Newton steps, and an entry in the certificate.
constexpr double kRow_bytes = 128;

LawWork little_work(const LawProblem&, const LawSettings&) { return {}; }

LawWork level_work(const LawProblem& p, std::int32_t levels) {
  const auto nodes = static_cast<double>(p.nodes());
  return {nodes * kLevel_bytes * (levels + kSpareLevels), nodes * levels * levels, 0};
}
LawWork classical_work(const LawProblem& p, const LawSettings& settings) {
  return level_work(p, settings.classical_levels);
}
LawWork tube_work(const LawProblem& p, const LawSettings& settings) {
  LawWork work = level_work(p, settings.tube.levels);
  if (settings.keeps_profiles)
    work.memory_bytes += static_cast<double>(p.nodes()) * kKeptSpeed_bytes * settings.tube.most_passes;
  return work;
}

/// Rows of the interior point method: both sides of every limit, the caps, the jerk.
double rows(const LawProblem& p, bool jerk) {
  const auto nodes = static_cast<double>(p.nodes()), axes = static_cast<double>(p.axes);
  const double ends = p.accel_test == AccelTest::both_nodes ? 2 : 1;
  return nodes * (2 * (1 + axes * ends) + 1 + (jerk ? 2 : 0));
}
LawWork row_work(const LawProblem& p, const LawSettings&) { return {rows(p, false) * kRow_bytes, 0, 0}; }
LawWork jerk_work(const LawProblem& p, const LawSettings&) {
  return {rows(p, true) * kRow_bytes, 0, rows(p, true)};
}

// ---- solvers for study

template <class Solver>
std::unique_ptr<LawSolver> make(const LawSettings&) {
  return std::make_unique<Solver>();
}
std::unique_ptr<LawSolver> make_classical(const LawSettings& settings) {
  return std::make_unique<ClassicalDp>(settings.classical_levels);
}
std::unique_ptr<LawSolver> make_tube(const LawSettings& settings) {
  auto tube = std::make_unique<TubeDp>(settings.tube);
  tube->keep_profiles(settings.keeps_profiles);
  return tube;
}
std::unique_ptr<LawSolver> make_jerk_limited(const LawSettings& settings) {
  return std::make_unique<JerkLimitedLaw>(*settings.jerk_u_s3);
}

// ---- planners of runs

/// A solver that needs no settings.
template <class Solver>
LawResult solve(const LawProblem& problem, const machine::MachineModel&) {
  return Solver().solve(problem);
}

LawResult solve_tube(const LawProblem& problem, const machine::MachineModel& machine) {
  TubeOptions options;
  options.levels = machine.planner.tube_levels;
  options.grid = TubeGrid::nominal_kept;
  TubeDp tube(options);
  LawResult law = tube.solve(problem);
  if (law) return law;
  // levels over the whole range can be too coarse for short intervals: then the tube begins round the time optimum
  LawResult known = GreedyOptimum().solve(problem);
  if (!known) return known;
  const double fastest = *std::max_element(known->speed_u_s.begin(), known->speed_u_s.end());
  return tube.refine(problem, *known, options.relative_half_width * fastest);
}

template <RunSolver* kSolve>
tl::expected<void, PlanError> plan(const RunTask& task, const Run& run, PlannedRun& out) {
  return plan_time_law(task, run, *kSolve, out.elements);
}

tl::expected<void, PlanError> plan_jerk_limited(const RunTask& task, const Run& run, PlannedRun& out) {
  if (!limits_jerk(task.table, run)) return plan_time_law(task, run, solve<CertifiedLaw>, out.elements);
  const auto stretch = plan_jerk_law(task, run, out.pieces);
  if (!stretch) return tl::unexpected(stretch.error());
  return {};
}

// ---- the table

constexpr LawMethod kMethods[] = {
    {PlanMethod::classical, make_classical, classical_work, nullptr},
    {PlanMethod::tube, make_tube, tube_work, plan<solve_tube>},
    {PlanMethod::greedy, make<GreedyOptimum>, little_work, nullptr},
    {PlanMethod::optimum, make<InteriorPointOptimum>, row_work, nullptr},
    {PlanMethod::certified, make<CertifiedLaw>, row_work, plan<solve<CertifiedLaw>>},
    {PlanMethod::jerk_limited, make_jerk_limited, jerk_work, plan_jerk_limited},
};

constexpr bool covers_laws() {
  std::size_t next = 0;
  for (const machine::PlanMethodRow& row : machine::kPlanMethodRows) {
    if (!row.is_law) continue;
    if (next == std::size(kMethods) || kMethods[next].method != row.method) return false;
    if ((kMethods[next].plan != nullptr) != row.plans) return false;
    ++next;
  }
  return next == std::size(kMethods);
}
static_assert(covers_laws(), "each law has a row in kMethods, with a planner where a machine can choose it");

}  // namespace

const LawMethod& law_method(PlanMethod method) {
  const auto* row = std::find_if(std::begin(kMethods), std::end(kMethods),
                                 [&](const LawMethod& each) { return each.method == method; });
  require(row != std::end(kMethods), "only a law is looked up among the laws");
  return *row;
}

}  // namespace kadr::planner
