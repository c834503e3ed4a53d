#include "emulator/log/log_types.h"

#include <cmath>

#include "machine/machine.h"

namespace kadr::log {

std::int64_t event_time_us(Ticks tick, std::int64_t base_hz) {
  constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;
  return tick.value / (base_hz / kMicrosecondsPerSecond);
}

std::int32_t viewer_every_ticks(const machine::MachineModel& machine) {
  if (!(machine.log.viewer_rate_hz > 0)) return 0;
  const double control_hz =
      static_cast<double>(machine.clock.base_hz) / static_cast<double>(machine.clock.control_tick.value);
  const double every = std::floor(control_hz / machine.log.viewer_rate_hz + 0.5);
  constexpr double kLongest = 1e9;
  return static_cast<std::int32_t>(every < 1 ? 1 : every > kLongest ? kLongest : every);
}

}  // namespace kadr::log
