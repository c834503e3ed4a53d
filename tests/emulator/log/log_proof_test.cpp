#include <doctest/doctest.h>

#include <functional>

#include "emulator/log/log_info.h"
#include "emulator/log/log_proof.h"
#include "log_events.h"
#include "log_support.h"
#include "machine/machine.h"

/// A log whose hashes fit and whose messages contradict each other is damaged, at the message that does.
using namespace kadr;
using namespace kadr::log;
using test::TestFolder;

namespace {

using Events = std::vector<test::LogEvent>;

class Forge {
 public:
  explicit Forge(bool plant = true) {
    test::write_log(folder_ / "true", test::log_machine(2), 300, {.peak_steps_per_s = 3000, .plant = plant});
    auto reader = LogReader::open(folder_ / "true");
    REQUIRE(reader.has_value());
    header_ = reader->header();
    events = test::events_of(test::read_bytes(folder_ / "true"));
  }
  Events events;

  std::size_t index(const std::string& channel, std::size_t nth = 0) const {
    for (std::size_t i = 0; i < events.size(); ++i)
      if (events[i].channel == channel && nth-- == 0) return i;
    FAIL("no " << channel);
    return 0;
  }
  /// Decodes a message, lets it be changed and encodes it again.
  template <class R>
  void change(std::size_t nth, const std::function<void(R&)>& change) {
    test::LogEvent& e = events[index(std::string(Channel<R>::info.name), nth)];
    auto record = decode<R>(e.data, e.channel, header_);
    REQUIRE(record.has_value());
    // the reader fills these in
    if constexpr (std::same_as<R, TickBlock>)
      if (!record->record.has_override)
        record->record.override_requested.clear(), record->record.limiter.clear(),
            record->record.override_note.clear();
    change(record->record);
    encode(record->record, header_, e.data);
  }
  LogInfo info() {
    Events sealed = events;
    test::seal(sealed);
    test::write_bytes(folder_ / "forged", test::log_of(sealed));
    const auto read = log_info(folder_ / "forged");
    REQUIRE(read.has_value());
    return *read;
  }
  /// What the reader says is wrong, with the channel in which it was found; empty: nothing.
  std::string found() {
    const LogInfo read = info();
    if (read.end.state == LogState::complete) return "";
    CHECK(read.end.state == LogState::damaged);
    CHECK(read.content_hash_agrees().value_or(true));
    const std::string& text = read.end.detail;
    const auto begin = text.find('('), end = text.rfind("; valid up to");
    REQUIRE(begin != std::string::npos);
    REQUIRE(end != std::string::npos);
    const std::string channel = text.substr(begin + 1, text.find(')') - begin - 1);
    return channel + text.substr(text.find(": ", begin), end - text.find(": ", begin));
  }

 private:
  TestFolder folder_;
  LogHeader header_;
};

}  // namespace

TEST_CASE("a log that was taken apart and put together again is the same log, and sound") {
  Forge forge;
  CHECK(forge.found() == "");
  CHECK(forge.info().log_hash_agrees() == true);
}

TEST_CASE("columns of the plant or of the override that come or go make a log damaged") {
  Forge forge;
  forge.change<TickBlock>(2, [](TickBlock& b) {
    b.has_plant = false;
    for (AxisTicks& axis : b.axis)
      axis.base_u = axis.base_u_s = axis.link_u = axis.link_u_s = axis.motor_force_N = {};
  });
  CHECK(forge.found() == "KADR_TICKS: n_plant_axes is 0, in the blocks before it more than 0");
  Forge other;
  other.change<TickBlock>(3, [](TickBlock& b) {
    b.override_requested = b.limiter = b.override_used;
    b.override_note.assign(b.size(), 0);
  });
  CHECK(other.found() == "KADR_TICKS: n_override is 32, in the blocks before it 0");
}

