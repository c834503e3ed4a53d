#include "emulator/log/log_types.h"

#include <cmath>

#include "machine/machine.h"

namespace kadr::emulator {

MessageKind message_kind(std::string_view channel) {
  if (channel == kTicksChannel) return MessageKind::ticks;
  if (channel == kStepsChannel) return MessageKind::steps;
  if (channel == kFeedChannel) return MessageKind::feed;
  if (channel.substr(0, kAxisChannelPrefix.size()) == kAxisChannelPrefix) return MessageKind::axis;
  if (channel == kBlockChannel) return MessageKind::block;
  if (channel == kBlockEndChannel) return MessageKind::block_end;
  if (channel == kEventChannel) return MessageKind::event;
  if (channel == kDiagChannel) return MessageKind::diag;
  if (channel == kRunChannel) return MessageKind::run;
  if (channel == kSummaryChannel) return MessageKind::summary;
  return MessageKind::unknown;
}

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

std::string axis_channel(char letter) { return std::string(kAxisChannelPrefix) + letter; }

}  // namespace kadr::emulator
