#include "planner/time_law/stretch.h"

#include <algorithm>
#include <utility>

#include "planner/path/joints.h"
#include "planner/path/path.h"

namespace kadr::planner {

Stretch state_stretch(const Path& path, const PathLimitTable& table, const Run& run,
                      const machine::MachineModel& machine) {
  RunProblem stated = run_problem(*machine_joints(path, machine), table, run, machine);
  Stretch out{std::move(stated.problem), std::move(stated.segment), {}};
  LawProblem& p = out.problem;
  p.cap_u_s.front() = table.cap_u_s[2 * run.first];
  p.cap_u_s.back() = table.cap_u_s[2 * run.last + 2];
  out.held_by.reserve(p.nodes());
  out.held_by.push_back(table.signature[2 * run.first]);
  for (std::size_t i = 1; i < p.nodes(); ++i) {
    const std::size_t at = out.segment[i];
    const bool joint = p.s_u[i] == path.start_s_u[at + 1];
    out.held_by.push_back(table.signature[2 * at + (joint ? 2 : 1)]);
  }
  const double begin = p.s_u.front();
  for (double& s : p.s_u) s -= begin;
  return out;
}

PathDerivatives derivatives(const Path& path, const Run& run) {
  return [&path, joints = DirectJoints(path), run](double s, double* slope, double* curvature) {
    const double at = path.start_s_u[run.first] + s;
    const auto first = path.start_s_u.begin() + static_cast<std::ptrdiff_t>(run.first + 1);
    const auto last = path.start_s_u.begin() + static_cast<std::ptrdiff_t>(run.last + 1);
    // past the stretch's end its last segment goes on
    const auto end = std::upper_bound(first, last, at);
    const auto segment = static_cast<std::size_t>(std::min(end, last) - path.start_s_u.begin()) - 1;
    const double local = std::clamp(at - path.start_s_u[segment], 0.0, path.segments[segment].length_u);
    const auto axes = static_cast<std::size_t>(joints.size());
    joints.at(segment, local, {.d1 = {slope, axes}, .d2_per_u = {curvature, axes}});
  };
}

}  // namespace kadr::planner
