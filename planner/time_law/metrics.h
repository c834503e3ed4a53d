#pragma once
#include "planner/time_law/solver.h"

namespace kadr::planner {

/// Smoothness of a profile. u_i = dv/dt of interval i of duration h_i; at inner nodes
///   v' = (h2 u1 + h1 u2)/(h1 + h2),   v'' = 2 (u2 - u1)/(h1 + h2).
struct LawMetrics {
  /// E of paper 000: integral of v''^2/(1 + v'^2)^3 dt in u/s and s. It depends on units and nodes;
  /// published, never compared against a limit.
  double curve_energy = 0;
  /// The same of (t/T, v/highest speed): no units.
  double relative_energy = 0;
  double rms_jerk_u_s3 = 0;
  double peak_jerk_u_s3 = 0;
};
/// @param speed_scale_u_s  what v is divided by in relative_energy
LawMetrics law_metrics(const LawProblem& problem, const LawSolution& solution, double speed_scale_u_s);

}  // namespace kadr::planner
