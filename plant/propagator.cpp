#include "plant/propagator.h"

namespace kadr::plant {

Propagator::Propagator(const Matrix4& system, Ticks control_tick) {
  const double tick_per_base = 1 / static_cast<double>(control_tick.value);
  const auto after = [&](std::int64_t base_ticks) {
    return exponential(system * (static_cast<double>(base_ticks) * tick_per_base));
  };
  for (std::int64_t j = 0; j < 256; ++j) fine_.push_back(after(j));
  for (std::int64_t i = 0; i <= control_tick.value >> 8; ++i) coarse_.push_back(after(i << 8));
}

}  // namespace kadr::plant
