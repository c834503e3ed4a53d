#pragma once
#include <array>
#include <cstdint>

#include "emulator/log/channel.h"

namespace kadr::log {

/// KADR_AXIS_*
struct AxisSample {
  int axis = -1;  ///< index in the header; from the channel's name
  Ticks tick;
  double t_s = 0;
  std::int64_t steps = 0;
  double ideal = 0, commanded = 0, motor = 0, load = 0, load_rate = 0, load_minus_ideal_um = 0,
         motor_force_N = 0;
};

/// The header has that axis; sets `axis`.
const char* check_message(AxisSample& sample, std::string_view channel, const LogHeader& header);

template <std::same_as<AxisSample> R>
struct Channel<R> {
  static constexpr ChannelTitle info{
      "KADR_AXIS_", "axis_t",
      "for viewers, one channel per axis, at the same moments; scalars only, so that "
      "a viewer draws each field by name",
      true};
  static constexpr std::size_t first_fields = 10;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", "end of the control tick"),
      field::real<&R::t_s>("t_s", FieldUnit::time, "`tick` in seconds"),
      field::i64<&R::steps>("steps", "lattice node, from machine zero"),
      field::real<&R::ideal>("ideal", FieldUnit::axis, "before the lattice"),
      field::real<&R::commanded>("commanded", FieldUnit::axis, "steps * step"),
      field::real<&R::motor>("motor", FieldUnit::axis,
                             "without plant: as commanded before the lattice, also load"),
      field::real<&R::load>("load", FieldUnit::axis, "the tool on this axis"),
      field::real<&R::load_rate>("load_rate", FieldUnit::axis_speed, "its speed"),
      field::real<&R::load_minus_ideal_um>("load_minus_ideal_um", FieldUnit::axis_thousandth,
                                           "following error"),
      field::real<&R::motor_force_N>("motor_force_N", FieldUnit::force, "of the motor"),
  };
};

}  // namespace kadr::log
