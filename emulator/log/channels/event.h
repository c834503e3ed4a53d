#pragma once
#include <array>

#include "emulator/log/channel.h"
#include "emulator/log/records.h"

namespace kadr::log {

template <std::same_as<EventRecord> R>
struct Channel<R> {
  static constexpr ChannelTitle info{
      "KADR_EVENT", "event_t",
      "spindle, sync, coolant, tool, dwell, output, input, wait, probe, message, "
      "stop, alarm, residual (section 10)"};
  static constexpr std::size_t first_fields = 11;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", ""),
      field::seconds_of<&R::tick>("t_s"),
      field::i32<&R::block>("block", "running number of the motion block before it"),
      field::i32<&R::span, &Span::line>("source_line", "from 1; 0: none"),
      field::i32<&R::span, &Span::column>("source_column", "from 1"),
      field::text<&R::kind>("kind", "section 10 of docs/log_format.md"),
      field::text<&R::code>("code", "\"K5101\" of an alarm, else empty"),
      field::i32<&R::axis>("axis", "index in run_t.axis_names, or -1"),
      field::real<&R::value>("value", FieldUnit::none, "measured"),
      field::real<&R::limit>("limit", FieldUnit::none, "allowed, of an alarm"),
      field::text<&R::text>("text", "one sentence with units"),
  };
};

}  // namespace kadr::log
