#pragma once
#include <optional>
#include <vector>

#include "emulator/cycle/input_timeline.h"
#include "emulator/emulator.h"
#include "planner/planner.h"

namespace kadr::cycle {

/// Takes the blocks of a program as they are interpreted and lays them out along the path: moves make path,
/// everything else happens at its joints. Answers the reading of an input while the program is still being read, from
/// the planned time of all that came before.
class ProgramReader {
 public:
  /// @param given, diagnostics  outlive this
  ProgramReader(const JobInputs& given, Diagnostics& diagnostics, const AxisValues& home);

  void take(const gcode::Block& block);
  /// Answers M66: the machine is at rest, and waits from the planned end of its path so far.
  gcode::InputReading read_input(const gcode::InputWait& wait);
  /// Path, events and number of blocks, after the last block.
  ReadProgram finish();

 private:
  void take_motion(const gcode::Block& block);
  void take_approach(const gcode::Block& block);
  void take_event(const gcode::Block& block);
  void take_wait(const gcode::Block& block, const gcode::InputWait& wait);
  void keep_output(const gcode::Block& block);
  void add_event(const gcode::Block& block);
  void place_events(const planner::Path& path);
  WaitOutcome begin_wait(const gcode::InputWait& wait);
  double time_so_far_s();

  const JobInputs& given_;
  Diagnostics& diagnostics_;
  planner::PathBuilder builder_;
  std::vector<ProgramEvent> events_;
  std::uint32_t blocks_ = 0;
  std::vector<bool> line_limits_met_;  ///< [given.line_limits] a motion begins there
  std::optional<gcode::Block> approach_;
  std::vector<gcode::Block> outputs_;  ///< that change as the next motion begins
  bool sync_by_angle_ = false;         ///< moves follow the spindle's angle
  bool moved_by_angle_ = false;        ///< the last move did
  double time_s_ = 0;                  ///< planned time of the items counted below
  std::size_t timed_segments_ = 0;
  std::size_t timed_events_ = 0;
  // the wait's block and the query for its reading come in either order: the first one keeps the answer
  std::optional<WaitOutcome> for_block_, for_program_;
};

}  // namespace kadr::cycle
