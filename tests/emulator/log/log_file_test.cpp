#include <doctest/doctest.h>

#include <filesystem>
#include <kadr/axis_t.hpp>
#include <kadr/block_end_t.hpp>
#include <kadr/block_t.hpp>
#include <kadr/diag_t.hpp>
#include <kadr/event_t.hpp>
#include <kadr/feed_t.hpp>
#include <kadr/run_t.hpp>
#include <kadr/steps_t.hpp>
#include <kadr/summary_t.hpp>
#include <kadr/ticks_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "emulator/log/log.h"
#include "emulator/log/log_info.h"
#include "log_support.h"
#include "machine/machine.h"
#include "machine/step_hash.h"

using namespace kadr;
using namespace kadr::log;
using test::FakeRun;
using test::TestFolder;

namespace {

/// All messages of a log, with the state of its end.
struct ReadLog {
  std::vector<LogMessage> messages;
  std::vector<std::string> channels;
  std::vector<std::int64_t> times_us;
  LogEnd end;
  template <class T>
  std::vector<const T*> all() const {
    std::vector<const T*> list;
    for (const LogMessage& m : messages)
      if (const T* t = std::get_if<T>(&m)) list.push_back(t);
    return list;
  }
};

ReadLog read_log(const std::string& path) {
  auto reader = LogReader::open(path);
  REQUIRE_MESSAGE(reader.has_value(), (reader ? "" : reader.error().reason));
  ReadLog log;
  for (LogMessage m; reader->next(m);) {
    log.channels.emplace_back(reader->event().channel);
    log.times_us.push_back(reader->event().time_us);
    log.messages.push_back(std::move(m));
  }
  log.end = reader->end();
  return log;
}

/// Decodes with the class that lcm-gen made and encodes again.
template <class T>
bool same_bytes_again(const lcm::LogEvent& event) {
  T message;
  if (message.decode(event.data, 0, event.datalen) != event.datalen) return false;
  std::vector<std::uint8_t> again(static_cast<std::size_t>(message.getEncodedSize()));
  if (message.encode(again.data(), 0, static_cast<int>(again.size())) != event.datalen) return false;
  const auto* bytes = static_cast<const std::uint8_t*>(event.data);
  return std::equal(again.begin(), again.end(), bytes, bytes + event.datalen);
}

}  // namespace

TEST_CASE("every control tick comes back from a log bit by bit: 1000 ticks, 3 axes with plant") {
  const TestFolder folder;
  const auto machine = test::log_machine(3);
  test::write_log(folder / "a.lcmlog", machine, 1000);
  const ReadLog log = read_log(folder / "a.lcmlog");
  CHECK(log.end.state == LogState::complete);
  CHECK(log.end.valid_until.value == 10'000'000);

  FakeRun run(machine);
  std::int64_t tick = 0;
  bool same = true;
  for (const TickBlock* b : log.all<TickBlock>()) {
    same = same && b->first.value == tick && b->begin.value == tick * 10'000 && b->has_plant;
    for (std::size_t i = 0; i < b->size(); ++i, ++tick) {
      const TickRecord& r = run.advance();
      same = same && b->feed_u_s[i] == r.motion->speed_end_u_s &&
             b->accel_u_s2[i] == r.motion->accel_end_u_s2 && b->path_u[i] == r.motion->s_end_u &&
             b->override_used[i] == r.motion->override_used &&
             b->override_requested[i] ==
                 (r.has_override ? r.motion->override_requested : r.motion->override_used) &&
             b->limiter[i] == (r.has_override ? r.motion->limiter : 1.0) &&
             b->override_note[i] == (r.has_override ? static_cast<int>(r.motion->note) : 0) &&
             b->limited_by[i] == static_cast<int>(r.motion->limited_by) &&
             b->limiting_axis[i] == r.motion->limiting_axis && b->block[i] == r.block;
      for (std::size_t a = 0; a < 3; ++a) {
        const AxisTicks& x = b->axis[a];
        const AxisState& s = run.states()[a];
        same = same && x.steps[i] == run.nodes()[a].value &&
               x.command_u[i] == run.batch().axis[a].command.position_end_u && x.base_u[i] == s.base_u &&
               x.base_u_s[i] == s.base_u_s && x.link_u[i] == s.link_u && x.link_u_s[i] == s.link_u_s &&
               x.motor_force_N[i] == s.motor_force_N;
      }
      REQUIRE(same);
    }
  }
  CHECK(tick == 1000);
}

