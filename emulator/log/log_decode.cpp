#include "emulator/log/log_decode.h"

#include <fmt/format.h>

#include <optional>

namespace kadr::log {
namespace {

using Message = tl::expected<Decoded<LogMessage>, std::string>;

tl::unexpected<HeaderFault> header_fault(LogReadFault fault, std::string reason) {
  return tl::unexpected<HeaderFault>(HeaderFault{fault, std::move(reason)});
}

template <class R>
bool is_named(std::string_view channel) {
  constexpr ChannelTitle kTitle = Channel<R>::info;
  if (kTitle.each_axis) return channel.substr(0, kTitle.name.size()) == kTitle.name;
  return channel == kTitle.name;
}

template <class R>
Message decode_as(const LogEventView& event, const LogHeader& header) {
  auto decoded = decode<R>(event.data, event.channel, header);
  if (!decoded) return tl::unexpected(decoded.error());
  if constexpr (std::same_as<R, LogHeader>) {
    return tl::unexpected<std::string>("a second header");
  } else if constexpr (std::same_as<R, PulseBlock>) {
    auto steps = decode_steps(decoded->record, header);
    if (!steps) return tl::unexpected(steps.error());
    return Decoded<LogMessage>{std::move(*steps), decoded->newer};
  } else {
    return Decoded<LogMessage>{std::move(decoded->record), decoded->newer};
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c < 0x20 || c > 0x7e) c = '?';
  return out;
}

tl::expected<Decoded<LogHeader>, HeaderFault> decode_header(std::span<const std::uint8_t> data) {
  WireReader in(data);
  in.i64();  // fingerprint
  in.i64();  // tick
  // tick and log_format stand first in KADR_RUN of every format
  const std::int32_t format = in.i32();
  if (!in.ok()) return header_fault(LogReadFault::cut_in_header, "the log's first message is damaged");
  const bool known_type = fields_of<LogHeader>(WireReader(data).i64()) > 0;
  const bool known_format = format >= kOldestLogFormat && format <= kLogFormat;
  if (known_type && !known_format)
    return header_fault(
        LogReadFault::other_format,
        fmt::format("written by another version of kadr: log format {}, this one reads {}", format,
                    kOldestLogFormat == kLogFormat ? fmt::format("{}", kLogFormat)
                                                   : fmt::format("{} to {}", kOldestLogFormat, kLogFormat)));
  auto header = decode<LogHeader>(data, Channel<LogHeader>::info.name, LogHeader{});
  if (header && known_format) return std::move(*header);
  if (!known_type)
    return header_fault(LogReadFault::other_format,
                        "written by another version of kadr: its first message has other fields");
  return header_fault(LogReadFault::cut_in_header, "the log's first message is damaged");
}

tl::expected<Decoded<LogMessage>, std::string> decode_message(const LogEventView& event,
                                                              const LogHeader& header) {
  std::optional<Message> message;
  for_each_channel(Channels{}, [&]<class R>() {
    if (!message && is_named<R>(event.channel)) message = decode_as<R>(event, header);
  });
  return message ? std::move(*message) : Decoded<LogMessage>{UnknownMessage{}, false};
}

}  // namespace kadr::log
