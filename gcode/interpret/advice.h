#pragma once
#include <cstdint>

#include "gcode/block.h"
#include "gcode/gcode.h"
#include "gcode/interpret/state.h"
#include "gcode/read/report.h"

namespace kadr::gcode {

/// Warns of code that is legal but hardly ever intended: it watches the blocks as they are made. Rules that a good
/// program could break on purpose are left out: a warning that is often wrong is not read.
class Advice {
 public:
  Advice(const State& state, const InterpretOptions& options, Report& report);

  /// A block is about to be handed out.
  void watch(const Block& block) {
    if ((wanted_ & (std::uint64_t{1} << static_cast<unsigned>(block.kind()))) != 0) look(block);
    follow(block);
  }
  /// G43, G43.1, G43.2 or G49 was read: the length in force is meant.
  void length_named() { length_doubtful_ = false; }
  /// G28 or G30 with axis words goes there first.
  void way_to_reference(const AxisValues& from, const AxisValues& by, Span span);

 private:
  void look(const Block& block);
  void follow(const Block& block);
  void spindle_started(Span span);
  void program_ended(Span span);
  void tool_changed(const ChangeTool& change);
  void check_dwell(const Dwell& dwell, Span span);
  void check_move(const Move& move, const Block& block);
  void check_length(Span span);
  void tell_cut_without_spindle();
  void watch_moves();

  const State& state_;
  Report& report_;
  const bool seconds_;        ///< P of a dwell is in seconds
  std::uint64_t wanted_ = 0;  ///< bit per BlockKind that some rule waits for
  bool spindle_runs_ = false;
  bool spindle_ran_ = false;
  Span spindle_began_;    ///< where it was started last
  Span spindle_stopped_;  ///< what stopped it
  bool probing_ = false;  ///< a probe is in the spindle: it moves without turning
  Span cut_;              ///< first feed move downward with the spindle stopped; line 0: none
  double z_mm_ = 0;       ///< where the last move ended
  bool length_doubtful_ = false;
  AxisValues length_in_force_{};  ///< as the tool was changed
};

}  // namespace kadr::gcode