TEST_CASE("every pulse comes back from a log: offsets, directions, hash and count") {
  const TestFolder folder;
  const auto machine = test::log_machine(4);
  const std::int64_t pulses = test::write_log(folder / "a.lcmlog", machine, 2500);
  const ReadLog log = read_log(folder / "a.lcmlog");
  FakeRun run(machine);
  StepHash written, read;
  std::int64_t tick = 0, count = 0;
  for (const StepBlock* b : log.all<StepBlock>())
    for (const StepBatch& batch : b->batches) {
      run.advance();
      written.add(run.batch());
      read.add(batch);
      REQUIRE(batch.tick.value == tick++);
      for (std::size_t a = 0; a < 4; ++a) {
        REQUIRE(batch.axis[a].offset_ticks == run.batch().axis[a].offset_ticks);
        REQUIRE(batch.axis[a].net_steps() == run.batch().axis[a].net_steps());
        count += static_cast<std::int64_t>(batch.axis[a].count());
      }
    }
  CHECK(tick == 2500);
  CHECK(count == pulses);
  CHECK(pulses > 200'000);
  CHECK(read.digest() == written.digest());
}

TEST_CASE("header, blocks, events, diagnostics and summary come back from a log") {
  const TestFolder folder;
  const auto machine = test::log_machine(4);
  test::write_log(folder / "a.lcmlog", machine, 500);
  const ReadLog log = read_log(folder / "a.lcmlog");

  const LogHeader& h = *log.all<LogHeader>().at(0);
  CHECK(h.program_text == "N10 G1 X10 F100 (скругление)\nM2\n");
  CHECK(h.program_bytes == static_cast<std::int64_t>(h.program_text.size()));
  CHECK(h.inputs_hash == 0xfedcba9876543210u);
  CHECK(h.base_hz == 10'000'000);
  CHECK(h.control_tick_ticks == 10'000);
  CHECK(h.viewer_every_ticks == 10);
  REQUIRE(h.axis.size() == 4);
  CHECK(h.axis[3].name == "A");
  CHECK(h.axis[3].unit == "deg");
  CHECK(h.axis[3].home_u == 0.75);
  CHECK(h.axis[0].step_u == 0.001);

  const auto blocks = log.all<BlockRecord>();
  REQUIRE(blocks.size() == 5);
  CHECK(blocks[3]->tick.value == 3'000'007);
  CHECK(blocks[3]->span.line == 4);
  CHECK(blocks[3]->text == "N10 G1 X10 F100");
  CHECK(blocks[3]->planned_s == 0.105);
  CHECK(blocks[3]->limited_by == "axis X speed");
  const auto ends = log.all<BlockEndRecord>();
  REQUIRE(ends.size() == 4);
  CHECK(ends[2]->line == 3);
  CHECK(ends[2]->peak_link_u == std::vector<double>(4, 0.003));
  CHECK(ends[2]->positive_J == std::vector<double>(4, 0.25));
  CHECK(ends[2]->recuperated_J == std::vector<double>(4, 0.25));

  const auto events = log.all<EventRecord>();
  REQUIRE(events.size() == 2);
  CHECK(events[1]->tick.value == 4'990'009);
  CHECK(events[1]->code == all_codes().back().code);
  CHECK(events[1]->value == 2.5);
  CHECK(events[1]->text == "axis Y is too fast: 2.5 mm/s, allowed 2.0 mm/s");

  const auto diagnostics = log.all<LogDiagnostic>();
  REQUIRE(diagnostics.size() == 1);
  CHECK(diagnostics[0]->tick.value == -1);
  CHECK(diagnostics[0]->severity == Severity::warning);
  CHECK(diagnostics[0]->span.column == 17);
  CHECK(diagnostics[0]->notes == std::vector<std::string>{"one", "two"});

  const RunSummary& s = log.all<LogSummary>().at(0)->run;
  test::Totals totals(machine);
  FakeRun run(machine);
  for (int k = 0; k < 500; ++k) {
    run.advance();
    totals.add(run.batch());
  }
  for (const BlockRecord* b : blocks) totals.add(*b);
  for (const EventRecord* e : events) totals.add(*e);
  const RunSummary expected = test::log_summary(machine, 500, totals);
  CHECK(s.pulses == expected.pulses);
  CHECK(s.steps_hash == expected.steps_hash);
  CHECK(s.ticks.value == 5'000'000);
  CHECK(s.path_error_u == expected.path_error_u);
  CHECK(s.dwell_s == 0.5);
  CHECK(s.alarms == 2);
  CHECK(s.exit_code == 3);
  REQUIRE(s.axis.size() == 4);
  for (std::size_t a = 0; a < 4; ++a) {
    const AxisSummary &x = s.axis[a], &y = expected.axis[a];
    CHECK(x.pulses == y.pulses);
    CHECK(x.net_steps == y.net_steps);
    CHECK(x.end_steps == y.end_steps);
    CHECK(x.end_u == y.end_u);
    CHECK(x.min_u == y.min_u);
    CHECK(x.max_u == y.max_u);
    CHECK(x.peak_feed_u_s == y.peak_feed_u_s);
    CHECK(x.peak_feed_tick.value == y.peak_feed_tick.value);
    CHECK(x.peak_accel_u_s2 == y.peak_accel_u_s2);
    CHECK(x.peak_jerk_u_s3 == y.peak_jerk_u_s3);
    CHECK(x.peak_vibration_u == y.peak_vibration_u);
    CHECK(x.peak_vibration_tick.value == y.peak_vibration_tick.value);
    CHECK(x.peak_vibration_line == y.peak_vibration_line);
    CHECK(x.rms_vibration_u == y.rms_vibration_u);
    CHECK(x.residual_u == y.residual_u);
    CHECK(x.peak_following_u == y.peak_following_u);
    CHECK(x.rms_following_u == y.rms_following_u);
    CHECK(x.lost_steps == y.lost_steps);
  }
  REQUIRE(s.limited_by.size() == 2);
  CHECK(s.limited_by[1].limited_by == "axis X speed");
  CHECK(s.limited_by[1].time_s == 14.75);
  CHECK(s.planned_s == 38.25);
  REQUIRE(s.lost_by.size() == 2);
  CHECK(s.lost_by[1].limited_by == "override");
  CHECK(s.lost_by[1].time_s == -0.125);
}

TEST_CASE("viewer messages carry the numbers of their control tick, ten to a hundred ticks") {
  const TestFolder folder;
  const auto machine = test::log_machine(3);
  test::write_log(folder / "a.lcmlog", machine, 1000);
  const ReadLog log = read_log(folder / "a.lcmlog");
  const auto feeds = log.all<FeedSample>();
  const auto axes = log.all<AxisSample>();
  REQUIRE(feeds.size() == 100);
  REQUIRE(axes.size() == 300);
  FakeRun run(machine);
  double accel_before = 0, accel = 0;
  for (std::int64_t k = 0; k < 1000; ++k) {
    const TickRecord& r = run.advance();
    accel_before = accel;
    accel = r.motion->accel_end_u_s2;
    if (k % 10 != 9) continue;
    const FeedSample& f = *feeds[static_cast<std::size_t>(k / 10)];
    REQUIRE(f.tick.value == (k + 1) * 10'000);
    REQUIRE(f.t_s == static_cast<double>(f.tick.value) / 1e7);
    REQUIRE(f.commanded_u_s == r.motion->speed_end_u_s);
    REQUIRE(f.override_used_pct == 100 * r.motion->override_used);
    REQUIRE(f.jerk_u_s3 == (accel - accel_before) / 0.001);
    REQUIRE(f.phase == (r.motion->speed_end_u_s > r.motion->speed_begin_u_s   ? 1
                        : r.motion->speed_end_u_s < r.motion->speed_begin_u_s ? 3
                        : r.motion->speed_end_u_s > 0                         ? 2
                                                                              : 0));
    const AxisSample& y = *axes[static_cast<std::size_t>(3 * (k / 10) + 1)];
    REQUIRE(y.axis == 1);
    REQUIRE(y.steps == run.nodes()[1].value);
    REQUIRE(y.commanded == static_cast<double>(run.nodes()[1].value) * 0.001);
    REQUIRE(y.load == run.states()[1].base_u + run.states()[1].link_u);
    REQUIRE(y.load_minus_ideal_um == 1000 * (y.load - y.ideal));
    // the node is never further than half a step from the command
    REQUIRE(std::abs(y.commanded - y.ideal) <= 0.0005 + 1e-12);
  }
}

TEST_CASE("liblcm reads every event and lcm-gen's classes decode and encode it to the same bytes") {
  const TestFolder folder;
  test::write_log(folder / "a.lcmlog", test::log_machine(3), 700);
  lcm::LogFile file(folder / "a.lcmlog", "r");
  REQUIRE(file.good());
  std::map<std::string, int> seen;
  std::int64_t number = 0, time_us = 0;
  while (const lcm::LogEvent* e = file.readNextEvent()) {
    REQUIRE(e->eventnum == number++);
    REQUIRE(e->timestamp >= time_us);  // simulated time never runs back
    time_us = e->timestamp;
    ++seen[e->channel];
    const std::string& c = e->channel;
    const bool same = c == "KADR_RUN"         ? same_bytes_again<run_t>(*e)
                      : c == "KADR_BLOCK"     ? same_bytes_again<block_t>(*e)
                      : c == "KADR_BLOCK_END" ? same_bytes_again<block_end_t>(*e)
                      : c == "KADR_TICKS"     ? same_bytes_again<ticks_t>(*e)
                      : c == "KADR_STEPS"     ? same_bytes_again<steps_t>(*e)
                      : c == "KADR_FEED"      ? same_bytes_again<feed_t>(*e)
                      : c == "KADR_EVENT"     ? same_bytes_again<event_t>(*e)
                      : c == "KADR_DIAG"      ? same_bytes_again<diag_t>(*e)
                      : c == "KADR_SUMMARY"   ? same_bytes_again<summary_t>(*e)
                                              : same_bytes_again<axis_t>(*e);
    CAPTURE(c);
    REQUIRE(same);
  }
  CHECK(time_us == 700'000);  // 700 control ticks of 1 ms
  // 700 = 21 blocks of 32 and one of 28; viewers every 10
  const std::map<std::string, int> expected{{"KADR_RUN", 1},       {"KADR_DIAG", 1},    {"KADR_BLOCK", 7},
                                            {"KADR_BLOCK_END", 6}, {"KADR_TICKS", 22},  {"KADR_STEPS", 22},
                                            {"KADR_FEED", 70},     {"KADR_AXIS_X", 70}, {"KADR_AXIS_Y", 70},
                                            {"KADR_AXIS_Z", 70},   {"KADR_EVENT", 2},   {"KADR_SUMMARY", 1}};
  CHECK(seen == expected);
}

TEST_CASE("the same run gives the same bytes") {
  const TestFolder folder;
  for (const char* name : {"a", "b"}) test::write_log(folder / name, test::log_machine(3), 900);
  CHECK(test::read_bytes(folder / "a") == test::read_bytes(folder / "b"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.part"));
}

TEST_CASE("an interrupted run stays PATH.part and says so") {
  const TestFolder folder;
  test::write_log(folder / "a.lcmlog", test::log_machine(1), 90, {}, Outcome::interrupted);
  CHECK_FALSE(std::filesystem::exists(folder / "a.lcmlog"));
  const ReadLog log = read_log(folder / "a.lcmlog.part");
  CHECK(log.end.state == LogState::interrupted);
  CHECK(log.end.detail == "interrupted at tick 900000 (0.090000 s)");
}

TEST_CASE("a log under way is PATH.part, readable up to the last whole block of ticks") {
  const TestFolder folder;
  const auto machine = test::log_machine(3);
  auto log = open_lcm_log({folder / "a.lcmlog", ""});
  REQUIRE(log);
  REQUIRE((*log)->begin(test::log_header(machine)));
  FakeRun run(machine);
  for (int k = 0; k < 100; ++k) {
    const TickRecord& record = run.advance();
    REQUIRE((*log)->tick(record, run.batch()));
  }
  // 100 = 3 * 32 + 4
  const ReadLog read = read_log(folder / "a.lcmlog.part");
  CHECK(read.end.state == LogState::cut_off);
  CHECK(read.end.valid_until.value == 960'000);
  CHECK(read.end.detail == "cut off: no KADR_SUMMARY; valid up to tick 960000 (0.096000 s)");
}

TEST_CASE("channels can be left out: without exact ticks, without pulses, without viewers, without plant") {
  const TestFolder folder;
  auto machine = test::log_machine(2);
  machine.log.viewer_rate_hz = 0;
  test::write_log(folder / "plain", machine, 320, {.plant = false});
  ReadLog log = read_log(folder / "plain");
  CHECK(log.all<FeedSample>().empty());
  CHECK(log.all<AxisSample>().empty());
  REQUIRE(log.all<TickBlock>().size() == 10);
  CHECK_FALSE(log.all<TickBlock>()[0]->has_plant);
  CHECK(log.all<TickBlock>()[0]->axis[0].base_u.empty());
  CHECK(log.all<TickBlock>()[0]->axis[0].command_u.size() == 32);

  machine.log.ticks = false;
  test::write_log(folder / "steps", machine, 320);
  log = read_log(folder / "steps");
  CHECK(log.all<TickBlock>().empty());
  CHECK(log.all<StepBlock>().size() == 10);
  CHECK(log_info(folder / "steps")->control_ticks == 320);

  machine.log.steps = false;
  machine.log.viewer_rate_hz = 1000;
  test::write_log(folder / "viewers", machine, 320);
  log = read_log(folder / "viewers");
  CHECK(log.all<StepBlock>().empty());
  CHECK(log.all<FeedSample>().size() == 320);
  CHECK_FALSE(log_info(folder / "viewers")->steps_hash.has_value());
}

TEST_CASE("skipped control ticks begin a new block of ticks") {
  const TestFolder folder;
  const auto machine = test::log_machine(1);
  auto log = open_lcm_log({folder / "a", ""});
  REQUIRE(log);
  REQUIRE((*log)->begin(test::log_header(machine)));
  FakeRun run(machine);
  test::Totals totals(machine);
  for (int k = 0; k < 40; ++k) {
    const TickRecord& record = run.advance();
    if (k >= 10 && k <= 15) continue;
    totals.add(run.batch());
    REQUIRE((*log)->tick(record, run.batch()));
  }
  REQUIRE((*log)->end(test::log_summary(machine, 40, totals, run.nodes())));
  const auto blocks = read_log(folder / "a");
  REQUIRE(blocks.all<TickBlock>().size() == 2);
  CHECK(blocks.all<TickBlock>()[0]->size() == 10);
  CHECK(blocks.all<TickBlock>()[1]->first.value == 16);
  CHECK(blocks.all<TickBlock>()[1]->size() == 24);
  CHECK(blocks.all<StepBlock>()[1]->first.value == 16);
}

TEST_CASE("a program above 1 MiB is named by length and hash; zero bytes in a text become U+FFFD") {
  const TestFolder folder;
  const auto machine = test::log_machine(1);
  RunHeader header = test::log_header(machine);
  header.program_text = std::string((1u << 20) + 1, 'G');
  header.settings_toml = std::string("a\0b", 3);
  auto log = open_lcm_log({folder / "a", ""});
  REQUIRE(log);
  REQUIRE((*log)->begin(header));
  REQUIRE((*log)->end(test::log_summary(machine, 0, test::Totals(machine))));
  const ReadLog read = read_log(folder / "a");
  const LogHeader& h = *read.all<LogHeader>().at(0);
  CHECK(h.program_text.empty());
  CHECK(h.program_bytes == (1 << 20) + 1);
  CHECK(h.program_hash != 0);
  CHECK(h.settings_toml ==
        "a\xEF\xBF\xBD"
        "b");
}

TEST_CASE("a log that can't be opened tells path and reason") {
  const auto log = open_lcm_log({"/nowhere/part.lcmlog", ""});
  REQUIRE_FALSE(log.has_value());
  CHECK(log.error().path == "/nowhere/part.lcmlog.part");
  CHECK(log.error().reason == "No such file or directory");
  CHECK(log.error().valid_until.value == 0);
  const auto live = open_lcm_log({"", "carrier-pigeon://coop"});
  REQUIRE_FALSE(live.has_value());
  CHECK(live.error().path == "carrier-pigeon://coop");
  CHECK(live.error().reason.find("LCM provider") != std::string::npos);
}

TEST_CASE("log_info counts channels, bytes, pulses, and recomputes the hashes") {
  const TestFolder folder;
  const std::int64_t pulses = test::write_log(folder / "a.lcmlog", test::log_machine(3), 700);
  const auto info = log_info(folder / "a.lcmlog");
  REQUIRE(info);
  CHECK(info->end.state == LogState::complete);
  CHECK(info->control_ticks == 700);
  CHECK(info->span_s == 0.7);
  CHECK(info->pulses.at(0) + info->pulses.at(1) + info->pulses.at(2) == pulses);
  CHECK(info->steps_hash_agrees() == true);
  CHECK(info->content_hash_agrees() == true);
  CHECK(info->blocks == 7);
  CHECK(info->alarms == 2);
  std::int64_t bytes = 0;
  for (const ChannelInfo& c : info->channels) bytes += c.bytes;
  CHECK(bytes == static_cast<std::int64_t>(std::filesystem::file_size(folder / "a.lcmlog")));
  CHECK(info->channels.front().name == "KADR_RUN");
  CHECK(info->channels.back().name == "KADR_SUMMARY");

  const std::string text = render_log_info(*info);
  CHECK(text.find("a.lcmlog: complete\n") != std::string::npos);
  CHECK(text.find("  clock       10 000 000 Hz, control tick 10 000 base ticks (1 ms)\n") !=
        std::string::npos);
  CHECK(text.find("  span        ticks 0 to 7 000 000, 0.700000 s, 700 control ticks\n") !=
        std::string::npos);
  CHECK(text.find("  inputs hash fedcba9876543210\n") != std::string::npos);
  CHECK(text.find("agrees with the summary") != std::string::npos);
  CHECK(text.find("KADR_AXIS_Z                   70") != std::string::npos);
}
