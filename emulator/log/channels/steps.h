#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/channel.h"
#include "emulator/log/tick_columns.h"
#include "machine/step_batch.h"

namespace kadr::log {

/// KADR_STEPS as it stands in the log: the pulses of a block of control ticks as code (pulse_code.h).
struct PulseBlock {
  Ticks begin;
  ControlTicks first;
  std::int32_t ticks = 0;
  std::vector<std::int32_t> pulses, reversals, bytes;  ///< [axes]
  std::vector<std::uint8_t> code;
};

/// KADR_STEPS decoded; batches[i] holds the pulses of control tick first + i (their AxisCommand is not in the
/// log: see TickBlock).
struct StepBlock {
  Ticks begin;
  ControlTicks first;
  std::vector<StepBatch> batches;
};

/// @return the reason why the code is none
tl::expected<StepBlock, std::string> decode_steps(const PulseBlock& coded, const LogHeader& header);

const char* check_message(PulseBlock& block, std::string_view channel, const LogHeader& header);

template <std::same_as<PulseBlock> R>
struct Channel<R> {
  static constexpr ChannelTitle info{
      "KADR_STEPS", "steps_t",
      "every pulse of the same control ticks, as section 4 codes it; follows their "
      "KADR_TICKS"};
  static constexpr std::size_t first_fields = 9;
  static constexpr std::array fields{
      field::i64<&R::begin>("tick", "beginning of the first control tick; pulse times count from here"),
      field::i64<&R::first>("first_control_tick", ""),
      field::i32<&R::ticks>("n_ticks", "control ticks, 1..64"),
      field::count<R, field::length<&R::pulses>>("n_axes", CountRule::log_axes),
      field::i32<&R::pulses>("pulses", "count").by("n_axes"),
      field::i32<&R::reversals>("reversals", "changes of direction").by("n_axes"),
      field::i32<&R::bytes>("bytes", "length of each axis' code").by("n_axes"),
      field::count<R, field::length<&R::code>>("n_bytes", CountRule::any, "sum of bytes"),
      field::byte<&R::code>("code", "axis after axis").by("n_bytes"),
  };
};

}  // namespace kadr::log
