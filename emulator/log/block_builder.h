#pragma once
#include <cstdint>
#include <tuple>
#include <vector>

#include "emulator/log/log_messages.h"
#include "emulator/log/pulse_code.h"
#include "machine/machine.h"

namespace kadr::log {

namespace detail {
template <class List>
struct TupleOf;
template <class... R>
struct TupleOf<Records<R...>> {
  using Type = std::tuple<R...>;
};
}  // namespace detail

/// Gathers control ticks until the messages of exact data are full. Storage is reused.
class BlockBuilder {
 public:
  explicit BlockBuilder(const machine::MachineModel& machine);
  bool empty() const { return ticks_ == 0; }
  bool full() const { return ticks_ == machine_.log.block_ticks; }
  /// True if the tick can't join the block under way: ticks were skipped, or the plant came or went.
  bool breaks(const TickRecord& record) const;
  void add(const TickRecord& record, const StepBatch& batch);
  /// The messages of the block. clear() begins the next one.
  template <class R>
  const R& block() const {
    return std::get<R>(blocks_);
  }
  /// Codes the pulses of the block.
  const PulseBlock& pulse_block();
  Ticks end() const;
  void clear();

  /// Viewer messages of the tick added last.
  FeedSample feed_sample(const TickRecord& record) const;
  AxisSample axis_sample(const TickRecord& record, const StepBatch& batch, std::size_t axis) const;

 private:
  void begin_block(const TickRecord& record);
  void begin_lattice(const TickRecord& record, const StepBatch& batch);
  Ticks tick_end(ControlTicks tick) const;
  double seconds(Ticks ticks) const;

  const machine::MachineModel& machine_;
  detail::TupleOf<TickChannels>::Type blocks_;
  PulseBlock pulse_block_;
  std::vector<PulseEncoder> pulses_;          // [axes]
  std::vector<std::int64_t> lattice_offset_;  // [axes] lattice node - position_steps; set by the first tick
  std::vector<std::int64_t> node_;            // [axes] of the tick added last
  ControlTicks first_;                        // of the block
  std::int32_t ticks_ = 0;                    // in the block
  bool has_plant_ = false, has_override_ = false;
  double accel_u_s2_ = 0, jerk_u_s3_ = 0;  // of the tick added last
};

}  // namespace kadr::log
