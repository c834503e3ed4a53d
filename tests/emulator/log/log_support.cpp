#include "log_support.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "machine/machine.h"
#include "machine/step_hash.h"

namespace kadr::test {

std::uint64_t Random::bits() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
std::int64_t Random::between(std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(bits() % (static_cast<std::uint64_t>(high - low) + 1));
}
double Random::real(double low, double high) {
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  return low + (high - low) * static_cast<double>(bits() >> 11) * kUnit;
}

machine::MachineModel log_machine(int axes) {
  machine::MachineModel m;
  m.name = "test";
  for (int a = 0; a < axes; ++a) {
    machine::AxisModel axis;
    axis.letter = kAxisLetters[static_cast<std::size_t>(a)];
    axis.kind = is_rotary_letter(axis.letter) ? machine::AxisKind::rotary : machine::AxisKind::linear;
    axis.step_u = 0.001;
    axis.home_u = 0.25 * a;
    axis.has_plant = true;
    m.axis.push_back(axis);
  }
  return m;
}

FakeRun::FakeRun(const machine::MachineModel& machine, FakeRunOptions options)
    : machine_(machine), options_(options), states_(machine.axis.size()) {
  batch_.axis.resize(machine.axis.size());
  for (const machine::AxisModel& axis : machine.axis) {
    position_steps_.push_back(axis.home_u / axis.step_u);
    steps_.push_back(lattice_node(axis.home_u, axis.step_u));
  }
}

/// A trapezium to and fro: up, flat, down, rest, then the same backwards.
double FakeRun::speed_steps_per_tick(std::int64_t tick) const {
  const std::int64_t ramp = options_.ramp_ticks, rest = ramp / 5, leg = 4 * ramp + rest;
  const std::int64_t at = tick % leg;
  const double share = at < ramp       ? static_cast<double>(at) / static_cast<double>(ramp)
                       : at < 3 * ramp ? 1.0
                       : at < 4 * ramp ? static_cast<double>(4 * ramp - at) / static_cast<double>(ramp)
                                       : 0.0;
  return (tick / leg % 2 == 0 ? 1 : -1) * share * options_.peak_steps_per_s * machine_.clock.tau_s();
}

void FakeRun::make_pulses(std::size_t axis, double begin_steps, double end_steps) {
  AxisPulses& pulses = batch_.axis[axis];
  pulses.clear();
  const double span = end_steps - begin_steps;
  pulses.first_sign = span < 0 ? -1 : 1;
  const double tau = static_cast<double>(machine_.clock.control_tick.value);
  std::int64_t& node = steps_[axis].value;
  std::int64_t last = 0;
  while (std::abs(end_steps - static_cast<double>(node)) > 0.5) {
    const double crossing = static_cast<double>(node) + 0.5 * pulses.first_sign;
    auto offset = static_cast<std::int64_t>(std::floor(tau * (crossing - begin_steps) / span));
    if (options_.wobble) offset += (node * 7 + static_cast<std::int64_t>(axis)) % 5;
    last = std::clamp<std::int64_t>(offset, last, machine_.clock.control_tick.value - 1);
    pulses.offset_ticks.push_back(static_cast<std::uint16_t>(last));
    node += pulses.first_sign;
    ++pulses_;
  }
  if (pulses.count() == 0) pulses.first_sign = 1;
}

const log::TickRecord& FakeRun::advance() {
  const double before = speed_steps_per_tick(tick_), after = speed_steps_per_tick(tick_ + 1);
  const double tau_s = machine_.clock.tau_s();
  motion_ = {};
  motion_.tick = batch_.tick = ControlTicks{tick_};
  motion_.s_begin_u = 0.001 * path_steps_;
  path_steps_ += std::abs(before + after) / 2;
  motion_.s_end_u = 0.001 * path_steps_;
  motion_.speed_begin_u_s = 0.001 * std::abs(before) / tau_s;
  motion_.speed_end_u_s = 0.001 * std::abs(after) / tau_s;
  motion_.accel_end_u_s2 = (motion_.speed_end_u_s - motion_.speed_begin_u_s) / tau_s;
  motion_.override_used = 1 - 0.001 * static_cast<double>(tick_ % 50);
  motion_.override_requested = motion_.override_used + 0.25;
  motion_.limiter = 1 - 0.002 * static_cast<double>(tick_ % 7);
  motion_.note = static_cast<OverrideNote>(tick_ / 30 % 4);
  motion_.limited_by = static_cast<LimitedBy>(tick_ / 100 % 11);
  const auto axes = static_cast<std::int64_t>(machine_.axis.size());
  motion_.limiting_axis = static_cast<std::int8_t>(tick_ / 100 % (std::min<std::int64_t>(axes, 3) + 1) - 1);
  for (std::size_t a = 0; a < batch_.axis.size(); ++a) {
    const double share = 1 - 0.07 * static_cast<double>(a), begin = position_steps_[a];
    const double end = begin + share * (before + after) / 2;
    make_pulses(a, begin, end);
    AxisCommand& command = batch_.axis[a].command;
    command = {0.001 * begin, 0.001 * end, 0.001 * share * before / tau_s, 0.001 * share * after / tau_s};
    position_steps_[a] = end;
    const double ripple = 1e-4 * static_cast<double>((tick_ * 37 + static_cast<std::int64_t>(a)) % 101 - 50);
    states_[a] = {command.position_end_u + ripple, command.speed_end_u_s, -3 * ripple, 7 * ripple,
                  1e5 * ripple};
  }
  record_.tick = ControlTicks{tick_};
  record_.block = static_cast<std::uint32_t>(tick_ / 100);
  record_.motion = &motion_;
  record_.position_steps = &steps_;
  record_.axis = options_.plant ? &states_ : nullptr;
  record_.has_override = options_.has_override;
  ++tick_;
  return record_;
}

bool holds_fake_run(const std::string& path, const machine::MachineModel& machine, FakeRunOptions options) {
  auto reader = log::LogReader::open(path);
  if (!reader) return false;
  FakeRun of_ticks(machine, options), of_steps(machine, options);
  bool same = true;
  for (log::LogMessage m; same && reader->next(m);) {
    if (const auto* b = std::get_if<log::TickBlock>(&m))
      for (std::size_t i = 0; same && i < b->size(); ++i) {
        const log::TickRecord& r = of_ticks.advance();
        same = b->first.value + static_cast<std::int64_t>(i) == r.tick.value &&
               b->path_u[i] == r.motion->s_end_u;
        for (std::size_t a = 0; same && a < machine.axis.size(); ++a)
          same = b->axis[a].steps[i] == of_ticks.nodes()[a].value &&
                 b->axis[a].link_u[i] == of_ticks.states()[a].link_u;
      }
    if (const auto* b = std::get_if<log::StepBlock>(&m))
      for (std::size_t i = 0; same && i < b->batches.size(); ++i) {
        of_steps.advance();
        for (std::size_t a = 0; same && a < machine.axis.size(); ++a)
          same = b->batches[i].axis[a].offset_ticks == of_steps.batch().axis[a].offset_ticks &&
                 b->batches[i].axis[a].net_steps() == of_steps.batch().axis[a].net_steps();
      }
  }
  return same;
}

log::RunHeader log_header(const machine::MachineModel& machine) {
  log::RunHeader h;
  h.program_name = "part.ngc";
  h.program_text = "N10 G1 X10 F100 (скругление)\nM2\n";
  h.machine_toml = "format = 1\n";
  h.settings_toml = "log.block_ticks = 32\n";
  h.inputs_hash = 0xfedcba9876543210u;
  h.machine = &machine;
  return h;
}

log::RunSummary log_summary(const machine::MachineModel& machine, std::int64_t control_ticks,
                            const Totals& totals, const std::vector<Steps>& nodes) {
  log::RunSummary s;
  s.ticks = Ticks{control_ticks * machine.clock.control_tick.value};
  s.control_ticks = ControlTicks{control_ticks};
  s.path_u = 1942.113;
  s.mean_feed_u_s = 50.6;
  s.peak_feed_u_s = 109.98;
  s.motion_s = 38.25;
  s.dwell_s = 0.5;
  s.path_error_u = 0.0125;
  s.held_error_u = 0.0625;
  for (std::size_t a = 0; a < machine.axis.size(); ++a) {
    log::AxisSummary x;
    const auto n = static_cast<std::int64_t>(a + 1);
    const auto u = static_cast<double>(n);
    x = {n,
         Steps{-n},
         Steps{10 * n},
         u / 2,
         -u,
         3 * u,
         4 * u,
         Ticks{5 * n},
         6 * u,
         7 * u,
         8 * u,
         Ticks{9 * n},
         static_cast<std::uint32_t>(11 * n),
         12 * u,
         13 * u,
         14 * u,
         15 * u,
         Steps{16 * n}};
    s.axis.push_back(x);
  }
  s.limited_by = {{"program", 23.5}, {"axis X speed", 14.75}};
  s.planned_s = 38.25;
  s.lost_by = {{"hold", 2.5}, {"override", -0.125}};
  s.warnings = 1;
  s.exit_code = 3;
  totals.put_into(s, nodes);
  return s;
}

Totals::Totals(const machine::MachineModel& machine) {
  for (const machine::AxisModel& axis : machine.axis)
    axis_.push_back({.home = lattice_node(axis.home_u, axis.step_u).value});
}

void Totals::add(const StepBatch& batch) {
  hash_.add(batch);
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    const auto count = static_cast<std::int64_t>(batch.axis[a].count());
    pulses_ += count;
    axis_[a].pulses += count;
    axis_[a].net_steps += batch.axis[a].net_steps().value;
  }
}
void Totals::add(const log::EventRecord& event) { alarms_ += event.kind == log::EventKind::alarm ? 1 : 0; }
void Totals::add(const log::BlockRecord&) { ++blocks_; }

