#include "planner/point_to_point/rapid.h"

#include <cmath>

#include "planner/point_to_point/builders.h"

namespace kadr::planner {
namespace {

constexpr double kZvUncertainty = 0.01;
constexpr double kTFraction = 0.01;   ///< of the distance between zeros of a T law
constexpr double kMostPeriods = 1e5;  ///< in a motion; angles stay below the 1e6 rad of exact_sincos

struct Choice {
  RapidShape shape;
  std::string_view reason;
};

Choice choose(const RapidTask& task, const FastZero& t, double bound_s) {
  const Mode& mode = task.driven.mode;
  const bool quick = t.duration_s() - bound_s < mode.period_s() / 2;
  // periods in the longer of the two intervals that ring: the zero of either is that much narrower
  const double periods = t.branch == ZeroBranch::ramp ? t.count : t.shift_s / mode.period_s();
  const bool sharp = task.omega_uncertainty * periods <= kTFraction;
  if (mode.zeta == 0.0 && quick && sharp)
    return {RapidShape::t_zero,
            "a T law loses less than half a period, and the frequency is known well enough"};
  const bool zv = task.omega_uncertainty <= kZvUncertainty;
  if (mode.zeta > 0.0)
    return zv ? Choice{RapidShape::zv, "with damping only shaping is silent; the frequency is known to 1 %"}
              : Choice{RapidShape::zvd,
                       "with damping only shaping is silent; the frequency is not known to 1 %"};
  if (!zv) return {RapidShape::zvd, "the frequency is not known to 1 %"};
  return {RapidShape::zv, quick ? "the frequency is not known well enough for a T law of so many periods"
                                : "a T law loses more than the half period of ZV"};
}

PointLaw build(RapidShape shape, const RapidTask& task, const FastZero& t) {
  const PointTask& m = task.motion;
  if (shape == RapidShape::t_zero) return t.law(m.distance_u);
  const PointLaw fastest = bang_bang_law(m.distance_u, m.speed_limit_u_s, m.accel_limit_u_s2);
  const Mode& mode = task.driven.mode;
  switch (shape) {
    case RapidShape::scurve:
      return averaged(fastest, mode.period_s());
    case RapidShape::zv:
      return zv_shaped(fastest, mode);
    default:
      return zvd_shaped(fastest, mode);
  }
}

}  // namespace

PointResult<RapidLaw> rapid_law(const RapidTask& task) {
  if (auto r = check(task.motion); !r) return tl::unexpected(r.error());
  if (auto r = check(task.driven.mode); !r) return tl::unexpected(r.error());
  if (!(task.omega_uncertainty >= 0 && task.omega_uncertainty < 1))
    return tl::unexpected(PointFault{PointFault::Kind::bad_share, "uncertainty of the frequency",
                                     task.omega_uncertainty, task.omega_uncertainty >= 1 ? 1.0 : 0.0, ""});
  const double bound_s = shortest_time_s(task.motion), periods = bound_s / task.driven.mode.period_s();
  if (!(periods <= kMostPeriods))
    return tl::unexpected(PointFault{PointFault::Kind::too_fine, "periods of the vibration in the motion",
                                     periods, kMostPeriods, ""});
  const FastZero t = fastest_zero_law(task.motion, task.driven.mode);
  const Choice choice =
      task.shape == RapidShape::automatic ? choose(task, t, bound_s) : Choice{task.shape, {}};
  RapidLaw out;
  out.law = build(choice.shape, task, t);
  out.shape = choice.shape;
  out.reason = choice.reason;
  out.loss_s = out.law.duration_s() - bound_s;
  out.amplitude_u = residual_amplitude_u(out.law, task.driven);
  return out;
}

std::string_view rapid_shape_name(RapidShape shape) {
  constexpr std::string_view kNames[] = {"scurve", "t_zero", "zv", "zvd", "auto"};
  return kNames[static_cast<std::size_t>(shape)];
}

}  // namespace kadr::planner
