#pragma once
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "emulator/log/log_reader.h"
#include "emulator/log/run_log.h"
#include "machine/step_hash.h"

/// A made-up run for the log's tests: every number is a pure function of the control tick.
namespace kadr::test {

inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Small and the same everywhere (splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  /// Uniform in [low, high].
  std::int64_t between(std::int64_t low, std::int64_t high);
  double real(double low, double high);

 private:
  std::uint64_t state_;
};

/// 10 MHz, 1 ms, steps of 1 um; axes X Y Z A B ...
machine::MachineModel log_machine(int axes);

struct FakeRunOptions {
  double peak_steps_per_s = 50'000;  ///< of the first axis; each next axis goes a little slower
  std::int64_t ramp_ticks = 400;     ///< from rest to the peak; rest for a fifth of that at every turn
  bool plant = true;
  bool has_override = false;
  bool wobble = true;  ///< the crossing times of a curve: the pulse interval moves by some base ticks
};

/// Axes run to and fro with linear ramps; steps at the half crossings of that motion.
class FakeRun {
 public:
  FakeRun(const machine::MachineModel& machine, FakeRunOptions options = {});
  /// The next control tick; the record points into this object.
  const log::TickRecord& advance();
  const StepBatch& batch() const { return batch_; }
  const std::vector<AxisState>& states() const { return states_; }
  const std::vector<Steps>& nodes() const { return steps_; }
  std::int64_t pulses() const { return pulses_; }

 private:
  double speed_steps_per_tick(std::int64_t tick) const;
  void make_pulses(std::size_t axis, double begin_steps, double end_steps);

  const machine::MachineModel& machine_;
  FakeRunOptions options_;
  std::int64_t tick_ = 0;
  double path_steps_ = 0;
  std::int64_t pulses_ = 0;
  TickMotion motion_;
  StepBatch batch_;
  std::vector<double> position_steps_;  // of the motion, before the lattice
  std::vector<Steps> steps_;            // lattice node
  std::vector<AxisState> states_;
  log::TickRecord record_;
};

/// True if the exact data of a log, as far as it goes, are those of the FakeRun, pulse by pulse and bit by bit.
bool holds_fake_run(const std::string& path, const machine::MachineModel& machine,
                    FakeRunOptions options = {});

/// What a summary says of the messages before it; a reader checks it.
class Totals {
 public:
  explicit Totals(const machine::MachineModel& machine);
  void add(const StepBatch& batch);
  void add(const log::EventRecord& event);
  void add(const log::BlockRecord& block);
  /// @param nodes  lattice nodes at the end; empty: those that the pulses lead to
  void put_into(log::RunSummary& summary, const std::vector<Steps>& nodes = {}) const;

 private:
  struct AxisTotals {
    std::int64_t pulses = 0, net_steps = 0, home = 0;
  };
  std::vector<AxisTotals> axis_;
  StepHash hash_;
  std::int64_t pulses_ = 0;
  std::uint32_t blocks_ = 0;
  std::size_t alarms_ = 0;
};

log::RunHeader log_header(const machine::MachineModel& machine);
log::RunSummary log_summary(const machine::MachineModel& machine, std::int64_t control_ticks,
                            const Totals& totals, const std::vector<Steps>& nodes = {});

/// Writes a whole log: header, a block every 100 ticks with its end, an event every 250, one diagnostic, the
/// ticks, the summary. @return the pulses written
std::int64_t write_log(const std::string& path, const machine::MachineModel& machine,
                       std::int64_t control_ticks, FakeRunOptions options = {},
                       log::Outcome outcome = log::Outcome::complete);

/// A new folder for one test case, removed with everything in it.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::vector<std::uint8_t> read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes);

}  // namespace kadr::test