void Totals::put_into(log::RunSummary& summary, const std::vector<Steps>& nodes) const {
  summary.pulses = pulses_;
  summary.steps_hash = hash_.digest();
  summary.blocks = blocks_;
  summary.alarms = alarms_;
  summary.axis.resize(axis_.size());
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    summary.axis[a].pulses = axis_[a].pulses;
    summary.axis[a].net_steps = Steps{axis_[a].net_steps};
    summary.axis[a].end_steps = nodes.empty() ? Steps{axis_[a].home + axis_[a].net_steps} : nodes[a];
  }
}

std::int64_t write_log(const std::string& path, const machine::MachineModel& machine,
                       std::int64_t control_ticks, FakeRunOptions options, log::Outcome outcome) {
  const auto check = [](const tl::expected<void, log::LogError>& done) {
    if (!done) throw std::runtime_error(done.error().path + ": " + done.error().reason);
  };
  auto log = log::open_lcm_log({path, ""});
  if (!log) throw std::runtime_error(log.error().path + ": " + log.error().reason);
  check((*log)->begin(log_header(machine)));
  Diagnostic warning{Code{}, Severity::warning, {0, 1, 17, 4}, "text", "label", {"one", "two"}, "help"};
  warning.code = all_codes().front().code;
  check((*log)->diagnostic(warning, Ticks{-1}));
  FakeRun run(machine, options);
  Totals totals(machine);
  const auto begin = [&](const log::BlockRecord& block) {
    totals.add(block);
    check((*log)->block(block));
  };
  const auto happen = [&](const log::EventRecord& event) {
    totals.add(event);
    check((*log)->event(event));
  };
  const std::int64_t tau = machine.clock.control_tick.value;
  for (std::int64_t k = 0; k < control_ticks; ++k) {
    const auto number = static_cast<std::uint32_t>(k / 100);
    const std::vector<double> peaks(machine.axis.size(), 0.001 * static_cast<double>(number));
    const std::vector<double> energies(peaks.size(), 0.25);
    if (k % 100 == 0) {
      begin({Ticks{k * tau + 7},
             number,
             {0, number + 1, 1, 8},
             "N10 G1 X10 F100",
             "line",
             10.5,
             100,
             99,
             0,
             0.105,
             "axis X speed"});
      if (k > 0)
        check(
            (*log)->block_end({Ticks{(k + 1) * tau}, number - 1, number, peaks, peaks, energies, energies}));
    }
    if (k % 250 == 249)
      happen({Ticks{k * tau + 9},
              number,
              {0, 3, 4, 5},
              log::EventKind::alarm,
              all_codes().back().code,
              1,
              2.5,
              2.0,
              "axis Y is too fast: 2.5 mm/s, allowed 2.0 mm/s"});
    const log::TickRecord& record = run.advance();
    totals.add(run.batch());
    check((*log)->tick(record, run.batch()));
  }
  log::RunSummary summary = log_summary(machine, control_ticks, totals);
  summary.outcome = outcome;
  check((*log)->end(summary));
  return run.pulses();
}

TestFolder::TestFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "kadr-log-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("mkdtemp");
  path_ = name;
}
TestFolder::~TestFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}
void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace kadr::test
