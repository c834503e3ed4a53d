#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/tick_columns.h"
#include "machine/step_batch.h"

/// The byte code of KADR_STEPS: step pulses of one axis over a block of control ticks, one byte a pulse while
/// the pulse interval changes by less than 64 base ticks from pulse to pulse. docs/log_format.md defines it
/// to the byte.
///
///   t_i    base ticks from the block's beginning to pulse i,   t_-1 = 0
///   d_i    = t_i - t_(i-1),   d_-1 = 0
///   code   = varint(zigzag(d_i - d_(i-1))) for each pulse, then varint(r_j - r_(j-1)) for each reversal
///   r_j    index of a pulse whose direction differs from the pulse before; before the first pulse it is +,
///   r_-1 = 0
namespace kadr::log {

/// Codes the pulses of one axis, tick by tick. Storage is reused from block to block.
class PulseEncoder {
 public:
  void begin_block();
  /// @param begin_ticks beginning of the pulses' control tick, base ticks since the block's beginning
  void add(const AxisPulses& pulses, std::int32_t begin_ticks);
  std::int32_t pulses() const { return pulses_; }
  std::int32_t reversals() const { return static_cast<std::int32_t>(reversal_at_.size()); }
  /// Appends the block's code to `code` and returns its length in bytes.
  std::int32_t finish_block(std::vector<std::uint8_t>& code) const;

 private:
  void note_reversals(const AxisPulses& pulses);

  std::vector<std::uint8_t> code_;  // grows, never shrinks; size_ bytes are used
  std::size_t size_ = 0;
  std::vector<std::int32_t> reversal_at_;  // pulse indices within the block
  std::int32_t pulses_ = 0;
  std::int32_t time_ticks_ = 0;
  std::int32_t interval_ticks_ = 0;
  int sign_ = 1;
};

/// What KADR_STEPS says about one axis in addition to the code.
struct PulseCounts {
  std::int32_t pulses = 0;
  std::int32_t reversals = 0;
  std::int32_t ticks = 0;               ///< control ticks of the block
  std::int32_t control_tick_ticks = 0;  ///< tau
};

/// Decodes one axis of a block into batches[0 .. ticks), which are cleared at that axis first.
/// @return the reason why the bytes are no valid code (cut varint, time running back or beyond the block, ...)
tl::expected<void, std::string> decode_pulses(std::span<const std::uint8_t> code, const PulseCounts& counts,
                                              std::span<StepBatch> batches, std::size_t axis);

}  // namespace kadr::log
