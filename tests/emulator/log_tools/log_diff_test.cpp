#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "diff_support.h"
#include "emulator/log_tools/diff/diff_fields.h"
#include "emulator/log_tools/diff/diff_report.h"
#include "emulator/log_tools/diff/log_diff.h"
#include "emulator/log_tools/log_tools.h"

using namespace kadr;
using namespace kadr::log;
using namespace kadr::log_tools;
using kadr::test::ChangeableTick;
using kadr::test::from_environment;
using kadr::test::log_header;
using kadr::test::log_machine;
using kadr::test::Random;
using kadr::test::TestFolder;
using kadr::test::write_changed;

namespace {

constexpr std::int64_t kTicks = 700;

LogDiff compare(const std::string& a, const std::string& b, const DiffOptions& options = {}) {
  auto diff = diff_logs(a, b, options);
  REQUIRE(diff.has_value());
  return std::move(*diff);
}

/// A log and the same with a change, in a folder of their own.
struct Two {
  TestFolder folder;
  machine::MachineModel machine = log_machine(3);
  std::string a = folder / "a.lcmlog", b = folder / "b.lcmlog";
  explicit Two(const test::ChangeTick& change, std::int64_t ticks_b = kTicks) {
    write_changed(a, log_header(machine), kTicks);
    write_changed(b, log_header(machine), ticks_b, change);
  }
};

DiffOptions ignoring(std::initializer_list<const char*> names) {
  DiffOptions options;
  for (const char* name : names) REQUIRE(add_ignored(options, name).has_value());
  return options;
}

}  // namespace

TEST_CASE("a log does not differ from itself: whole, interrupted, cut off anywhere") {
  const TestFolder folder;
  const machine::MachineModel machine = log_machine(3);
  const std::string whole = folder / "a.lcmlog", cut = folder / "cut.lcmlog";
  write_changed(whole, log_header(machine), kTicks);
  const LogDiff diff = compare(whole, whole);
  CHECK(!diff.differ());
  CHECK(!diff.inputs_differ());
  CHECK(diff.both == kTicks);
  CHECK(diff.load_peaks.empty());
  for (const ChannelTotals& totals : diff.channels) CHECK(totals.differing == 0);

  write_changed(folder / "i", log_header(machine), kTicks, {}, Outcome::interrupted);
  CHECK(!compare(folder / "i.part", folder / "i.part").differ());

  const auto bytes = test::read_bytes(whole);
  Random random(from_environment("KADR_SEED", 1));
  for (std::uint64_t n = from_environment("KADR_COUNT", 20); n-- > 0;) {
    const auto size =
        static_cast<std::ptrdiff_t>(random.between(2000, static_cast<std::int64_t>(bytes.size()) - 1));
    test::write_bytes(cut, {bytes.begin(), bytes.begin() + size});
    CHECK(!compare(cut, cut).differ());
  }
}

TEST_CASE("a change of one control tick is found at that very tick, and nothing else is") {
  Random random(from_environment("KADR_SEED", 2));
  for (std::uint64_t n = from_environment("KADR_COUNT", 12); n-- > 0;) {
    const std::int64_t at = random.between(0, kTicks - 1);
    const Two two([&](ChangeableTick& tick) {
      if (tick.number == at) tick.motion.speed_end_u_s += 1e-12 + 1e-12 * tick.motion.speed_end_u_s;
    });
    const LogDiff diff = compare(two.a, two.b);
    REQUIRE(diff.first);
    CHECK(diff.first->tick.control_tick == at);
    CHECK(diff.first->tick.fields.size() == 1);
    CHECK(diff.first->tick.fields[0].field == "feed_u_s");
    CHECK(diff.first->tick.fields[0].unit == "mm/s");
    CHECK(diff.first->tick.place_a.line == at / 100 % 2 + 1);
    CHECK(diff.channels[static_cast<std::size_t>(DiffChannel::command)].differing == 1);
    CHECK(diff.channels[static_cast<std::size_t>(DiffChannel::steps)].differing == 0);
    // two control ticks before and after it, as far as there are
    CHECK(static_cast<std::int64_t>(diff.first->rows.size()) ==
          1 + std::min<std::int64_t>(2, at) + std::min<std::int64_t>(2, kTicks - 1 - at));
    CHECK(!compare(two.a, two.b, ignoring({"KADR_TICKS/feed_u_s"})).differ());
    CHECK(compare(two.a, two.b, ignoring({"KADR_TICKS/path_u", "load", "KADR_STEPS"})).differ());
  }
}

