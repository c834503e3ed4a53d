#include <algorithm>
#include <cmath>

#include "emulator/log/log_types.h"
#include "emulator/log/run_log.h"
#include "machine/machine.h"

namespace kadr::emulator {
namespace {

constexpr std::int64_t kFingerprintBytes = 8;
/// One byte for a pulse at an even pace, two where the interval changes by 64 base ticks or more.
constexpr double kBytesPerPulse = 1.08;

/// Bytes of an event around its payload's fields.
std::int64_t envelope(std::size_t channel_bytes) {
  return static_cast<std::int64_t>(kEventHeaderBytes + channel_bytes) + kFingerprintBytes;
}

/// KADR_TICKS without its per-tick columns, and those (ticks_t).
double ticks_message_bytes(std::int64_t axes) {
  return static_cast<double>(envelope(kTicksChannel.size()) + 8 + 8 + 4 + 4 + 4 + 4 + 8 * axes);
}
double tick_bytes(std::int64_t axes, bool plant) {
  return static_cast<double>(4 * 8 + 1 + 1 + 4 + axes * (4 + 8) + (plant ? axes * 5 * 8 : 0));
}
/// KADR_STEPS without its pulses (steps_t).
double steps_message_bytes(std::int64_t axes) {
  return static_cast<double>(envelope(kStepsChannel.size()) + 8 + 8 + 4 + 4 + 3 * 4 * axes + 4);
}
/// KADR_FEED and all KADR_AXIS_* of one moment (feed_t, axis_t).
double viewer_bytes(std::int64_t axes) {
  const std::int64_t feed = envelope(kFeedChannel.size()) + 8 + 4 + 6 * 8 + 1 + 1;
  const std::int64_t axis = envelope(kAxisChannelPrefix.size() + 1) + 10 * 8;
  return static_cast<double>(feed + axes * axis);
}
/// KADR_BLOCK with texts of usual length, and KADR_BLOCK_END (block_t, block_end_t).
double block_bytes() {
  constexpr std::int64_t kTexts = 3 * 5 + 24 + 4 + 8;  // length and zero byte each; line, motion, limited_by
  return static_cast<double>(envelope(kBlockChannel.size()) + 8 + 8 + 3 * 4 + 7 * 8 + 4 + kTexts);
}
double block_end_bytes(std::int64_t axes) {
  return static_cast<double>(envelope(kBlockEndChannel.size()) + 8 + 8 + 3 * 4 + 2 * 8 * axes);
}
/// KADR_RUN without its texts, and KADR_SUMMARY (run_t, summary_t).
double frame_bytes(std::int64_t axes) {
  const std::int64_t run = envelope(kRunChannel.size()) + 100 + axes * 32;
  const std::int64_t summary = envelope(kSummaryChannel.size()) + 150 + axes * 140 + 80;
  return static_cast<double>(run + summary);
}

}  // namespace

std::int64_t estimate_log_bytes(const machine::MachineModel& machine, double planned_s, std::int64_t pulses,
                                std::size_t blocks, bool plant, std::size_t text_bytes) {
  const auto axes = static_cast<std::int64_t>(machine.axis.size());
  const double ticks = std::ceil(std::max(0.0, planned_s) / machine.clock.tau_s());
  const double messages = std::ceil(ticks / std::max(1, machine.log.block_ticks));
  double bytes = frame_bytes(axes) + static_cast<double>(std::min(text_bytes, kEmbeddedTextLimit)) +
                 static_cast<double>(blocks) * block_bytes() +
                 // a block that ends within the control tick of its beginning has no KADR_BLOCK_END
                 std::min(static_cast<double>(blocks), ticks) * block_end_bytes(axes);
  if (machine.log.ticks) bytes += messages * ticks_message_bytes(axes) + ticks * tick_bytes(axes, plant);
  if (machine.log.steps)
    bytes += messages * steps_message_bytes(axes) + kBytesPerPulse * static_cast<double>(pulses);
  if (const std::int32_t every = viewer_every_ticks(machine); every > 0)
    bytes += std::floor(ticks / every) * viewer_bytes(axes);
  constexpr double kLargest = 9e18;
  return static_cast<std::int64_t>(std::min(bytes, kLargest));
}

}  // namespace kadr::emulator
