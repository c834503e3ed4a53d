#include <algorithm>
#include <cmath>

#include "emulator/log/block_builder.h"
#include "emulator/log/log_types.h"
#include "emulator/log/run_log.h"
#include "machine/machine.h"

namespace kadr::log {
namespace {

/// One byte for a pulse at a constant rate, two where the interval changes by 64 base ticks or more.
constexpr double kBytesPerPulse = 1.08;

/// Bytes of the messages that a run is made of: typical ones are encoded and measured.
class Messages {
 public:
  Messages(const machine::MachineModel& machine, bool plant)
      : axes_(machine.axis.size()), header_(header_of(machine)), builder_(machine) {
    position_steps_.resize(axes_);
    states_.resize(axes_);
    batch_.axis.resize(axes_);
    record_.motion = &motion_;
    record_.position_steps = &position_steps_;
    if (plant) record_.axis = &states_;
    add_tick();
  }

  /// KADR_RUN without its texts, and KADR_SUMMARY.
  double frame() {
    LogSummary summary;
    summary.run.axis.resize(axes_);
    summary.run.limited_by.assign(4, {"axis X speed", 0});
    return of(header_) + of(summary);
  }
  double block() {
    BlockRecord block;
    block.text = "N100 G1 X123.456 Y123.45";
    block.motion = "line";
    block.limited_by = "program ";
    return of(block);
  }
  double block_end() {
    BlockEndRecord end;
    end.peak_link_u.resize(axes_);
    end.peak_following_u.resize(axes_);
    return of(end);
  }
  /// KADR_FEED and all KADR_AXIS_* of one moment.
  double viewers() {
    double bytes = of(builder_.feed_sample(record_));
    for (std::size_t a = 0; a < axes_; ++a) bytes += of(builder_.axis_sample(record_, batch_, a)) + 1;
    return bytes;
  }
  /// Exact data of `ticks` control ticks in `messages` messages of each channel.
  double ticks(double messages, double ticks) {
    const double one = blocks();
    add_tick();
    const double each = blocks() - one;
    return messages * (one - each) + ticks * each;
  }
  /// KADR_STEPS without its pulses.
  double steps() { return of(builder_.pulse_block()); }

 private:
  static LogHeader header_of(const machine::MachineModel& machine) {
    RunHeader run;
    run.machine = &machine;
    return log_header(run);
  }
  void add_tick() {
    builder_.add(record_, batch_);
    record_.tick = batch_.tick = record_.tick + ControlTicks{1};
  }
  double blocks() {
    double bytes = 0;
    for_each_channel(TickChannels{}, [&]<class R>() { bytes += of(builder_.block<R>()); });
    return bytes;
  }
  template <class R>
  double of(const R& record) {
    encode(record, header_, bytes_);
    return static_cast<double>(kEventHeaderBytes + Channel<R>::info.name.size() + bytes_.size());
  }

  std::size_t axes_;
  LogHeader header_;
  BlockBuilder builder_;
  std::vector<Steps> position_steps_;
  std::vector<AxisState> states_;
  TickMotion motion_;
  StepBatch batch_;
  TickRecord record_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::int64_t estimate_log_bytes(const machine::MachineModel& machine, double planned_s, std::int64_t pulses,
                                std::size_t blocks, bool plant, std::size_t text_bytes,
                                std::size_t list_bytes) {
  Messages message(machine, plant);
  const double ticks = std::ceil(std::max(0.0, planned_s) / machine.clock.tau_s());
  const double messages =
      std::ceil(ticks / static_cast<double>(std::max<std::int64_t>(1, machine.log.block_ticks.value)));
  double bytes = message.frame() +
                 static_cast<double>(std::min(text_bytes, kEmbeddedTextLimit) + list_bytes) +
                 static_cast<double>(blocks) * message.block() +
                 // a block that ends within the control tick of its beginning has no KADR_BLOCK_END
                 std::min(static_cast<double>(blocks), ticks) * message.block_end();
  if (machine.log.steps) bytes += messages * message.steps() + kBytesPerPulse * static_cast<double>(pulses);
  if (const std::int32_t every = viewer_every_ticks(machine); every > 0)
    bytes += std::floor(ticks / every) * message.viewers();
  if (machine.log.ticks) bytes += message.ticks(messages, ticks);
  constexpr double kLargest = 9e18;
  return static_cast<std::int64_t>(std::min(bytes, kLargest));
}

}  // namespace kadr::log
