#include "emulator/log/channels/steps.h"

#include <fmt/format.h>

#include "emulator/log/channels/run.h"
#include "emulator/log/pulse_code.h"

namespace kadr::log {

const char* check_message(PulseBlock& b, std::string_view, const LogHeader& header) {
  if (!begins_at_its_tick(b.begin, b.first, header)) return "its control tick does not begin at its tick";
  if (b.ticks < 1 || b.ticks > kMaxBlockTicks) return "it has 1 to 64 control ticks";
  std::int64_t sum = 0;
  for (const std::int32_t n : b.bytes) {
    if (n < 0) return "the code of an axis has a length";
    sum += n;
  }
  return sum == static_cast<std::int64_t>(b.code.size()) ? nullptr
                                                         : "its code is as long as those of the axes";
}

tl::expected<StepBlock, std::string> decode_steps(const PulseBlock& coded, const LogHeader& header) {
  StepBlock b;
  b.begin = coded.begin;
  b.first = coded.first;
  b.batches.resize(static_cast<std::size_t>(coded.ticks));
  for (std::size_t i = 0; i < b.batches.size(); ++i) {
    b.batches[i].tick = ControlTicks{b.first.value + static_cast<std::int64_t>(i)};
    b.batches[i].axis.resize(header.axis.size());
  }
  std::span<const std::uint8_t> code(coded.code);
  for (std::size_t a = 0; a < header.axis.size(); ++a) {
    const auto bytes = static_cast<std::size_t>(coded.bytes[a]);
    const PulseCounts counts{coded.pulses[a], coded.reversals[a], coded.ticks,
                             static_cast<std::int32_t>(header.control_tick_ticks)};
    if (auto decoded = decode_pulses(code.first(bytes), counts, b.batches, a); !decoded)
      return tl::unexpected(fmt::format("axis {}: {}", header.axis[a].name, decoded.error()));
    code = code.subspan(bytes);
  }
  return b;
}

}  // namespace kadr::log
