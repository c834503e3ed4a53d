#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator/log/log_reader.h"

namespace kadr::log {

struct HeaderFault {
  LogReadFault fault;
  std::string reason;
};

/// KADR_RUN from its bytes, of every log format from kOldestLogFormat on.
tl::expected<Decoded<LogHeader>, HeaderFault> decode_header(std::span<const std::uint8_t> data);

/// Any other message; an unknown channel gives UnknownMessage.
/// @return the reason why the bytes are not that message
tl::expected<Decoded<LogMessage>, std::string> decode_message(const LogEventView& event,
                                                              const LogHeader& header);

/// Text of unknown origin for a message: other than printable ASCII becomes '?'.
std::string printable(std::string_view text);

}  // namespace kadr::log
