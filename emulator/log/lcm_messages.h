#pragma once
#include <cstdint>
#include <kadr/axis_t.hpp>
#include <kadr/block_end_t.hpp>
#include <kadr/block_t.hpp>
#include <kadr/diag_t.hpp>
#include <kadr/event_t.hpp>
#include <kadr/feed_t.hpp>
#include <kadr/run_t.hpp>
#include <kadr/steps_t.hpp>
#include <kadr/summary_t.hpp>
#include <kadr/ticks_t.hpp>
#include <vector>

#include "emulator/log/pulse_code.h"
#include "emulator/log/records.h"
#include "machine/machine.h"

/// Records of a run as LCM messages (emulator/log/kadr.lcm).
namespace kadr::emulator {

run_t run_message(const RunHeader& header);
block_t block_message(const BlockRecord& record, const machine::ClockModel& clock);
block_end_t block_end_message(const BlockEndRecord& record, const machine::ClockModel& clock);
event_t event_message(const EventRecord& record, const machine::ClockModel& clock);
diag_t diag_message(const Diagnostic& d, Ticks tick);
summary_t summary_message(const RunSummary& summary, const machine::ClockModel& clock,
                          std::uint64_t content_hash);

/// Gathers control ticks until a KADR_TICKS and a KADR_STEPS message are full. Storage is reused.
class BlockBuilder {
 public:
  explicit BlockBuilder(const machine::MachineModel& machine);
  bool empty() const { return ticks_.n == 0; }
  bool full() const { return ticks_.n == machine_.log.block_ticks; }
  /// True if the tick can't join the block under way: ticks were skipped, or the plant came or went.
  bool breaks(const TickRecord& record) const;
  void add(const TickRecord& record, const StepBatch& batch);
  /// The messages of the block; steps_message() codes the pulses. Then clear() begins the next block.
  const ticks_t& ticks_message() const { return ticks_; }
  const steps_t& steps_message();
  Ticks end() const;
  void clear() { ticks_.n = 0; }

  /// Viewer messages of the tick added last.
  feed_t feed_message(const TickRecord& record) const;
  axis_t axis_message(const TickRecord& record, const StepBatch& batch, std::size_t axis) const;

 private:
  void begin_block(const TickRecord& record);
  void begin_lattice(const TickRecord& record, const StepBatch& batch);
  Ticks tick_end(ControlTicks tick) const;
  double seconds(Ticks ticks) const;

  const machine::MachineModel& machine_;
  ticks_t ticks_{};
  steps_t steps_{};
  std::vector<PulseEncoder> pulses_;          // [axes]
  std::vector<std::int64_t> lattice_offset_;  // [axes] lattice node - position_steps; set by the first tick
  std::vector<std::int64_t> node_;            // [axes] of the tick added last
  bool has_override_ = false;
  double accel_u_s2_ = 0, jerk_u_s3_ = 0;  // of the tick added last
};

}  // namespace kadr::emulator
