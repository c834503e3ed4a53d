#pragma once
#include <optional>
#include <vector>

#include "emulator/cycle/input_timeline.h"
#include "emulator/emulator.h"
#include "planner/planner.h"

namespace kadr::emulator {

/// Takes the blocks of a program as they are interpreted and lays them out along the path: moves make path,
/// all else happens at its joints. Answers what an input reads while the program is still being read, from
/// the planned time of all that came before.
class ProgramReader {
 public:
  ProgramReader(Job& job, Diagnostics& diagnostics, const AxisValues& home);

  void take(const gcode::Block& block);
  /// What M66 gets: the machine stands, and waits from the time at which its path so far has been travelled.
  gcode::InputReading read_input(const gcode::InputWait& wait);
  /// Hands path, events and number of blocks to the job.
  void finish();

 private:
  void take_motion(const gcode::Block& block);
  void take_event(const gcode::Block& block);
  void take_wait(const gcode::Block& block, const gcode::InputWait& wait);
  void keep_output(const gcode::Block& block);
  void add_event(const gcode::Block& block);
  void place_events();
  WaitOutcome begin_wait(const gcode::InputWait& wait);
  double time_so_far_s();

  Job& job_;
  Diagnostics& diagnostics_;
  planner::PathBuilder builder_;
  std::vector<gcode::Block> outputs_;  ///< that change as the next motion begins
  bool sync_by_angle_ = false;         ///< moves follow the spindle's angle
  bool moved_by_angle_ = false;        ///< the last move did
  double time_s_ = 0;                  ///< planned time of what is counted below
  std::size_t timed_segments_ = 0;
  std::size_t timed_events_ = 0;
  // the wait's block and the question what it reads come in either order: the first one keeps the answer
  std::optional<WaitOutcome> for_block_, for_program_;
};

}  // namespace kadr::emulator