TEST_CASE("feeds at a block's beginning and the wait of an override before it are compared") {
  const std::pair<const char*, void (*)(BlockRecord&)> changes[] = {
      {"entry_u_s", [](BlockRecord& b) { b.entry_u_s += 1e-12; }},
      {"planned_entry_u_s", [](BlockRecord& b) { b.planned_entry_u_s += 1e-12; }},
      {"deferred_ticks", [](BlockRecord& b) { ++b.deferred_ticks; }},
  };
  for (const auto& [field, change] : changes) {
    const Two two([&, change = change](ChangeableTick& tick) {
      if (tick.number == 300) change(*tick.block);
    });
    const LogDiff diff = compare(two.a, two.b);
    REQUIRE(diff.first);
    CHECK(diff.first->tick.control_tick == 300);
    REQUIRE(diff.first->tick.fields.size() == 1);
    CHECK(diff.first->tick.fields[0].field == field);
    CHECK(diff.channels[static_cast<std::size_t>(DiffChannel::block)].differing == 1);
  }
}

TEST_CASE("every field of block_t in kadr.lcm is compared, except the second that repeats the tick") {
  std::ifstream file(std::string(KADR_SOURCE_DIR) + "/emulator/log/kadr.lcm");
  std::string line;
  while (std::getline(file, line) && line != "struct block_t {") {
  }
  std::vector<std::string> fields;
  while (std::getline(file, line) && line != "}") {
    std::istringstream words(line);
    std::string type, name;
    words >> type >> name;
    name.resize(name.find(';'));
    if (name != "t_s") fields.push_back(name);
  }
  REQUIRE(fields.size() == 15);
  std::vector<std::string> compared;
  for (const auto& field : block_fields()) compared.emplace_back(field.name);
  CHECK(compared == fields);
}

TEST_CASE("one bit of a plant state is found, unless a tolerance allows it or it is ignored") {
  const Two two([](ChangeableTick& tick) {
    double& link_u = tick.states[1].link_u;
    if (tick.number == 321) link_u = std::bit_cast<double>(std::bit_cast<std::uint64_t>(link_u) ^ 1u);
  });
  const LogDiff diff = compare(two.a, two.b);
  REQUIRE(diff.first);
  CHECK(diff.first->tick.control_tick == 321);
  REQUIRE(diff.first->tick.fields.size() == 1);
  CHECK(diff.first->tick.fields[0].name() == "Y link_u");
  CHECK(diff.first->context_name == "Y link_u");
  REQUIRE(diff.load_peaks.size() == 1);
  CHECK(diff.load_peaks[0].control_tick == 321);
  CHECK(diff.load_peaks[0].difference > 0);

  DiffOptions options;
  REQUIRE(add_tolerance(options.tolerance, "load=1nm").has_value());
  const LogDiff tolerant = compare(two.a, two.b, options);
  CHECK(!tolerant.differ());
  CHECK(tolerant.load_peaks.size() == 1);
  CHECK(!compare(two.a, two.b, ignoring({"link"})).differ());
  CHECK(!compare(two.a, two.b, ignoring({"load"})).differ());
  DiffOptions other;
  REQUIRE(add_tolerance(other.tolerance, "base=1mm").has_value());
  REQUIRE(add_tolerance(other.tolerance, "link=1mdeg").has_value());
  CHECK(compare(two.a, two.b, other).differ());
}

TEST_CASE("a tolerance holds up to its edge") {
  const Two two([](ChangeableTick& tick) {
    if (tick.number == 100) tick.states[0].link_u = 0.5;
  });
  // the made-up run has ripple = 1e-4 ((3700 + 0) mod 101 - 50) = 1.4e-3 there, and link = -3 ripple = -0.0042 mm
  DiffOptions below, above;
  REQUIRE(add_tolerance(below.tolerance, "link=0.50419mm").has_value());
  REQUIRE(add_tolerance(above.tolerance, "link=504.21um").has_value());
  CHECK(compare(two.a, two.b, below).differ());
  CHECK(!compare(two.a, two.b, above).differ());
}

