#include "emulator/cycle/record_writer.h"

#include <doctest/doctest.h>

#include "tests/support/recording_log.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {

/// Fails at the given event.
class FullDisk final : public RunLog {
 public:
  using Done = tl::expected<void, LogError>;
  Done begin(const RunHeader&) override { return {}; }
  Done block(const BlockRecord&) override { return {}; }
  Done tick(const TickRecord&, const StepBatch&) override { return {}; }
  Done block_end(const BlockEndRecord&) override { return {}; }
  Done event(const EventRecord&) override {
    ++events;
    return tl::unexpected(LogError{"part.lcmlog", "No space left on device", Ticks{12'345'678}});
  }
  Done diagnostic(const Diagnostic&, Ticks) override { return {}; }
  Done end(const RunSummary&) override { return {}; }
  int events = 0;
};

}  // namespace

TEST_CASE("blocks and events of a tick are written in tick order, a block before the events at its tick") {
  const machine::ClockModel clock;
  RecordingLog log;
  const RecordWriter writer(&log, clock);
  std::vector<BlockRecord> blocks(2);
  blocks[0].tick = Ticks{50};
  blocks[1].tick = Ticks{80};
  std::vector<EventRecord> events(4);
  events[0].tick = Ticks{10};
  events[1].tick = Ticks{50};
  events[2].tick = Ticks{60};
  events[3].tick = Ticks{90};
  CHECK_FALSE(writer.happenings(blocks, events, std::vector<BlockEndRecord>(1)));
  CHECK(log.order == std::vector<std::int64_t>{10, 50, 50, 60, 80, 90});
  CHECK(log.blocks.size() == 2);
  CHECK(log.block_ends.size() == 1);
}

TEST_CASE("a log that fails ends the writing and says up to where it is valid; no log never fails") {
  const machine::ClockModel clock;
  FullDisk disk;
  const RecordWriter writer(&disk, clock);
  const auto failure = writer.happenings({}, std::vector<EventRecord>(3), {});
  REQUIRE(failure);
  CHECK(failure->what ==
        "part.lcmlog: No space left on device; the log is valid up to tick 12345678 (1.234568 s)");
  CHECK(disk.events == 1);
  const RecordWriter none(nullptr, clock);
  CHECK_FALSE(none.writes());
  CHECK_FALSE(none.happenings({}, std::vector<EventRecord>(3), {}));
}
