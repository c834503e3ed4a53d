#pragma once
#include <functional>
#include <string>
#include <vector>

#include "emulator/log_tools/diff/log_frames.h"
#include "emulator/log_tools/export/log_samples.h"

namespace kadr::log_tools {

/// How one axis moves, from the positions of successive control ticks: means over the tick that ended.
struct CommandedAxis {
  double command_u = 0;
  double speed_u_s = 0, accel_u_s2 = 0, jerk_u_s3 = 0;
};

/// The source of a signal's value.
struct TickContext {
  const log::LogHeader* header = nullptr;
  const LogFrame* frame = nullptr;
  std::vector<CommandedAxis> axis;  ///< [axes]
  double feed_jerk_u_s3 = 0;        ///< change of the path's acceleration over the tick
  const log::TickBlock& ticks() const { return *frame->ticks; }
  std::size_t at() const { return frame->tick_index; }
};

/// A signal and how its value is found.
struct SignalSource {
  Signal signal;
  std::function<double(const TickContext&)> value;
};

/// All signals of a log.
/// @param first  a control tick with exact data: what it holds, every tick of the log holds
std::vector<SignalSource> signal_table(const log::LogHeader& header, const LogFrame& first);

/// Moves a context on to the next control tick.
/// @param tau_s  length of a control tick
void advance(TickContext& context, const LogFrame& frame, double tau_s);

}  // namespace kadr::log_tools
