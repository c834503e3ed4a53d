#pragma once
#include <cstdint>

#include "machine/base/count.h"

namespace kadr::machine {
struct MachineModel;
}

/// Names and numbers that the log's writer, reader and size estimate share (docs/log_format.md).
namespace kadr::log {

inline constexpr std::int32_t kLogFormat = 2;            ///< of the logs that are written
inline constexpr std::int32_t kOldestLogFormat = 2;      ///< that is read
inline constexpr std::uint32_t kEventSync = 0xEDA1DA01;  ///< first word of every event of an LCM log
inline constexpr std::size_t kEventHeaderBytes = 28;     ///< sync, event number, time stamp, two lengths
/// Longer programs are kept as length and hash only.
inline constexpr std::size_t kEmbeddedTextLimit = std::size_t{1} << 20;

/// Time stamp of an event: simulated microseconds since program start, floor(tick 10^6 / base_hz).
std::int64_t event_time_us(Ticks tick, std::int64_t base_hz);

/// Control ticks from one viewer message to the next: round(control rate / log.viewer_rate_hz), at least 1; 0: none.
std::int32_t viewer_every_ticks(const machine::MachineModel& machine);

}  // namespace kadr::log
