#include "emulator/cycle/session.h"

#include <doctest/doctest.h>

#include "tests/support/operator_step.h"
#include "tests/support/run_program.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {

// two corners, a dwell and an output; 2 s
constexpr const char* kProgram =
    "G21 G90 G94 G64\nM3 S500\nG1 X20 F6000\nG1 Y20\nG4 P0.1\nM62 P1\nG2 X40 I10 J0\nM2\n";

/// The program, prepared, under a timeline.
struct Prepared {
  RunResult r;
  explicit Prepared(const std::vector<OperatorStep>& steps = {}, std::optional<double> most_override = {}) {
    r.in = make_inputs(kProgram, test_machine(2));
    r.in.given.operator_steps = steps;
    r.in.given.most_override = most_override;
    prepare_run(r);
  }
  const Job& job() const { return *r.job; }
};

void begin(RecordingLog& log, const Job& job) {
  RunHeader header;
  header.machine = &job.given.machine.model;
  REQUIRE(log.begin(header).has_value());
}

/// Advances until the run ends; returns its summary.
RunSummary to_end(Session& session, ControlTicks portion) {
  while (!session.ended()) REQUIRE(session.advance(portion).has_value());
  auto summary = session.finish();
  REQUIRE(summary.has_value());
  return *summary;
}

void check_same(const RecordingLog& a, const RecordingLog& b) {
  CHECK(a.summary.outcome.text() == b.summary.outcome.text());
  CHECK(a.summary.steps_hash == b.summary.steps_hash);
  CHECK(a.summary.control_ticks == b.summary.control_ticks);
  CHECK(a.summary.path_u == b.summary.path_u);
  CHECK(a.order == b.order);
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    CHECK(a.events[i].text == b.events[i].text);
    CHECK(a.events[i].tick == b.events[i].tick);
    CHECK(a.events[i].value == b.events[i].value);
    CHECK(a.events[i].block == b.events[i].block);
  }
  REQUIRE(a.blocks.size() == b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    CHECK(a.blocks[i].tick == b.blocks[i].tick);
    CHECK(a.blocks[i].entry_u_s == b.blocks[i].entry_u_s);
    CHECK(a.blocks[i].deferred_ticks == b.blocks[i].deferred_ticks);
  }
  CHECK(a.block_ends.size() == b.block_ends.size());
  REQUIRE(a.ticks.size() == b.ticks.size());
  bool same = true;
  for (std::size_t i = 0; i < a.ticks.size(); ++i)
    same = same && a.ticks[i].motion.s_end_u == b.ticks[i].motion.s_end_u &&
           a.ticks[i].steps == b.ticks[i].steps && a.ticks[i].axis.size() == b.ticks[i].axis.size() &&
           (a.ticks[i].axis.empty() || a.ticks[i].axis[0].link_u == b.ticks[i].axis[0].link_u);
  CHECK(same);
}

}  // namespace

TEST_CASE("a session advanced by 1, by 7 or by all its control ticks at once gives the records of run()") {
  const Prepared prepared;
  const Job& job = prepared.job();
  RecordingLog whole;
  begin(whole, job);
  REQUIRE(run(job, &whole, {}).has_value());
  REQUIRE(whole.ticks.size() > 500);
  for (const std::int64_t portion : {1, 7, 1'000'000}) {
    CAPTURE(portion);
    RecordingLog log;
    begin(log, job);
    Session session(job, &log);
    to_end(session, ControlTicks{portion});
    check_same(whole, log);
  }
}

TEST_CASE("advance() makes fewer control ticks than asked for where the run ends, and none after it") {
  const Prepared prepared;
  const Job& job = prepared.job();
  Session session(job, nullptr);
  CHECK(*session.advance(ControlTicks{0}) == ControlTicks{0});
  CHECK(*session.advance(ControlTicks{100}) == ControlTicks{100});
  CHECK(session.ticks() == ControlTicks{100});
  const ControlTicks rest = *session.advance(ControlTicks{1'000'000});
  CHECK(session.ended());
  CHECK(*session.advance(ControlTicks{1}) == ControlTicks{0});
  const auto summary = session.finish();
  CHECK(summary->outcome == Outcome::complete);
  CHECK(summary->control_ticks == rest + ControlTicks{100});
}

TEST_CASE("a session shows motion, pulses and plant of its last control tick") {
  const Prepared prepared;
  const Job& job = prepared.job();
  RecordingLog log;
  begin(log, job);
  Session session(job, &log);
  for (int i = 0; i < 150; ++i) {
    REQUIRE(session.advance(ControlTicks{1}).has_value());
    const RecordingLog::Tick& last = log.ticks.back();
    CHECK(session.motion().s_end_u == last.motion.s_end_u);
    CHECK(session.batch().axis[0].offset_ticks == last.batch.axis[0].offset_ticks);
    REQUIRE(session.plant());
    CHECK(session.plant()->at(0).link_u == last.axis[0].link_u);
  }
  CHECK(session.line() == 3);
  SessionOptions bare;
  bare.plant = false;
  CHECK(Session(job, nullptr, bare).plant() == nullptr);
}

