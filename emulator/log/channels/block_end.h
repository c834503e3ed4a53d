#pragma once
#include <array>

#include "emulator/log/channel.h"
#include "emulator/log/records.h"

namespace kadr::log {

template <std::same_as<BlockEndRecord> R>
struct Channel<R> {
  static constexpr ChannelTitle info{
      "KADR_BLOCK_END", "block_end_t",
      "when another block has begun: largest vibration and following error, and "
      "with `log.energy` the work of the motors"};
  static constexpr std::size_t first_fields = 10;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", ""),
      field::seconds_of<&R::tick>("t_s"),
      field::i32<&R::block>("block", "running number"),
      field::i32<&R::line>("source_line", "from 1"),
      field::count<R, field::length<&R::peak_link_u>>("n_axes", CountRule::axes),
      field::real<&R::peak_link_u>("peak_link_u", FieldUnit::axis, "largest |x1| at control ticks")
          .by("n_axes"),
      field::real<&R::peak_following_u>("peak_following_u", FieldUnit::axis,
                                        "largest |tool - command| at control ticks")
          .by("n_axes"),
      field::count<R, field::length<&R::positive_J>>("n_energy_axes", CountRule::axes,
                                                     "n_axes with log.energy and a plant, else 0"),
      field::real<&R::positive_J>("positive_J", FieldUnit::energy, "work of the motor where it drives")
          .by("n_energy_axes"),
      field::real<&R::recuperated_J>("recuperated_J", FieldUnit::energy, "and where it brakes")
          .by("n_energy_axes"),
  };
};

}  // namespace kadr::log
