#pragma once
#include <string>
#include <vector>

#include "emulator/log/run_log.h"
#include "plant/plant.h"

namespace kadr::test {

/// Keeps every record in memory, in the order it came.
class RecordingLog final : public emulator::RunLog {
 public:
  struct Tick {
    emulator::TickRecord record;
    TickMotion motion;
    std::vector<Steps> steps;
    std::vector<AxisState> axis;
    StepBatch batch;
  };
  std::vector<emulator::BlockRecord> blocks;
  std::vector<emulator::BlockEndRecord> block_ends;
  std::vector<emulator::EventRecord> events;
  std::vector<Tick> ticks;
  emulator::RunSummary summary;
  std::vector<std::int64_t> order;  ///< base tick of each record as it came (a tick record: its end)
  std::int64_t tau = 10'000;
  bool ended = false;

  using Done = tl::expected<void, emulator::LogError>;
  Done begin(const emulator::RunHeader& h) override {
    tau = h.machine->clock.control_tick.value;
    return {};
  }
  Done block(const emulator::BlockRecord& r) override {
    blocks.push_back(r);
    order.push_back(r.tick.value);
    return {};
  }
  Done block_end(const emulator::BlockEndRecord& r) override {
    block_ends.push_back(r);
    return {};
  }
  Done event(const emulator::EventRecord& r) override {
    events.push_back(r);
    order.push_back(r.tick.value);
    return {};
  }
  Done diagnostic(const Diagnostic&, Ticks) override { return {}; }
  Done tick(const emulator::TickRecord& r, const StepBatch& batch) override {
    Tick t{r, *r.motion, *r.position_steps, r.axis ? *r.axis : std::vector<AxisState>{}, batch};
    ticks.push_back(std::move(t));
    return {};
  }
  Done end(const emulator::RunSummary& s) override {
    summary = s;
    ended = true;
    return {};
  }

  std::vector<emulator::EventRecord> of_kind(const std::string& kind) const {
    std::vector<emulator::EventRecord> list;
    for (const auto& e : events)
      if (e.kind.text() == kind) list.push_back(e);
    return list;
  }
};

}  // namespace kadr::test