TEST_CASE("a pulse one base tick later is found, with its number and axis") {
  const Two two([](ChangeableTick& tick) {
    if (tick.number == 450) ++tick.batch.axis[2].offset_ticks[3];
  });
  const LogDiff diff = compare(two.a, two.b);
  REQUIRE(diff.first);
  CHECK(diff.first->tick.control_tick == 450);
  REQUIRE(diff.first->tick.fields.size() == 1);
  const FieldDifference& f = diff.first->tick.fields[0];
  CHECK(f.channel == DiffChannel::steps);
  CHECK(f.name() == "Z pulse 4 offset_ticks");
  CHECK(f.difference == 1.0);
  CHECK(f.tick.value == 450 * 10'000 + std::stoll(f.a));
  CHECK(!compare(two.a, two.b, ignoring({"KADR_STEPS/offset_ticks"})).differ());
}

TEST_CASE("a pulse with the other direction, and one that is missing, are found") {
  const Two turned([](ChangeableTick& tick) {
    if (tick.number == 450)
      tick.batch.axis[0].first_sign = static_cast<std::int8_t>(-tick.batch.axis[0].first_sign);
  });
  LogDiff diff = compare(turned.a, turned.b);
  REQUIRE(diff.first);
  CHECK(diff.first->tick.control_tick == 450);
  CHECK(diff.first->tick.fields[0].name() == "X pulse 1 sign");

  const Two missing([](ChangeableTick& tick) {
    if (tick.number == 450) tick.batch.axis[0].offset_ticks.pop_back();
  });
  diff = compare(missing.a, missing.b);
  REQUIRE(diff.first);
  CHECK(diff.first->tick.fields[0].name() == "X pulses");
  CHECK(diff.first->tick.fields[0].difference == -1.0);
}

TEST_CASE("at one tick events come before feed, feed before pulses, pulses before the plant") {
  const Two two([](ChangeableTick& tick) {
    if (tick.number != 499) return;
    tick.events[0].value = 2;
    tick.motion.override_used = 0.5;
    ++tick.batch.axis[0].offset_ticks[0];
    tick.states[0].motor_force_N += 1;
  });
  const LogDiff diff = compare(two.a, two.b);
  REQUIRE(diff.first);
  std::vector<std::string> names;
  for (const FieldDifference& f : diff.first->tick.fields) names.push_back(f.name());
  CHECK(names == std::vector<std::string>{"value", "override_used", "override_requested",
                                          "X pulse 1 offset_ticks", "X motor_force"});
  CHECK(diff.first->tick.fields[4].unit == "N");
}

TEST_CASE("an event that one log lacks is told, and the input before a difference is named") {
  const Two two([](ChangeableTick& tick) {
    if (tick.number == 499) tick.events.clear();
  });
  const LogDiff diff = compare(two.a, two.b);
  REQUIRE(diff.first);
  CHECK(diff.first->tick.control_tick == 499);
  CHECK(diff.first->tick.fields[0].a == "input: digital input 3 = 1");
  CHECK(diff.first->tick.fields[0].b == "-");
  CHECK(diff.first->input == "base tick 2 490 009 (0.249001 s): digital input 3 = 1");
  CHECK(!compare(two.a, two.b, ignoring({"KADR_EVENT"})).differ());

  const Two renamed([](ChangeableTick& tick) {
    for (auto& event : tick.events) event.text += " again";
  });
  CHECK(compare(renamed.a, renamed.b).differ());
  CHECK(!compare(renamed.a, renamed.b, ignoring({"KADR_EVENT/text"})).differ());
}

TEST_CASE("the residual vibration of a stop has the tolerance of the link") {
  const auto residual = [](double value_u) {
    return [value_u](ChangeableTick& tick) {
      if (tick.number == 300)
        tick.events.push_back({Ticks{tick.number * 10'000},
                               3,
                               {0, 0, 0, 0},
                               EventKind::residual,
                               Code{},
                               1,
                               value_u,
                               0,
                               "residual vibration " + std::to_string(value_u)});
    };
  };
  const TestFolder folder;
  const machine::MachineModel machine = log_machine(3);
  write_changed(folder / "a", log_header(machine), kTicks, residual(0.002));
  write_changed(folder / "b", log_header(machine), kTicks, residual(0.0023));
  const auto differ = [&](const DiffOptions& options) {
    return compare(folder / "a", folder / "b", options).differ();
  };
  CHECK(differ({}));
  CHECK(!differ(ignoring({"load"})));
  DiffOptions narrow, wide;
  REQUIRE(add_tolerance(narrow.tolerance, "link=0.2um").has_value());
  REQUIRE(add_tolerance(wide.tolerance, "load=0.4um").has_value());
  CHECK(differ(narrow));
  CHECK(!differ(wide));
}

TEST_CASE("a longer log differs from a shorter one, which is compared as far as it goes") {
  const Two two({}, kTicks + 55);
  const LogDiff diff = compare(two.a, two.b);
  CHECK(diff.differ());
  CHECK(!diff.first);
  CHECK(diff.both == kTicks);
  CHECK(diff.b.control_ticks == kTicks + 55);
  const std::string text = render_log_diff(diff);
  CHECK(text.find("has 55 control ticks more than") != std::string::npos);
}

TEST_CASE("of a log that was cut off, what is valid is compared, and that it was cut off is told") {
  const Two two([](ChangeableTick& tick) {
    if (tick.number == 600) tick.motion.speed_end_u_s += 1;
  });
  const auto bytes = test::read_bytes(two.a);
  const std::string cut = two.folder / "cut.lcmlog";
  test::write_bytes(cut, {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2)});
  const LogDiff diff = compare(cut, two.b);
  CHECK(diff.differ());
  CHECK(!diff.first);
  CHECK(diff.a.end.state == LogState::cut_off);
  CHECK(diff.both == diff.a.control_ticks);
  CHECK(diff.both > 200);
  CHECK(diff.both % 32 == 0);
  CHECK(render_log_diff(diff).find("cut off") != std::string::npos);
}

TEST_CASE("how a log is cut into messages makes no difference") {
  const TestFolder folder;
  machine::MachineModel machine = log_machine(2);
  write_changed(folder / "a", log_header(machine), kTicks);
  machine.log.block_ticks = 7;
  machine.log.viewer_rate_hz = 0;
  write_changed(folder / "b", log_header(machine), kTicks);
  CHECK(!compare(folder / "a", folder / "b").differ());
}

TEST_CASE("what one log does not hold is not compared, and said") {
  const TestFolder folder;
  machine::MachineModel machine = log_machine(2);
  write_changed(folder / "a", log_header(machine), kTicks);
  for (const bool ticks : {true, false}) {
    machine.log.ticks = ticks;
    machine.log.steps = !ticks;
    write_changed(folder / "b", log_header(machine), kTicks);
    const LogDiff diff = compare(folder / "a", folder / "b");
    CHECK(!diff.differ());
    CHECK(diff.inputs.back().name == "channels");
    CHECK(!diff.inputs.back().same);
  }
  machine.log.ticks = machine.log.steps = false;
  write_changed(folder / "b", log_header(machine), kTicks);
  CHECK(!compare(folder / "a", folder / "b").differ());
  write_changed(folder / "c", log_header(machine), kTicks, [](ChangeableTick& tick) {
    if (tick.number == 249) tick.events[0].value = 7;
  });
  CHECK(compare(folder / "a", folder / "c").differ());
  CHECK(compare(folder / "b", folder / "c").differ());
}

TEST_CASE("inputs are compared first: what differs in program, settings, clock and axes is named") {
  const TestFolder folder;
  machine::MachineModel machine = log_machine(2), other = log_machine(3);
  other.clock.base_hz = 20'000'000;
  RunHeader a = log_header(machine), b = log_header(other);
  a.settings_toml = "[feed]\nmax_mm_s = 60\n[[axis]]\n  name = \"X\"\n  [axis.plant]\n  link_mass_kg = 8\n";
  b.settings_toml = "[feed]\nmax_mm_s = 60\n[[axis]]\n  name = \"X\"\n  [axis.plant]\n  link_mass_kg = 9\n";
  b.program_text = "N10 G1 X10 F100 (скругление)\nM30\n";
  b.scenario_toml = "format = 1\n";
  write_changed(folder / "a", a, 50);
  write_changed(folder / "b", b, 50);
  const LogDiff diff = compare(folder / "a", folder / "b");
  CHECK(diff.differ());
  CHECK(!diff.compared);
  CHECK(diff.inputs_differ());
  const auto detail = [&](const std::string& name) {
    for (const InputDifference& input : diff.inputs)
      if (input.name == name) return input.detail;
    return std::string("no such input");
  };
  CHECK(detail("program") == "line 2: 'M2' | 'M30'");
  CHECK(detail("settings") == "[axis.plant] of \"X\" 'link_mass_kg = 8' | 'link_mass_kg = 9'");
  CHECK(detail("scenario") == "none | there");
  CHECK(detail("machine").empty());
  CHECK(detail("clock") == "10 000 000 Hz, control tick 10 000 | 20 000 000 Hz, control tick 10 000");
  CHECK(detail("axes") == "X 0.001 mm, Y 0.001 mm | X 0.001 mm, Y 0.001 mm, Z 0.001 mm");
}

TEST_CASE("a file that is no log of kadr is refused with its path and a reason") {
  const TestFolder folder;
  const machine::MachineModel machine = log_machine(1);
  const std::string good = folder / "a";
  write_changed(good, log_header(machine), 50);
  test::write_bytes(folder / "empty", {});
  test::write_bytes(folder / "text", {'h', 'e', 'l', 'l', 'o'});
  for (const std::string& bad : {folder / "missing", folder / "empty", folder / "text", folder.path()}) {
    const auto second = diff_logs(good, bad, {});
    REQUIRE(!second.has_value());
    CHECK(second.error().path == bad);
    CHECK(!second.error().reason.empty());
    CHECK(!diff_logs(bad, good, {}).has_value());
  }
}

TEST_CASE("logs with damaged bytes are compared without a crash") {
  const Two two({});
  const auto bytes = test::read_bytes(two.a);
  const std::string damaged = two.folder / "damaged.lcmlog";
  Random random(from_environment("KADR_SEED", 3));
  for (std::uint64_t n = from_environment("KADR_COUNT", 40); n-- > 0;) {
    auto copy = bytes;
    for (int change = 0; change < 3; ++change)
      copy[static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(copy.size()) - 1))] =
          static_cast<std::uint8_t>(random.between(0, 255));
    test::write_bytes(damaged, copy);
    for (const auto& [a, b] : {std::pair{two.a, damaged}, std::pair{damaged, two.a}}) {
      if (const auto diff = diff_logs(a, b, {})) CHECK(!render_log_diff(*diff).empty());
      if (const auto diff = diff_paths(a, b, {})) CHECK(!render_path_diff(*diff).empty());
    }
  }
}

