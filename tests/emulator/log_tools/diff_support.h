#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/emulator/log/log_support.h"

/// Logs that differ at a known position, for the tests of the comparison.
namespace kadr::test {

/// One control tick before it is written; everything in it may be changed.
struct ChangeableTick {
  std::int64_t number = 0;
  TickMotion motion;
  StepBatch batch;
  std::vector<AxisState> states;
  std::vector<log::EventRecord> events;
  std::optional<log::BlockRecord> block;  ///< of the ticks in which one begins
};
using ChangeTick = std::function<void(ChangeableTick&)>;

/// Writes a FakeRun with a block every 100 ticks and an event every 250, changed by `change`.
/// @param header  the contents of KADR_RUN; its machine is used
void write_changed(const std::string& path, const log::RunHeader& header, std::int64_t control_ticks,
                   const ChangeTick& change = {}, log::Outcome outcome = log::Outcome::complete);

/// A path of 10 mm in blocks of 1 mm: X = s, Y = s/2, Z = s, steps of 1 um, one crossing after the other.
struct PathRun {
  std::function<double(double s_mm)> feed_mm_s = [](double) { return 50.0; };
  std::int64_t rest_ticks = 0;  ///< control ticks at rest before the motion
  /// May change the time order of the run's pulses: (axis, number of the pulse from 0, its path length).
  std::function<double(int axis, std::int64_t pulse, double s_mm)> place = [](int, std::int64_t,
                                                                              double s_mm) { return s_mm; };
  std::function<bool(int axis, std::int64_t pulse)> drops = [](int, std::int64_t) { return false; };
  std::function<bool(int axis, std::int64_t pulse)> flips = [](int, std::int64_t) { return false; };
  double end_mm = 10;
};
void write_path_log(const std::string& path, const machine::MachineModel& machine, const PathRun& run);

}  // namespace kadr::test
