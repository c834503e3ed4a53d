#pragma once
#include <string>
#include <vector>

#include "emulator/log/run_log.h"
#include "plant/plant.h"

namespace kadr::test {

/// Keeps every record in memory, in the order it came.
class RecordingLog final : public log::RunLog {
 public:
  struct Tick {
    log::TickRecord record;
    TickMotion motion;
    std::vector<std::int64_t> steps;
    std::vector<AxisState> axis;
    StepBatch batch;
  };
  std::vector<log::BlockRecord> blocks;
  std::vector<log::BlockEndRecord> block_ends;
  std::vector<log::EventRecord> events;
  std::vector<Tick> ticks;
  log::RunSummary summary;
  std::vector<std::int64_t> order;  ///< base tick of each record as it came (a tick record: its end)
  std::int64_t tau = 10'000;
  bool ended = false;

  using Done = tl::expected<void, log::LogError>;
  Done begin(const log::RunHeader& h) override {
    tau = h.machine->clock.control_tick.value;
    return {};
  }
  Done block(const log::BlockRecord& r) override {
    blocks.push_back(r);
    order.push_back(r.tick.value);
    return {};
  }
  Done block_end(const log::BlockEndRecord& r) override {
    block_ends.push_back(r);
    return {};
  }
  Done event(const log::EventRecord& r) override {
    events.push_back(r);
    order.push_back(r.tick.value);
    return {};
  }
  Done diagnostic(const Diagnostic&, Ticks) override { return {}; }
  Done tick(const log::TickRecord& r, const StepBatch& batch) override {
    Tick t{r, *r.motion, *r.position_steps, r.axis ? *r.axis : std::vector<AxisState>{}, batch};
    ticks.push_back(std::move(t));
    return {};
  }
  Done end(const log::RunSummary& s) override {
    summary = s;
    ended = true;
    return {};
  }

  std::vector<log::EventRecord> of_kind(const std::string& kind) const {
    std::vector<log::EventRecord> list;
    for (const auto& e : events)
      if (e.kind.text() == kind) list.push_back(e);
    return list;
  }
};

}  // namespace kadr::test
