#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "machine/base/count.h"

namespace kadr::machine {
struct MachineModel;
}

/// Names and numbers that the log's writer, reader and size estimate share (docs/log_format.md).
namespace kadr::emulator {

inline constexpr std::int32_t kLogFormat = 2;
inline constexpr std::uint32_t kEventSync = 0xEDA1DA01;  ///< first word of every event of an LCM log
inline constexpr std::size_t kEventHeaderBytes = 28;     ///< sync, event number, time stamp, two lengths
inline constexpr std::size_t kMaxChannelBytes = 63;      ///< LCM's limit for a channel name
inline constexpr std::size_t kEmbeddedTextLimit = std::size_t{1}
                                                  << 20;  ///< longer programs: length and hash only

inline constexpr std::string_view kRunChannel = "KADR_RUN";
inline constexpr std::string_view kBlockChannel = "KADR_BLOCK";
inline constexpr std::string_view kBlockEndChannel = "KADR_BLOCK_END";
inline constexpr std::string_view kTicksChannel = "KADR_TICKS";
inline constexpr std::string_view kStepsChannel = "KADR_STEPS";
inline constexpr std::string_view kFeedChannel = "KADR_FEED";
inline constexpr std::string_view kAxisChannelPrefix = "KADR_AXIS_";  ///< and the axis letter
inline constexpr std::string_view kEventChannel = "KADR_EVENT";
inline constexpr std::string_view kDiagChannel = "KADR_DIAG";
inline constexpr std::string_view kSummaryChannel = "KADR_SUMMARY";

enum class MessageKind : std::uint8_t {
  run,
  block,
  block_end,
  ticks,
  steps,
  feed,
  axis,
  event,
  diag,
  summary,
  unknown
};
MessageKind message_kind(std::string_view channel);

/// LCM's 64-bit fingerprint of a message type: the first 8 bytes of each message of that type.
std::int64_t fingerprint(MessageKind kind);

/// Time stamp of an event: simulated microseconds since program start, floor(tick 10^6 / base_hz).
std::int64_t event_time_us(Ticks tick, std::int64_t base_hz);

/// Control ticks from one viewer message to the next: round(control rate / log.viewer_rate_hz), at least 1;
/// 0: none.
std::int32_t viewer_every_ticks(const machine::MachineModel& machine);

/// "KADR_AXIS_X"
std::string axis_channel(char letter);

}  // namespace kadr::emulator
