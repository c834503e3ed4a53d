#include <fmt/format.h>

#include "planner/planner.h"
#include "tests/storm/invariants.h"

namespace kadr::storm {

Verdict check_verify(const PreparedCase& prepared) {
  const cycle::Job& job = *prepared.job;
  const machine::MachineModel& machine = job.given.machine.model;
  planner::VerifyOptions options;
  options.curves_that_turn_back = false;  // as docs/pipeline.md says of every plan
  options.sample_s = machine.clock.tau_s();
  options.most = 1;
  const auto found = planner::verify(job.read.path, job.planned.plan, machine, options,
                                     cycle::pauses(job.read.events, machine));
  if (found.empty()) return {};
  const planner::Violation& v = found.front();
  return Finding{Invariant::verify,
                 fmt::format("{} of axis {} is {:.9g}, allowed {:.9g}, at {:.9g} s, segment {}", v.what,
                             v.axis, v.value, v.limit, v.time_s, v.segment)};
}

Verdict check_end(const PreparedCase& prepared, const FinishedRun& run) {
  if (!run.whole()) return {};
  const cycle::Job& job = *prepared.job;
  const machine::MachineModel& machine = job.given.machine.model;
  const planner::Path& path = job.read.path;
  for (std::size_t a = 0; a < machine.axis.size(); ++a) {
    const double end_u = path.size() > 0 ? path.node(path.size())[a] : machine.axis[a].home_u;
    const Steps planned = lattice_node(end_u, machine.axis[a].step_u);
    const Steps run_to = run.summary.axis[a].end_steps;
    if (planned != run_to)
      return Finding{Invariant::end_exact, fmt::format("axis {} ends on step {}, planned {}",
                                                       machine.axis[a].letter, run_to.value, planned.value)};
  }
  return {};
}

Verdict check_planted(const PreparedCase& prepared) {
  constexpr double kLargest_mm = 7;
  for (const planner::ArcShape& arc : prepared.job->read.path.arcs)
    if (arc.radius_begin_u > kLargest_mm)
      return Finding{Invariant::planted, fmt::format("an arc has a radius of {:.6g} mm", arc.radius_begin_u)};
  return {};
}

}  // namespace kadr::storm
