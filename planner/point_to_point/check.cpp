#include <cmath>

#include "planner/point_to_point/synthesis.h"

namespace kadr::planner {
namespace {

using Kind = PointFault::Kind;

PointResult<void> positive(const char* what, double value, const char* unit) {
  if (value > 0 && std::isfinite(value)) return {};
  return tl::unexpected(PointFault{Kind::not_positive, what, value, 0, unit});
}

}  // namespace

PointResult<void> check(const PointTask& task) {
  if (auto r = positive("distance", task.distance_u, "u"); !r) return r;
  if (auto r = positive("speed limit", task.speed_limit_u_s, "u/s"); !r) return r;
  return positive("acceleration limit", task.accel_limit_u_s2, "u/s2");
}

PointResult<void> check(const Mode& mode) {
  if (auto r = positive("frequency", mode.omega_rad_s, "rad/s"); !r) return r;
  if (mode.zeta >= 0 && mode.zeta < 1) return {};
  return tl::unexpected(PointFault{Kind::bad_damping, "damping ratio", mode.zeta, 1, ""});
}

PointResult<void> check(const Load& load) {
  if (auto r = positive("mass of the load", load.mass_kg, "kg"); !r) return r;
  if (auto r = positive("drive ratio", load.drive_ratio, ""); !r) return r;
  if (!(load.counterweight_ratio >= 0 && load.counterweight_ratio <= 1))
    return tl::unexpected(PointFault{Kind::bad_share, "counterweight ratio", load.counterweight_ratio,
                                     load.counterweight_ratio > 1 ? 1.0 : 0.0, ""});
  if (!(load.gravity_m_s2 >= 0 && std::isfinite(load.gravity_m_s2)))
    return tl::unexpected(PointFault{Kind::bad_share, "gravity", load.gravity_m_s2, 0, "m/s2"});
  return {};
}

}  // namespace kadr::planner