TEST_CASE("tolerances and names to ignore are read with their units, and mistakes are told") {
  Tolerances t;
  CHECK(add_tolerance(t, "load=0.5um").has_value());
  CHECK(t.of(ToleranceKey::base, false) == doctest::Approx(0.0005));
  CHECK(t.of(ToleranceKey::link, false) == doctest::Approx(0.0005));
  CHECK(!t.of(ToleranceKey::link, true));
  CHECK(add_tolerance(t, "link=20 mdeg").has_value());
  CHECK(t.of(ToleranceKey::link, true) == doctest::Approx(0.02));
  CHECK(add_tolerance(t, "force=1e-2Nm").has_value());
  CHECK(t.of(ToleranceKey::force, true) == doctest::Approx(0.01));
  CHECK(add_tolerance(t, "feed=6mm/min").has_value());
  CHECK(t.of(ToleranceKey::feed, false) == doctest::Approx(0.1));
  for (const char* wrong : {"", "load", "load=", "load=um", "load=1", "load=-1um", "load=1N", "loads=1um",
                            "force=1mm", "link_rate=1mm", "load=1,5um", "load=nanum"}) {
    CAPTURE(wrong);
    CHECK(!add_tolerance(t, wrong).has_value());
  }
  CHECK(add_tolerance(t, "load=3").error() ==
        "load takes a number >= 0 with a unit (nm, um, mm, mdeg, deg); got '3'");
  DiffOptions options;
  CHECK(!add_ignored(options, "").has_value());
  CHECK(!add_ignored(options, "KADR_TICK").has_value());
  CHECK(!add_ignored(options, "feed_u_s").has_value());
  CHECK(add_ignored(options, "KADR_STEPS/offset").error() ==
        "there is no field 'offset' in KADR_STEPS; it has pulses, offset_ticks, sign");
}
