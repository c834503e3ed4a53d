#include <algorithm>
#include <cmath>

#include "planner/point_to_point/builders.h"
#include "planner/point_to_point/synthesis.h"

namespace kadr::planner {

std::optional<AsymmetricPick> robust_asymmetric_law(const PointTask& task, double duration_s,
                                                    const DrivenMode& driven, double band) {
  constexpr int kSamples = 40;
  constexpr double kMostPeriods = 200;  // the pairs grow with the square of it
  const double period_s = driven.mode.period_s();
  if (duration_s / period_s > kMostPeriods) return {};
  const int most = static_cast<int>(std::floor(duration_s / period_s * (1 + 1e-12)));
  std::optional<AsymmetricPick> best;
  for (int up = 1; up < most; ++up)
    for (int down = 1; up + down <= most; ++down) {
      const double cruise_s = std::max(0.0, duration_s - (up + down) * period_s);
      const double speed = task.distance_u / (cruise_s + (up + down) * period_s / 2);
      const double accel = speed / (std::min(up, down) * period_s);
      if (speed > task.speed_limit_u_s * (1 + 1e-12) || accel > task.accel_limit_u_s2 * (1 + 1e-12)) continue;
      const PointLaw law = ramp_law(task.distance_u, up * period_s, cruise_s, down * period_s);
      const double worst = worst_amplitude_u(law, driven, band, kSamples);
      if (!best || worst < best->worst_u) best = AsymmetricPick{up, down, law, worst};
    }
  return best;
}

}  // namespace kadr::planner