TEST_CASE("exact data in another order make a log damaged") {
  SUBCASE("pulses before their control ticks") {
    Forge forge;
    std::swap(forge.events[forge.index("KADR_TICKS")], forge.events[forge.index("KADR_STEPS")]);
    CHECK(forge.found() == "KADR_STEPS: it has no KADR_TICKS before it");
  }
  SUBCASE("control ticks without pulses") {
    Forge forge;
    forge.events.erase(forge.events.begin() + static_cast<std::ptrdiff_t>(forge.index("KADR_STEPS", 1)));
    CHECK(forge.found().find("KADR_STEPS of the control ticks 32 to 63 is due here") != std::string::npos);
  }
  SUBCASE("blocks that run back") {
    Forge forge;
    std::swap(forge.events[forge.index("KADR_TICKS", 1)].data,
              forge.events[forge.index("KADR_TICKS", 2)].data);
    CHECK(forge.found() == "KADR_TICKS: it is stamped with 64000 us, its tick 960000 is at 96000 us");
  }
  SUBCASE("a block twice") {
    Forge forge;
    const std::size_t at = forge.index("KADR_STEPS", 1);
    const Events twice(forge.events.begin() + static_cast<std::ptrdiff_t>(at) - 1,
                       forge.events.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    forge.events.insert(forge.events.begin() + static_cast<std::ptrdiff_t>(at) + 1, twice.begin(),
                        twice.end());
    CHECK(forge.found() == "KADR_TICKS: it begins with control tick 32, the block before it ends with 63");
  }
  SUBCASE("a block far behind its pulses") {
    Forge forge;
    forge.change<TickBlock>(0, [](TickBlock& b) {
      b.first = ControlTicks{1'000'000'000};
      b.begin = Ticks{10'000'000'000'000};
    });
    CHECK(forge.found() ==
          "KADR_TICKS: it is stamped with 32000 us, its tick 10000000320000 is at 1000000032000 us");
  }
}

TEST_CASE("blocks, viewers, events and stamps that contradict the messages before them make a log damaged") {
  SUBCASE("blocks") {
    Forge forge;
    forge.change<BlockRecord>(1, [](BlockRecord& b) { b.block = 0; });
    CHECK(forge.found() == "KADR_BLOCK: block 0 begins after block 0");
  }
  SUBCASE("ends of blocks") {
    Forge forge;
    forge.change<BlockEndRecord>(0, [](BlockEndRecord& b) { b.block = 9; });
    CHECK(forge.found() == "KADR_BLOCK_END: block 9 ends, the last one begun is 1");
  }
  SUBCASE("viewers") {
    Forge forge;
    forge.change<FeedSample>(1, [](FeedSample& f) { f.commanded_u_s += 1; });
    CHECK(forge.found() == "KADR_TICKS: commanded_u_s of KADR_FEED at tick 200000 is another one than here");
  }
  SUBCASE("axis of an event") {
    Forge forge;
    forge.change<EventRecord>(0, [](EventRecord& e) { e.axis = 2; });
    CHECK(forge.found() == "KADR_EVENT: its axis is 2, -1 to 1 are allowed");
  }
  SUBCASE("stamps") {
    Forge forge;
    forge.events[forge.index("KADR_FEED", 3)].time_us = 1;
    CHECK(forge.found() ==
          "KADR_FEED: it is stamped with 1 us, an event before it with 32000 us: one control tick back is "
          "allowed");
  }
  SUBCASE("numbers that are not finite") {
    Forge forge;
    forge.change<TickBlock>(
        1, [](TickBlock& b) { b.axis[1].link_u[3] = std::numeric_limits<double>::infinity(); });
    CHECK(forge.found() == "KADR_TICKS: a number in link_u is not finite");
  }
  SUBCASE("a path that runs back") {
    Forge forge;
    forge.change<TickBlock>(1, [](TickBlock& b) { b.path_u.back() = 0; });
    CHECK(forge.found().find("KADR_TICKS: path_u runs back from ") == 0);
  }
}

TEST_CASE("a summary that contradicts the messages before it makes a log damaged") {
  const auto with = [](const std::function<void(RunSummary&)>& change) {
    Forge forge;
    forge.change<LogSummary>(0, [&](LogSummary& s) { change(s.run); });
    return forge.found();
  };
  CHECK(with([](RunSummary& s) { s.control_ticks = ControlTicks{301}; }) ==
        "KADR_SUMMARY: control_ticks is 301, tick is 3000000");
  CHECK(with([](RunSummary& s) { s.blocks = 2; }) == "KADR_SUMMARY: blocks is 2, KADR_BLOCK came 3 times");
  CHECK(with([](RunSummary& s) { s.alarms = 0; }) == "KADR_SUMMARY: n_alarms is 0, KADR_EVENT has 1");
  CHECK(with([](RunSummary& s) {
          s.axis[1].pulses = 7;
        }).find("KADR_SUMMARY: axis_pulses of axis 1 is 7, ") == 0);
  CHECK(with([](RunSummary& s) {
          s.axis[0].net_steps = Steps{-1};
        }).find("KADR_SUMMARY: net_steps of axis 0 is -1, ") == 0);
  CHECK(with([](RunSummary& s) {
          s.axis[0].end_steps = Steps{-1};
        }).find("KADR_SUMMARY: end_steps of axis 0 is -1, ") == 0);
  CHECK(with([](RunSummary& s) { s.pulses = 1; }).find("KADR_SUMMARY: pulses is 1, ") == 0);
  CHECK(with([](RunSummary& s) {
          s.steps_hash = 1;
        }).find("KADR_SUMMARY: steps_hash is 0000000000000001, ") == 0);
  CHECK(with([](RunSummary& s) { s.axis.pop_back(); }) == "KADR_SUMMARY: n_axes is 1, in KADR_RUN it is 2");
}

TEST_CASE("a header that contradicts itself is damaged") {
  const auto with = [](const std::function<void(LogHeader&)>& change) {
    LogHeader h;
    h.axis = {{"X", "mm", 0.001, 0, true}, {"Y", "mm", 0.001, 0, true}};
    change(h);
    return LogProof::of_header(h).value_or("");
  };
  CHECK(with([](LogHeader&) {}) == "");
  CHECK(with([](LogHeader& h) { h.axis[1].name = "X"; }) == "axes 0 and 1 have one name");
  CHECK(with([](LogHeader& h) { h.axis[1].name = ""; }) ==
        "the name of axis 1 has 0 bytes, 1 to 53 are allowed");
  CHECK(with([](LogHeader& h) { h.axis[0].unit = "inch"; }) == "the unit of axis 0 is neither mm nor deg");
  CHECK(with([](LogHeader& h) { h.axis[0].step_u = 0; }) ==
        "a step of axis 0 is 0 long, more than 0 is allowed");
  CHECK(with([](LogHeader& h) { h.program_text = "G1"; }) ==
        "its program_text has 2 bytes, program_bytes is 0");
  CHECK(with([](LogHeader& h) {
          h.program_text = "G1";
          h.program_bytes = 2;
        }).find("its program_text has the hash ") == 0);
}

TEST_CASE("a flipped bit of a whole log is never read: open() refuses it before it gives a message") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(2), 100, {.peak_steps_per_s = 3000});
  const auto bytes = test::read_bytes(folder / "a");
  test::Random random(test::from_environment("KADR_SEED", 5));
  const auto count = test::from_environment("KADR_COUNT", 1000);
  std::uint64_t altered = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    auto flipped = bytes;
    const auto at = static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(bytes.size()) - 1));
    flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1u << random.between(0, 7)));
    test::write_bytes(folder / "b", flipped);
    auto reader = LogReader::open(folder / "b");
    CAPTURE(at);
    if (!reader) {
      altered += reader.error().fault == LogReadFault::altered;
      continue;
    }
    // the frame of an event was hit: a log without a summary
    for (LogMessage m; reader->next(m);) REQUIRE_FALSE(std::holds_alternative<LogSummary>(m));
    REQUIRE_FALSE(is_sound(reader->end().state));
  }
  if (count >= 500) CHECK(altered > count / 2);
}