TEST_CASE("a live operator's steps give the run of a timeline with the same steps") {
  const std::vector<OperatorStep> steps = {operator_step(40, OperatorAction::feed_override, 1.3),
                                           operator_step(120, OperatorAction::feed_override, 0.6),
                                           operator_step(200, OperatorAction::hold),
                                           operator_step(400, OperatorAction::resume),
                                           operator_step(400, OperatorAction::rapid_override, 0.5),
                                           operator_step(500, OperatorAction::spindle_load, 1.3)};
  const Prepared with_steps(steps);
  const Job& timeline = with_steps.job();
  RecordingLog planned;
  begin(planned, timeline);
  REQUIRE(run(timeline, &planned, {}).has_value());

  const Prepared prepared({}, 1.3);
  const Job& job = prepared.job();
  RecordingLog live;
  begin(live, job);
  SessionOptions options;
  options.live_operator = true;
  Session session(job, &live, options);
  for (const OperatorStep& step : steps) {
    REQUIRE(session.advance(step.tick - session.ticks()).has_value());
    CHECK(session.operate(step));
  }
  to_end(session, ControlTicks{16});
  check_same(planned, live);
  CHECK(live.summary.lost_by.size() == planned.summary.lost_by.size());
  // and it is another run than one that nobody operates
  RecordingLog alone;
  begin(alone, job);
  REQUIRE(run(job, &alone, {}).has_value());
  CHECK(alone.summary.steps_hash != live.summary.steps_hash);
}

TEST_CASE("a live run that nobody touched is that of an empty timeline with the same highest override") {
  const Prepared prepared({}, 2.0);
  RecordingLog live, empty;
  begin(live, prepared.job());
  begin(empty, prepared.job());
  SessionOptions options;
  options.live_operator = true;
  Session session(prepared.job(), &live, options);
  to_end(session, ControlTicks{100});
  REQUIRE(run(prepared.job(), &empty, {}).has_value());
  check_same(empty, live);
  CHECK(empty.summary.lost_by.size() == live.summary.lost_by.size());
}

TEST_CASE("an override above the highest prepared for and an operator of a session without one are refused") {
  const Prepared prepared({}, 1.2);
  const Job& job = prepared.job();
  Session closed(job, nullptr);
  CHECK_FALSE(closed.operate(operator_step(0, OperatorAction::hold)));
  SessionOptions options;
  options.live_operator = true;
  RecordingLog log;
  begin(log, job);
  Session session(job, &log, options);
  CHECK_FALSE(session.operate(operator_step(0, OperatorAction::feed_override, 1.21)));
  CHECK(session.operate(operator_step(0, OperatorAction::feed_override, 1.2)));
  CHECK(session.advance(ControlTicks{1}).has_value());
  REQUIRE(!log.events.empty());
  CHECK(log.of_kind("override").size() == 1);
}

TEST_CASE(
    "a live hold lasts until the operator ends it; an emergency stop ends the run; an unfinished run says "
    "how") {
  const Prepared prepared;
  const Job& job = prepared.job();
  SessionOptions options;
  options.plant = false;
  options.live_operator = true;
  Session session(job, nullptr, options);
  REQUIRE(session.advance(ControlTicks{100}).has_value());
  CHECK(session.operate(operator_step(0, OperatorAction::hold)));
  REQUIRE(session.advance(ControlTicks{5000}).has_value());
  CHECK_FALSE(session.ended());
  CHECK(session.motion().speed_end_u_s == 0);
  CHECK(session.operate(operator_step(0, OperatorAction::resume)));
  REQUIRE(session.advance(ControlTicks{50}).has_value());
  CHECK(session.operate(operator_step(0, OperatorAction::emergency_stop)));
  const RunSummary stopped = to_end(session, ControlTicks{10});
  CHECK(stopped.outcome == Outcome::emergency_stop);
  CHECK(stopped.alarms == 1);

  Session cut(job, nullptr, options);
  REQUIRE(cut.advance(ControlTicks{10}).has_value());
  CHECK(cut.finish()->outcome == Outcome::interrupted);
  Session until(job, nullptr, options);
  CHECK(until.finish(Outcome::stopped_by_until)->outcome == Outcome::stopped_by_until);
}

TEST_CASE(
    "a step that sets an input is an event at the beginning of its control tick, in the block under way") {
  RunResult r;
  r.in = make_inputs("G21 G90 G94\nG1 X20 F6000\nG1 X21\nM2\n", test_machine(1));
  r.in.given.inputs = {{ControlTicks{0}, false, 3, 1, {}}, {ControlTicks{270}, true, 1, 2.5, {}}};
  prepare_run(r);
  run_prepared(r);
  const auto inputs = r.log.of_kind("input");
  REQUIRE(inputs.size() == 2);
  CHECK(inputs[0].tick == Ticks{0});
  CHECK(inputs[0].text == "digital input 3 = 1");
  CHECK(inputs[0].block == 0);
  CHECK(inputs[1].tick == Ticks{2'700'000});
  CHECK(inputs[1].text == "analog input 1 = 2.5");
  CHECK(inputs[1].block == 1);
}
