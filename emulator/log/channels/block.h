#pragma once
#include <array>

#include "emulator/log/channel.h"
#include "emulator/log/records.h"

namespace kadr::log {

template <std::same_as<BlockRecord> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_BLOCK", "block_t", "as the motion of a block begins"};
  static constexpr std::size_t first_fields = 16;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", "beginning of the motion"),
      field::seconds_of<&R::tick>("t_s"),
      field::i32<&R::block>("block", "running number"),
      field::i32<&R::span, &Span::line>("source_line", "from 1"),
      field::i32<&R::span, &Span::column>("source_column", "from 1"),
      field::text<&R::text>("source_text", "the program line"),
      field::text<&R::motion>("motion", "\"rapid\" \"line\" \"arc\""),
      field::real<&R::length_u>("length_u", FieldUnit::path, "length of its path"),
      field::real<&R::programmed_u_s>("programmed_u_s", FieldUnit::path_speed, "feed of the program"),
      field::real<&R::planned_peak_u_s>("planned_peak_u_s", FieldUnit::path_speed,
                                        "largest feed, as planned"),
      field::real<&R::planned_end_u_s>("planned_end_u_s", FieldUnit::path_speed,
                                       "feed at its end, as planned"),
      field::real<&R::planned_s>("planned_s", FieldUnit::time, "duration, as planned"),
      field::text<&R::limited_by>("limited_by", "\"program\", \"axis X speed\""),
      field::real<&R::entry_u_s>("entry_u_s", FieldUnit::path_speed, "feed at its beginning, as run"),
      field::real<&R::planned_entry_u_s>("planned_entry_u_s", FieldUnit::path_speed, "as planned at 100 %"),
      field::i32<&R::deferred_ticks>("deferred_ticks",
                                     "control ticks that an override has waited for the motion before it"),
  };
};

}  // namespace kadr::log
