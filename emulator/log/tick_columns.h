#pragma once
#include <cstdint>
#include <vector>

#include "emulator/log/records.h"

namespace kadr::log {

struct LogHeader;

/// Longest block of control ticks in one message, so that times within a block fit 23 bits.
inline constexpr int kMaxBlockTicks = 64;

/// One control tick, for a channel that keeps a value of it.
struct TickSource {
  const TickRecord& record;
  const StepBatch& batch;
  const std::vector<std::int64_t>& node;  ///< [axes] lattice node at the tick's end, from machine zero
};

/// Whether base tick and number of a block's first control tick agree.
bool begins_at_its_tick(Ticks begin, ControlTicks first, const LogHeader& header);

}  // namespace kadr::log
