#include <fstream>
#include <iterator>
#include <stdexcept>

#include "emulator/log/run_log.h"
#include "log_mutations.h"
#include "machine/machine.h"
#include "machine/step_hash.h"
#include "tests/emulator/log/log_support.h"

namespace kadr::fuzz {
namespace {

constexpr std::int64_t kTicks = 10;

struct Kind {
  bool plant = true, has_override = false, ticks = true, steps = true;
};

void check(const tl::expected<void, log::LogError>& done) {
  if (!done) throw std::runtime_error(done.error().path + ": " + done.error().reason);
}

log::EventRecord event(Ticks tick, log::EventKind kind, const char* text) {
  log::EventRecord e;
  e.tick = tick;
  e.kind = kind;
  if (kind == log::EventKind::alarm) e.code = all_codes().back().code;
  e.axis = 0;
  e.value = 2.5;
  e.limit = 2;
  e.text = text;
  return e;
}

/// Ten control ticks of two axes in blocks of four: two blocks, their ends, an event, an alarm, a diagnostic.
void write(const std::string& path, const machine::MachineModel& machine, const Kind& kind) {
  auto log = log::open_lcm_log({path, ""});
  if (!log) throw std::runtime_error(log.error().path + ": " + log.error().reason);
  check((*log)->begin(test::log_header(machine)));
  check((*log)->diagnostic(
      {all_codes().front().code, Severity::warning, {0, 1, 1, 3}, "text", "label", {"note"}, "help"},
      Ticks{-1}));
  test::FakeRun run(
      machine,
      {.peak_steps_per_s = 20'000, .ramp_ticks = 4, .plant = kind.plant, .has_override = kind.has_override});
  test::Totals totals(machine);
  const std::int64_t tau = machine.clock.control_tick.value;
  const std::vector<double> peaks(machine.axis.size(), 0.5);
  for (std::int64_t k = 0; k < kTicks; ++k) {
    const Ticks begin{k * tau};
    if (k % 5 == 0) {
      const auto number = static_cast<std::uint32_t>(k / 5);
      check((*log)->block(
          {begin, number, {0, number + 1, 1, 3}, "N10 G1 X10", "line", 1, 100, 99, 0, 0.1, "program"}));
      if (k > 0) check((*log)->block_end({Ticks{(k + 1) * tau}, number - 1, 1, peaks, peaks, {}, {}}));
    }
    if (k == 3) check((*log)->event(event(begin + Ticks{5}, log::EventKind::dwell, "dwell")));
    if (k == 7) check((*log)->event(event(begin + Ticks{5}, log::EventKind::alarm, "too fast")));
    const log::TickRecord& record = run.advance();
    totals.add(run.batch());
    check((*log)->tick(record, run.batch()));
  }
  log::RunSummary summary = test::log_summary(machine, kTicks, totals);
  summary.blocks = 2;
  summary.alarms = 1;
  check((*log)->end(summary));
}

}  // namespace

std::vector<Bytes> true_logs() {
  const test::TestFolder folder;
  std::vector<Bytes> logs;
  for (const Kind& kind :
       {Kind{}, Kind{.plant = false, .has_override = true}, Kind{.ticks = false}, Kind{.steps = false}}) {
    machine::MachineModel machine = test::log_machine(2);
    machine.log.block_ticks = ControlTicks{4};
    machine.log.viewer_rate_hz = 500;
    machine.log.ticks = kind.ticks;
    machine.log.steps = kind.steps;
    write(folder / "a", machine, kind);
    logs.push_back(test::read_bytes(folder / "a"));
  }
  return logs;
}

}  // namespace kadr::fuzz
