#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "emulator/log/run_words.h"
#include "machine/axis_state.h"
#include "machine/base/diagnostic.h"
#include "machine/step_batch.h"
#include "machine/tick_motion.h"

namespace kadr::machine {
struct MachineModel;
}

/// What the cycle reports to the log, in tick order; a pure function of the inputs: no
/// clock, address, locale or thread.
namespace kadr::log {

/// A file that a run has read.
struct ReadFile {
  std::string role;  ///< "program", "machine", "scenario", "tools", "ini", "called"
  std::string name;  ///< as the file that names it has it; without folders if the user names it
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;  ///< XXH3
};

/// First message: everything needed to run again and to compare.
struct RunHeader {
  std::string program_name;  ///< file name without folders
  std::string program_text;
  std::string machine_toml;   ///< as read
  std::string scenario_toml;  ///< as read, empty if none
  std::string settings_toml;  ///< every value in force
  std::uint64_t inputs_hash = 0;
  std::vector<ReadFile> files;                     ///< in the order in which they were read
  const machine::MachineModel* machine = nullptr;  ///< clock, axes, log settings
};

/// One motion block, when its motion begins.
struct BlockRecord {
  Ticks tick;
  std::uint32_t block = 0;  ///< running number
  Span span;                ///< line and column in the program
  std::string text;         ///< the program line
  std::string motion;       ///< "rapid" "line" "arc"
  double length_u = 0;
  double programmed_u_s = 0;
  double planned_peak_u_s = 0;
  double planned_end_u_s = 0;
  double planned_s = 0;           ///< duration
  std::string limited_by;         ///< e.g. "program", "axis X speed"
  double entry_u_s = 0;           ///< feed at its beginning, as run
  double planned_entry_u_s = 0;   ///< F_KK of the block before, as planned at 100 %
  ControlTicks deferred_ticks{};  ///< that an override has waited for the motion before it
};

/// Result of a motion block, at the first control tick at which another block has begun; only for blocks that
/// were under way at the end of at least one control tick.
struct BlockEndRecord {
  Ticks tick;
  std::uint32_t block = 0;
  std::uint32_t line = 0;
  std::vector<double> peak_link_u;       ///< [axes] largest |x1| at control ticks
  std::vector<double> peak_following_u;  ///< [axes] largest |tool - command| at control ticks
  std::vector<double> positive_J;  ///< [axes] work of the motors where they drive; empty without log.energy
  std::vector<double> recuperated_J;  ///< [axes] and where they brake
};

/// One control tick, at its end. Axis arrays live in the batch (commands) and `axis` (plant).
struct TickRecord {
  ControlTicks tick;        ///< the tick that ended
  std::uint32_t block = 0;  ///< running number of the block at the tick's end
  const TickMotion* motion = nullptr;
  const std::vector<Steps>* position_steps = nullptr;  ///< [axes]
  const std::vector<AxisState>* axis = nullptr;        ///< [axes]; null without plant
  bool has_override = false;  ///< the run has steps of operator or spindle: their requests are kept
};

/// Something that happened at a tick.
struct EventRecord {
  Ticks tick;
  std::uint32_t block = 0;
  Span span;
  StoredWord<kEventKinds> kind = EventKind::message;
  Code code{};       ///< of an alarm, else 0
  int axis = -1;     ///< machine axis, or -1
  double value = 0;  ///< measured
  double limit = 0;  ///< allowed, of an alarm
  std::string text;  ///< one sentence with units
};

struct AxisSummary {
  std::int64_t pulses = 0;  ///< counted, both directions
  Steps net_steps;
  Steps end_steps;  ///< lattice node at the end, from machine zero
  double end_u = 0;
  double min_u = 0, max_u = 0;  ///< commanded extremes at control ticks
  double peak_feed_u_s = 0;
  Ticks peak_feed_tick;
  double peak_accel_u_s2 = 0;
  double peak_jerk_u_s3 = 0;
  double peak_vibration_u = 0;  ///< |x1|
  Ticks peak_vibration_tick;
  std::uint32_t peak_vibration_line = 0;
  double rms_vibration_u = 0;
  double residual_u = 0;        ///< largest envelope after a stop
  double peak_following_u = 0;  ///< |tool - command|
  double rms_following_u = 0;
  Steps lost_steps;
  double positive_J = 0, recuperated_J = 0;  ///< work of the motor where it drives, and where it brakes
};

struct LimitShare {
  std::string limited_by;
  double time_s;
};

/// Last message; a log without it was cut off.
struct RunSummary {
  StoredWord<kOutcomes> outcome = Outcome::complete;
  Ticks ticks;  ///< length of the run
  ControlTicks control_ticks;
  std::uint32_t blocks = 0;
  double path_u = 0;
  double mean_feed_u_s = 0;  ///< over the time in motion
  double peak_feed_u_s = 0;
  double motion_s = 0, dwell_s = 0;
  std::int64_t pulses = 0;
  std::uint64_t steps_hash = 0;        ///< offsets and signs of every pulse, by tick and axis
  double path_error_u = 0;             ///< largest distance of the tool from the command, over the axes X Y Z
  double held_error_u = 0;             ///< tick_feed = constant: largest distance from the law along the path
  std::vector<AxisSummary> axis;       ///< [axes]
  std::vector<LimitShare> limited_by;  ///< descending time
  double planned_s = 0;                ///< motion at 100 %
  std::vector<LimitShare> lost_by;     ///< time lost against that, by reason; < 0: gained
  std::size_t alarms = 0;
  std::size_t warnings = 0;  ///< of the program, from RunOptions
  int exit_code = 0;         ///< of the command that ran it, by RunOptions
};

}  // namespace kadr::log
