#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <tuple>

#include "machine/file/machine_keys.h"
#include "machine/machine.h"
#include "machine/machine_file.h"
#include "machine/motor.h"

using namespace kadr;
using namespace kadr::machine;

namespace {

std::uint64_t environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

constexpr std::string_view kSmall = R"(format = 1
name = "small"

[[axis]]
name = "X"
steps_per_mm = 400
range_mm = [-100, 100]
max_mm_s = 100
max_acceleration_mm_s2 = 1000
max_jerk_mm_s3 = inf
)";

tl::expected<MachineFile, Diagnostics> read(std::string text, const std::vector<std::string>& settings = {}) {
  SourceSet sources;
  auto file = read_machine(SourceText("m.toml", std::move(text)), sources, settings);
  if (!file)
    for (const Diagnostic& d : file.error().list()) INFO(render_human(d, sources));
  return file;
}

MachineFile read_small(const std::vector<std::string>& settings = {}) {
  auto file = read(std::string(kSmall), settings);
  REQUIRE(file);
  return *file;
}

/// The rest of the line of render_machine() that begins with `begin`.
std::string line_of(const std::string& text, const std::string& begin) {
  const auto at = text.find('\n' + begin);
  return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

}  // namespace

TEST_CASE("a file of ten lines is a machine; what it does not say has the documented default") {
  const MachineModel m = read_small().model;
  CHECK(m.name == "small");
  CHECK(m.clock.base_hz == 10'000'000);
  CHECK(m.clock.control_tick == Ticks{10'000});
  CHECK(m.on_alarm == OnAlarm::report);
  CHECK(m.path == PathLimits{});
  CHECK(m.planner == PlannerSettings{});
  CHECK(m.feed_override == OverrideSettings{});
  CHECK(m.spindle == SpindleReaction{});
  CHECK(m.plant == PlantSettings{});
  CHECK(m.log == LogSettings{});
  REQUIRE(m.axis.size() == 1);
  const AxisModel& x = m.axis[0];
  CHECK(x.kind == AxisKind::linear);
  CHECK(x.step_u == 0.0025);  // 1/400
  CHECK(x.soft_min_u == -100);
  CHECK(x.home_u == 0);
  CHECK(x.junction_accel_u_s2 == 1000);  // as max_acceleration
  CHECK(x.junction_jerk_u_s3 == kInfinity);
  CHECK_FALSE(x.has_plant);
  CHECK(m.home2 == AxisValues{});
}

TEST_CASE("a setting of the command line replaces the value of the file, adds keys and whole tables") {
  const MachineModel m =
      read_small({"axis.X.max_mm_s=50", "feed.max_jerk_mm_s3=2e4", "name=other", "axis.X.range_mm=[-10, inf]",
                  "clock.control_period_us=250", "planner.whole_ticks=false", "planner.tick_feed=constant",
                  "axis.X.step_mm=.01", "axis.X.max_mm_s=60", "axis.X.home2_mm=7",
                  "planner.scheduler=blockwise", "override.mode=proportional", "override.limiter=matched",
                  "spindle.least_pct=50"})
          .model;
  CHECK(m.name == "other");
  CHECK(m.axis[0].max_feed_u_s == 60);  // the last one counts
  CHECK(m.path.max_jerk_mm_s3 == 20000);
  CHECK(m.axis[0].soft_min_u == -10);
  CHECK(m.axis[0].soft_max_u == kInfinity);
  CHECK(m.clock.control_tick == Ticks{2'500});
  CHECK_FALSE(m.planner.whole_ticks);
  CHECK(m.planner.tick_feed == TickFeed::constant);
  CHECK(m.planner.scheduler == SchedulerKind::blockwise);
  CHECK(m.feed_override.mode == OverrideMode::proportional);
  CHECK(m.feed_override.limiter == LimiterKind::matched);
  CHECK(m.spindle.least_pct == 50);
  CHECK(m.axis[0].step_u == 0.01);  // in place of steps_per_mm of the file
  CHECK(m.home2[0] == 7);
}

TEST_CASE("one setting changes the motor of mill3, since the numbers of the other model stand beside") {
  const auto m = read(std::string(shipped_machine("mill3")), {"axis.X.plant.model=stepper"});
  REQUIRE(m);
  CHECK(m->model.axis[0].plant.motor == MotorModel::stepper);
  CHECK(m->model.axis[0].plant.holding_force_N == 1350);
  CHECK(m->model.axis[1].plant.motor == MotorModel::spring);
}

TEST_CASE("a control period of 62.5 us is 1000 ticks at 16 MHz, and 0.1 us is one tick at 10 MHz") {
  CHECK(read_small({"clock.rate_hz=16e6", "clock.control_period_us=62.5"}).model.clock.control_tick ==
        Ticks{1000});
  CHECK(read_small({"clock.control_period_us=0.1"}).model.clock.control_tick == Ticks{1});
  CHECK(read_small({"clock.control_period_us=6553.6"}).model.clock.control_tick == Ticks{65536});
  CHECK_FALSE(read(std::string(kSmall), {"clock.control_period_us=6553.7"}));
}

TEST_CASE("a step rate of exactly half the base clock is allowed, one step more is not") {
  // 12.5 mm/s at 0.0000025 mm a step is 5,000,000 steps/s
  CHECK(read(std::string(kSmall), {"axis.X.step_mm=0.0000025", "axis.X.max_mm_s=12.5"}));
  const auto above = read(std::string(kSmall), {"axis.X.step_mm=0.0000025", "axis.X.max_mm_s=12.500001"});
  REQUIRE_FALSE(above);
  CHECK(above.error().list().at(0).code == Code::machine_step_rate);
}

TEST_CASE("every value is shown with its origin: line of the file, command line or default") {
  const std::string text = render_machine(read_small({"feed.max_mm_s=50"}));
  CHECK(line_of(text, "name = \"small\"").ends_with("# m.toml:2"));
  CHECK(line_of(text, "step_mm = 0.0025").ends_with("# m.toml:6 (steps_per_mm)"));
  CHECK(line_of(text, "max_mm_s = 50").ends_with("# command line"));
  CHECK(line_of(text, "max_mm_s = 100").ends_with("# m.toml:8"));
  CHECK(line_of(text, "rate_hz = 10000000").ends_with("# default"));
  CHECK(line_of(text, "max_jerk_mm_s3 = inf").ends_with("# default"));  // [feed] comes first
  CHECK(line_of(text, "junction_acceleration_mm_s2 = 1000").ends_with("# default"));
}

TEST_CASE("the four shipped machines, shown and read back, are the same machines") {
  for (const auto name : shipped_machine_names()) {
    const auto first = read(std::string(shipped_machine(name)));
    REQUIRE(first);
    const auto second = read(render_machine(*first));
    REQUIRE(second);
    CHECK(first->model == second->model);
  }
}

namespace {

/// Random machines that a file can say.
class MachineMaker {
 public:
  explicit MachineMaker(std::uint64_t seed) : random_(seed) {}

  MachineModel machine() {
    MachineModel m;
    m.name = pick(4) == 0 ? "quo\"ted\\ станок" : "m" + std::to_string(random_());
    m.on_alarm = static_cast<OnAlarm>(pick(2));
    if (pick(2) == 0) m.units = static_cast<StartUnits>(pick(2));
    if (pick(2) == 0) m.startup = "G18 G7";
    m.clock.base_hz = static_cast<std::int64_t>(1 + pick(200)) * 1'000'000;
    m.clock.control_tick = Ticks{static_cast<std::int64_t>(1 + pick(65536))};
    m.path = {or_inf(1e3), or_inf(1e4), or_inf(1e6), or_inf(1e4), positive(1), positive(1) / 2};
    m.planner = {pick(2) == 0, static_cast<AxisLimitRule>(pick(2)), static_cast<TickFeed>(pick(2)),
                 positive(9)};
    m.plant = {static_cast<IntegratorKind>(pick(3)), positive(1e-3)};
    m.log = {pick(2) == 0, pick(2) == 0, ControlTicks{static_cast<std::int64_t>(16 + pick(49))},
             0.5 / m.clock.tau_s() * unit()};
    std::string letters(kAxisLetters);
    std::shuffle(letters.begin(), letters.end(), random_);
    letters.resize(1 + pick(9));
    for (const char letter : letters) m.axis.push_back(axis(letter, m));
    if (pick(2) == 0) m.codes = codes();
    return m;
  }

 private:
  /// [codes]: names are passed over, take time, switch an output or call a subroutine.
  OwnerCodes codes() {
    OwnerCodes codes;
    for (int number = 31; number < 40; ++number) {
      OwnerCode own;
      own.code = {pick(2) == 0 ? 'M' : 'G', number, {}};
      switch (pick(4)) {
        case 0:
          codes.ignore.push_back(own.code);
          continue;
        case 1:
          own.time_s = positive(100);
          break;
        case 2:
          own.output = static_cast<int>(pick(64));
          own.on = pick(2) == 0;
          own.stop = pick(2) == 0;
          break;
        default:
          own.call = pick(2) == 0 ? "clamp" : "\\зажим";
          break;
      }
      codes.own.push_back(own);
    }
    return codes;
  }

  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::uint64_t pick(std::uint64_t n) { return random_() % n; }
  double positive(double scale) { return scale * (unit() + 0.001); }
  double or_inf(double scale) { return pick(3) == 0 ? kInfinity : positive(scale); }

  AxisModel axis(char letter, MachineModel& m) {
    AxisModel a;
    a.letter = letter;
    const bool free = letter >= 'U' && letter <= 'W';
    a.kind = is_rotary_letter(letter) || (free && pick(2) == 0) ? AxisKind::rotary : AxisKind::linear;
    a.max_feed_u_s = positive(100);
    a.step_u = a.max_feed_u_s / (static_cast<double>(m.clock.base_hz) / 2) * (1 + 100 * unit());
    if (a.step_u < 1e-7) a.step_u = 0.01;
    a.soft_min_u = pick(3) == 0 ? -kInfinity : -positive(500);
    a.soft_max_u = pick(3) == 0 ? kInfinity : positive(500);
    a.home_u = std::max(a.soft_min_u, -1.0) / 2;
    a.max_accel_u_s2 = positive(5000);
    a.max_jerk_u_s3 = or_inf(1e5);
    a.junction_accel_u_s2 = positive(5000);
    a.junction_jerk_u_s3 = or_inf(1e5);
    m.home2[static_cast<std::size_t>(axis_index(letter))] = std::min(a.soft_max_u, 1.0) / 3;
    a.has_plant = pick(3) != 0;
    if (a.has_plant) a.plant = plant(m.plant.integrator == IntegratorKind::oracle);
    return a;
  }

  TwoMassModel plant(bool linear) {
    AxisModel axis;
    TwoMassModel& p = axis.plant;
    do {
      p.motor = kMotorModels.words[static_cast<std::size_t>(pick(kMotorModels.size()))].value;
    } while (linear && !Motor(axis).linear());
    const auto draw = [&](const auto& key) {
      const bool needed =
          key.need == Need::link || (key.need == Need::motor && motor_needs(p.motor, key.member));
      if (needed || pick(2) == 0) p.*key.member = positive(1e3);
    };
    std::apply([&](const auto&... key) { (draw(key), ...); }, kPlantKeys);
    return p;
  }

  std::mt19937_64 random_;
};

}  // namespace

TEST_CASE("any machine, shown and read back, is the same machine to the last bit") {
  MachineMaker maker(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 500);
  for (std::uint64_t i = 0; i < count; ++i) {
    MachineFile file;
    file.model = maker.machine();
    const std::string text = render_machine(file);
    const auto back = read(text);
    INFO(text);
    REQUIRE(back);
    CHECK(back->model == file.model);
  }
}

TEST_CASE("a machine file says units and startup, and what they may be") {
  const std::string mill(shipped_machine("mill3"));
  const auto with = [&](const std::string& keys) { return read("units = \"inch\"\n" + keys + mill); };
  const auto good = with("startup = \"G18 G7\"\n");
  REQUIRE(good);
  CHECK(good->model.units == StartUnits::inch);
  CHECK(good->model.startup == "G18 G7");
  CHECK_FALSE(read(mill)->model.units.has_value());
  CHECK_FALSE(with("startup = \"" + std::string(201, 'G') + "\"\n"));
  CHECK_FALSE(with("startup = \"G18\\nG7\"\n"));
  CHECK_FALSE(read("units = \"feet\"\n" + mill));
}

TEST_CASE("a machine file with random damage is refused with places inside the file, or read; never more") {
  std::mt19937_64 random(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 3000);
  const std::string whole(shipped_machine("mill3"));
  constexpr std::string_view scraps[] = {"[",         "]",  "=",   "\"",   "inf", "nan",  "-",
                                         "1e999",     "\n", ".",   ",",    "#",   "\xff", "[[axis]]\n",
                                         "[clock]\n", "{",  "'''", "axis", "0",   "\\u",  "9999999999"};
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string text = whole;
    for (std::uint64_t n = 1 + random() % 4; n > 0; --n) {
      const std::size_t at = random() % text.size();
      const std::string_view scrap = scraps[random() % std::size(scraps)];
      if (random() % 2 == 0)
        text.insert(at, scrap);
      else
        text.erase(at, random() % 40);
    }
    SourceSet sources;
    const auto file = read_machine(SourceText("m.toml", text), sources);
    if (file) {
      for (const AxisModel& axis : file->model.axis) CHECK(axis.max_feed_u_s > 0);
      continue;
    }
    ++refused;
    CHECK(file.error().has_errors());
    for (const Diagnostic& d : file.error().list()) {
      CHECK(d.span.line >= 1);
      CHECK(d.span.column >= 1);
      CHECK(d.span.column <= sources[d.span.file].line(d.span.line).size() + 1);
      CHECK_FALSE(render_human(d, sources).empty());
    }
  }
  CHECK(refused > count / 4);
}
