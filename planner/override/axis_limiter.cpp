#include "planner/override/axis_limiter.h"

#include <algorithm>
#include <cmath>

#include "machine/machine.h"

namespace kadr::planner {

double axis_factor(machine::LimiterKind kind, double speed, double most, double band_u_s) {
  using machine::LimiterKind;
  if (kind == LimiterKind::off) return 1.0;
  if (kind == LimiterKind::threshold) return speed > most ? most / speed : 1.0;
  // below rest there is no speed: the band of a slow axis begins there
  const double band = std::min(band_u_s, most);
  const double above = speed - most + band;
  if (above <= 0.0) return 1.0;
  if (above > 2.0 * band) return most / speed;
  const double x = above / (2.0 * band);
  const double k = kind == LimiterKind::paper ? 0.5 * x * x * (3.0 - 2.0 * x) : x * x * (1.0 - 0.5 * x);
  // rounding of a speed near rest
  return std::min((most - band + (1.0 - k) * above) / speed, 1.0);
}

LimitedFeed limited_feed(const machine::MachineModel& machine, std::span<const double> tangent, double feed) {
  LimitedFeed result;
  for (std::size_t j = 0; j < tangent.size(); ++j) {
    const double factor = axis_factor(machine.feed_override.limiter, std::fabs(tangent[j]) * feed,
                                      machine.axis[j].max_feed_u_s, machine.feed_override.limiter_band_u_s);
    if (factor < result.factor) result = {factor, static_cast<int>(j)};
  }
  return result;
}

}  // namespace kadr::planner
