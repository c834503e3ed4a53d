#include "diff_support.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "machine/machine.h"

namespace kadr::test {
namespace {

void check(const tl::expected<void, log::LogError>& done) {
  if (!done) throw std::runtime_error(done.error().path + ": " + done.error().reason);
}

std::unique_ptr<log::RunLog> open(const std::string& path) {
  auto log = log::open_lcm_log({path, ""});
  if (!log) throw std::runtime_error(log.error().path + ": " + log.error().reason);
  return std::move(*log);
}

log::BlockRecord block_record(Ticks tick, std::uint32_t block, std::uint32_t line, const char* text) {
  log::BlockRecord record;
  record.tick = tick;
  record.block = block;
  record.span = {0, line, 1, 8};
  record.text = text;
  record.motion = "line";
  record.length_u = 1;
  return record;
}

}  // namespace

void write_changed(const std::string& path, const log::RunHeader& header, std::int64_t control_ticks,
                   const ChangeTick& change, log::Outcome outcome) {
  const machine::MachineModel& machine = *header.machine;
  const auto log = open(path);
  check(log->begin(header));
  FakeRun run(machine);
  Totals totals(machine);
  const std::int64_t tau = machine.clock.control_tick.value;
  for (std::int64_t k = 0; k < control_ticks; ++k) {
    log::TickRecord record = run.advance();
    ChangeableTick tick{k, *record.motion, run.batch(), run.states(), {}, {}};
    const auto number = static_cast<std::uint32_t>(k / 100);
    if (k % 250 == 249)
      tick.events.push_back({Ticks{k * tau + 9},
                             number,
                             {0, 0, 0, 0},
                             log::EventKind::input,
                             Code{},
                             -1,
                             1,
                             0,
                             "digital input 3 = 1"});
    if (k % 100 == 0)
      tick.block =
          block_record(Ticks{k * tau + 7}, number, number % 2 + 1, number % 2 == 0 ? "N10 G1 X10" : "M2");
    if (change) change(tick);
    if (tick.block) {
      totals.add(*tick.block);
      check(log->block(*tick.block));
    }
    for (const auto& event : tick.events) {
      totals.add(event);
      check(log->event(event));
    }
    record.motion = &tick.motion;
    record.axis = &tick.states;
    totals.add(tick.batch);
    check(log->tick(record, tick.batch));
  }
  log::RunSummary summary = log_summary(machine, control_ticks, totals, run.nodes());
  summary.outcome = outcome;
  check(log->end(summary));
}

void write_path_log(const std::string& path, const machine::MachineModel& machine, const PathRun& run) {
  const auto log = open(path);
  check(log->begin(log_header(machine)));
  struct Pulse {
    double s_mm;
    int sign;
  };
  std::vector<std::vector<Pulse>> pulses(3);
  for (int axis = 0; axis < 3; ++axis) {
    const double per_pulse_mm = axis == 1 ? 0.002 : 0.001;
    for (std::int64_t n = 0; static_cast<double>(n) * per_pulse_mm + per_pulse_mm / 2 <= run.end_mm; ++n)
      if (!run.drops(axis, n))
        pulses[static_cast<std::size_t>(axis)].push_back(
            {run.place(axis, n, (static_cast<double>(n) + 0.5) * per_pulse_mm), run.flips(axis, n) ? -1 : 1});
  }
  const double tau_ticks = static_cast<double>(machine.clock.control_tick.value),
               tau_s = machine.clock.tau_s();
  double s_mm = 0, speed_mm_s = 0;
  std::vector<std::size_t> next(3, 0);
  std::vector<Steps> steps(3);
  StepBatch batch;
  batch.axis.resize(3);
  Totals totals(machine);
  std::int64_t k = 0;
  std::uint32_t block = 0;
  const auto tick_of = [&](double from_mm, double to_mm, double at_mm) {
    return static_cast<std::int64_t>(std::floor(tau_ticks * (at_mm - from_mm) / (to_mm - from_mm)));
  };
  for (; s_mm < run.end_mm; ++k) {
    TickMotion motion;
    motion.tick = batch.tick = ControlTicks{k};
    const double feed_mm_s = k < run.rest_ticks ? 0 : run.feed_mm_s(s_mm);
    const double to_mm = std::min(s_mm + feed_mm_s * tau_s, run.end_mm);
    motion.s_begin_u = s_mm;
    motion.s_end_u = to_mm;
    motion.speed_begin_u_s = speed_mm_s;
    motion.speed_end_u_s = feed_mm_s;
    motion.accel_end_u_s2 = (feed_mm_s - speed_mm_s) / tau_s;
    for (; to_mm > s_mm && block < run.end_mm && block < to_mm; ++block) {
      const auto begun =
          block_record(Ticks{k * machine.clock.control_tick.value + tick_of(s_mm, to_mm, block)}, block, 1,
                       "N10 G1 X10 F100 (скругление)");
      totals.add(begun);
      check(log->block(begun));
    }
    for (std::size_t a = 0; a < 3; ++a) {
      AxisPulses& axis = batch.axis[a];
      axis.clear();
      int sign = 0;
      for (; next[a] < pulses[a].size() && pulses[a][next[a]].s_mm < to_mm; ++next[a]) {
        const Pulse& pulse = pulses[a][next[a]];
        if (sign == 0) axis.first_sign = static_cast<std::int8_t>(pulse.sign);
        if (sign != 0 && sign != pulse.sign)
          axis.reversals.push_back(static_cast<std::uint16_t>(axis.count()));
        sign = pulse.sign;
        const std::int64_t offset = std::max<std::int64_t>(tick_of(s_mm, to_mm, pulse.s_mm), 0);
        axis.offset_ticks.push_back(static_cast<std::uint16_t>(offset));
        steps[a] += Steps{pulse.sign};
      }
    }
    log::TickRecord record{ControlTicks{k}, block == 0 ? 0 : block - 1, &motion, &steps, nullptr};
    totals.add(batch);
    check(log->tick(record, batch));
    s_mm = to_mm;
    speed_mm_s = feed_mm_s;
  }
  log::RunSummary summary;
  summary.ticks = Ticks{k * machine.clock.control_tick.value};
  summary.control_ticks = ControlTicks{k};
  totals.put_into(summary, steps);
  check(log->end(summary));
}

}  // namespace kadr::test
