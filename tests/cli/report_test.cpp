#include <doctest/doctest.h>

#include <string>

#include "emulator/answers/answers_json.h"
#include "emulator/answers/summary.h"
#include "emulator/answers/travel.h"
#include "emulator/log/alarm_list.h"
#include "emulator/text/text.h"
#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/path/path_builder.h"
#include "tests/cli/run_kadr.h"

using namespace kadr;
using namespace kadr::answers;
using namespace kadr::log;
using namespace kadr::text;
using kadr::test::check_golden;

namespace {

/// X modelled, Y not, A a rotary axis.
machine::MachineModel model() {
  machine::MachineModel m;
  m.name = "shop";
  for (const char letter : {'X', 'Y', 'A'}) {
    machine::AxisModel axis;
    axis.letter = letter;
    axis.step_u = letter == 'A' ? 0.01 : 0.0025;
    axis.max_feed_u_s = 110;
    axis.max_accel_u_s2 = 2000;
    axis.max_jerk_u_s3 = letter == 'Y' ? machine::kInfinity : 40000;
    axis.has_plant = letter != 'Y';
    m.axis.push_back(axis);
  }
  m.axis[2].kind = machine::AxisKind::rotary;
  return m;
}

/// 38.412 s at 10 MHz.
RunSummary summary() {
  RunSummary s;
  s.ticks = Ticks{384'120'000};
  s.control_ticks = ControlTicks{38'412};
  s.blocks = 1190;
  s.path_u = 1942.113;
  s.mean_feed_u_s = 50.6;
  s.peak_feed_u_s = 109.98;
  s.motion_s = 36.212;
  s.dwell_s = 2.2;
  s.pulses = 1'224'800;
  s.steps_hash = 0x9f1c07ab5d2e4431;
  s.path_error_u = 0.2314;
  s.axis.resize(3);
  s.axis[0].pulses = 912'800;
  s.axis[0].net_steps = Steps{152'400};
  s.axis[0].end_u = 381;
  s.axis[0].min_u = -0.5;
  s.axis[0].max_u = 381;
  s.axis[0].peak_feed_u_s = 109.98;
  s.axis[0].peak_feed_tick = Ticks{122'040'000};
  s.axis[0].peak_accel_u_s2 = 1998;
  s.axis[0].peak_jerk_u_s3 = 40000;
  s.axis[0].peak_vibration_u = 0.214;
  s.axis[0].peak_vibration_tick = Ticks{122'040'000};
  s.axis[0].peak_vibration_line = 512;
  s.axis[0].rms_vibration_u = 0.0312;
  s.axis[0].residual_u = 0.00031;
  s.axis[0].peak_following_u = 0.0213;
  s.axis[0].rms_following_u = 0.004;
  s.axis[1].pulses = 312'000;
  s.axis[1].net_steps = Steps{-88'010};
  s.axis[1].end_u = -220.025;
  s.axis[1].min_u = -220.025;
  s.axis[1].peak_feed_u_s = 84.1;
  s.axis[1].peak_feed_tick = Ticks{98'700'000};
  s.axis[2].peak_vibration_u = 0;
  s.limited_by = {{"program", 23.4},      {"junction", 7.3}, {"length", 4.6},
                  {"axis X speed", 0.91}, {"dwell", 2.2},    {"centripetal", 0.002}};
  return s;
}

SummaryContext context(const machine::MachineModel& m) {
  SummaryContext c;
  c.program = "part.ngc";
  c.machine = "shop (shop.toml)";
  c.model = &m;
  c.log_path = "part.lcmlog";
  c.log_bytes = 16'234'000;
  return c;
}

}  // namespace

TEST_CASE("numbers for people have a dot, spaces between thousands and no minus zero") {
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(38'412) == "38 412");
  CHECK(grouped(-1'234'567) == "-1 234 567");
  CHECK(grouped(INT64_MIN) == "-9 223 372 036 854 775 808");
  CHECK(grouped_signed(5) == "+5");
  CHECK(grouped_signed(0) == "0");
  CHECK(fixed(1942.1134, 3) == "1 942.113");
  CHECK(fixed(-0.0004, 3) == "0.000");
  CHECK(fixed(-0.0006, 3) == "-0.001");
  CHECK(fixed(1234567, 0) == "1 234 567");
  CHECK(fixed(machine::kInfinity, 3) == "inf");
  CHECK(bytes_text(999) == "999 B");
  CHECK(bytes_text(16'234'000) == "16.2 MB");
  CHECK(bytes_text(999'960) == "1.0 MB");
  CHECK(duration_text(0.0444) == "0.044 s");
  CHECK(duration_text(59.9994) == "59.999 s");
  CHECK(duration_text(59.9996) == "1 min 00.0 s");
  CHECK(duration_text(723.44) == "12 min 03.4 s");
  CHECK(duration_text(3599.96) == "1 h 00 min 00 s");
  CHECK(duration_text(3723) == "1 h 02 min 03 s");
}

TEST_CASE("program text is fit for a terminal: no control characters, cut by cells, Cyrillic counts once") {
  CHECK(one_line("  G1 X1\r", 34) == "G1 X1");
  CHECK(one_line("G1 (скругление)", 15) == "G1 (скругление)");
  CHECK(one_line("G1 (скругление)", 10) == "G1 (скр...");
  CHECK(one_line("a\x1b[31mb", 34) == "a\xEF\xBF\xBD[31mb");
  CHECK(one_line("\xCF\xF0", 34) == "\xEF\xBF\xBD\xEF\xBF\xBD");
  CHECK(display_width(pad_right("скр", 8)) == 8);
  CHECK(pad_left("7", 3) == "  7");
}

TEST_CASE("a table aligns its columns by their widest cell and has no trailing blanks") {
  TextTable table({{"axis", TextTable::Align::left}, {"steps"}, {"note", TextTable::Align::left}});
  table.add({"X", "1 000", ""});
  table.add({"longer", "7", "so"});
  CHECK(table.render() ==
        "axis    steps  note\n"
        "X       1 000\n"
        "longer      7  so\n");
}

TEST_CASE("the summary of a run") {
  const machine::MachineModel m = model();
  check_golden("summary_complete.txt", render_summary(summary(), context(m)));
}

TEST_CASE("the summary of a run with alarms, without plant, by a scenario, with wall time") {
  const machine::MachineModel m = model();
  RunSummary s = summary();
  s.alarms = 3;
  SummaryContext c = context(m);
  c.plant = false;
  c.scenario = "pull_out";
  c.path_unit = "mm+deg";
  c.program_warnings = 1;
  c.log_path.clear();
  c.wall_s = 0.94;
  EventRecord alarm;
  alarm.kind = log::EventKind::alarm;
  alarm.code = Code::soft_limit_overrun;
  alarm.tick = Ticks{12'040'000};
  alarm.span.line = 512;
  alarm.axis = 0;
  alarm.text = "axis X at 381.000 mm, allowed 380.000 mm";
  c.alarms = {alarm, alarm};
  c.alarm_counts = {{Code::soft_limit_overrun, 2}, {Code::lost_steps, 1}};
  check_golden("summary_alarms.txt", render_summary(s, c));
}

TEST_CASE("shares of time add up to 100 % and small ones are gathered") {
  CHECK(render_limits({{"program", 75}, {"junction", 25}}) ==
        "limited by      program 75 %   junction 25 %   (of time)\n");
  CHECK(render_limits({{"program", 1000}, {"rapid", 0.3}, {"length", 0.3}}) ==
        "limited by      program 100 %   other 0.1 %   (of time)\n");
  CHECK(render_limits({}).empty());
}

TEST_CASE("the summary as JSON has units in its keys, null for what there is not, and no wall clock") {
  const machine::MachineModel m = model();
  SummaryContext c = context(m);
  c.wall_s = 0.94;
  const Json j = Json::parse(json_text(json_of(summary(), c)));
  CHECK(j["time_s"] == 38.412);
  CHECK(j["axes"][0]["axis"] == "X");
  CHECK(j["axes"][0]["load"]["peak_vibration_u"] == 0.214);
  CHECK(j["axes"][0]["load"]["peak_vibration_at_s"] == 12.204);
  CHECK(j["axes"][1]["load"].is_null());
  CHECK(j["axes"][1]["max_jerk_u_s3"].is_null());
  CHECK(j["axes"][2]["unit"] == "deg");
  CHECK(j["steps_hash"] == "9f1c07ab5d2e4431");
  CHECK(j["log"]["bytes"] == 16'234'000);
  CHECK(json_text(j).find("wall") == std::string::npos);
}

TEST_CASE("a diagnostic as JSON counts columns in code points") {
  SourceSet sources;
  // the word Q5 begins at byte 8: "(по) " is 7 bytes and 5 code points
  sources.add(SourceText("part.ngc", "(\xD0\xBF\xD0\xBE) Q5\n"));
  Diagnostic d{Code::soft_limit, Severity::error, Span{0, 1, 8, 2}, "message", "label", {"note"}, "help"};
  const Json j = json_of(d, sources);
  CHECK(j["column"] == 6);
  CHECK(j["length"] == 2);
  CHECK(j["code"] == "K4101");
  CHECK(j["calls"].empty());
  CHECK(j["calls_left_out"] == 0);
  CHECK(j["notes"][0] == "note");
  d.span.line = 0;
  CHECK(json_of(d, sources)["file"].is_null());
}

TEST_CASE("alarms are counted beyond those that are kept") {
  AlarmList list(nullptr);
  EventRecord alarm;
  alarm.kind = log::EventKind::alarm;
  alarm.code = Code::lost_steps;
  for (std::size_t i = 0; i < AlarmList::kKept + 7; ++i) CHECK(list.event(alarm).has_value());
  EventRecord other;
  other.kind = log::EventKind::spindle;
  CHECK(list.event(other).has_value());
  CHECK(list.alarms().size() == AlarmList::kKept);
  CHECK(list.counts().at(Code::lost_steps) == AlarmList::kKept + 7);
}

TEST_CASE("travel of a line and of a full circle of radius 10 mm: 40 mm per axis within 1 %") {
  machine::MachineModel m = model();
  planner::PathBuilder builder(m, {});
  gcode::Feed line;
  line.end = {20, 0, 0, 0, 0, 0, 0, 0, 0};
  line.length_u = 20;
  line.feed_u_s = 10;
  builder.add({{}, line});
  gcode::Arc circle{line};
  circle.center_first_mm = 10;
  circle.turns = 1;
  circle.length_u = 20 * 3.14159265358979;
  builder.add({{}, circle});
  const auto travel = axis_travel(builder.path());
  CHECK(travel[0].max_u == doctest::Approx(20));
  CHECK(travel[0].travel_u == doctest::Approx(20 + 40).epsilon(0.01));
  CHECK(travel[1].min_u == doctest::Approx(-10));
  CHECK(travel[1].max_u == doctest::Approx(10));
  CHECK(travel[1].travel_u == doctest::Approx(40).epsilon(0.01));
  CHECK(travel[2].travel_u == 0);
  // (60 + 40) mm of 0.0025 mm steps
  CHECK(static_cast<double>(estimate_pulses(travel, m)) == doctest::Approx(40'000).epsilon(0.01));
  CHECK(path_unit(builder.path(), m) == "mm");
}

TEST_CASE("a move of the rotary axis alone is measured in degrees, with X in mm") {
  machine::MachineModel m = model();
  planner::PathBuilder builder(m, {});
  gcode::Feed turn;
  turn.feed_length = gcode::FeedLength::rotary;
  turn.end = {0, 0, 0, 360, 0, 0, 0, 0, 0};
  turn.length_u = 360;
  turn.feed_u_s = 10;
  builder.add({{}, turn});
  CHECK(path_unit(builder.path(), m) == "deg");
  gcode::Feed both = turn;
  both.feed_length = gcode::FeedLength::xyz;
  both.end = {5, 0, 0, 720, 0, 0, 0, 0, 0};
  both.length_u = 5;
  builder.add({{}, both});
  CHECK(std::string(segment_unit(builder.path(), 1, m)) == "mm");
  CHECK(path_unit(builder.path(), m) == "mm+deg");
}
