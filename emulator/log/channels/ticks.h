#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "emulator/log/channel.h"
#include "emulator/log/tick_columns.h"
#include "machine/tick_motion.h"

namespace kadr::log {

/// One axis of a TickBlock; the plant's columns are empty in a run without plant.
struct AxisTicks {
  std::vector<std::int64_t> steps;  ///< [ticks] lattice node at the tick's end, from machine zero
  std::vector<double> command_u;    ///< [ticks] before the lattice
  std::vector<double> base_u, base_u_s, link_u, link_u_s, motor_force_N;  ///< [ticks] x0, v0, x1, v1, force
};

/// KADR_TICKS; element i is the end of control tick first + i.
struct TickBlock {
  Ticks begin;
  ControlTicks first;
  std::vector<double> feed_u_s, accel_u_s2, path_u;  ///< [ticks]
  /// [ticks] ratios; of a run without operator and spindle only the one in force is in the log: then it is
  /// what was requested
  std::vector<double> override_requested, override_used, limiter;
  std::vector<std::int8_t> override_note;              ///< [ticks] OverrideNote
  std::vector<std::int8_t> limited_by, limiting_axis;  ///< [ticks] LimitedBy; axis or -1
  std::vector<std::uint32_t> block;                    ///< [ticks]
  std::vector<AxisTicks> axis;                         ///< [axes]
  bool has_plant = false;
  bool has_override = false;  ///< what was requested is in the log
  std::size_t size() const { return feed_u_s.size(); }
};

namespace field {
inline std::size_t plant_axes(const TickBlock& b) { return b.has_plant ? b.axis.size() : 0; }
std::string_view limit_word(std::int64_t number);

/// Lattice nodes: the log has the first one of each axis, and the differences to it.
constexpr Field<TickBlock> steps_base() {
  Field<TickBlock> f;
  f.name = "steps_base";
  f.wire = Wire::int64;
  f.sentence = "lattice node from machine zero that `steps` counts from";
  f.arrays = 1;
  f.compared = false;
  f.put = [](WireWriter& out, const TickBlock& b, const LogHeader&) {
    for (const AxisTicks& axis : b.axis) out.i64(axis.steps.empty() ? 0 : axis.steps.front());
  };
  f.get = [](const Reading& reading, TickBlock& b) {
    const std::int32_t axes = reading.extents()[0];
    if (!reading.in.ok() || !reading.in.fits(static_cast<std::uint64_t>(axes), 8)) return reading.in.fail();
    b.axis.resize(static_cast<std::size_t>(axes));
    for (AxisTicks& axis : b.axis) axis.steps.assign(1, reading.in.i64());
  };
  return f.by("n_axes").not_shown();
}

constexpr Field<TickBlock> steps() {
  auto f = i32<&TickBlock::axis, &AxisTicks::steps>(
      "steps", "lattice node at the tick's end, from machine zero = steps_base + steps");
  f.put = [](WireWriter& out, const TickBlock& b, const LogHeader&) {
    for (const AxisTicks& axis : b.axis)
      for (const std::int64_t node : axis.steps)
        out.i32(static_cast<std::int32_t>(node - axis.steps.front()));
  };
  f.get = [](const Reading& reading, TickBlock& b) {
    const auto n = static_cast<std::size_t>(reading.extents()[1]);
    if (!reading.in.ok() || !reading.in.fits(b.axis.size() * n, 4)) return reading.in.fail();
    for (AxisTicks& axis : b.axis) {
      const std::int64_t base = axis.steps.front();
      constexpr std::int64_t kFarthest = std::int64_t{1} << 62;
      if (base > kFarthest || base < -kFarthest) return reading.in.fail();
      axis.steps.resize(n);
      for (std::int64_t& node : axis.steps) node = base + reading.in.i32();
    }
  };
  return f.by("n_axes", "n").shown_as("steps");
}

}  // namespace field

void append_tick(TickBlock& block, const TickSource& tick);
/// Base tick and number of the first control tick agree. Fills what the log leaves out
/// where nobody asked for an override.
const char* check_message(TickBlock& block, std::string_view channel, const LogHeader& header);

template <std::same_as<TickBlock> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_TICKS", "ticks_t",
                                     "exact data of `block_ticks` (default 32, at most 64) control ticks; "
                                     "stamped with their end. Element i is the "
                                     "end of control tick first_control_tick + i"};
  static constexpr std::size_t first_fields = 24;
  using Unit = FieldUnit;
  using Key = ToleranceKey;
  static constexpr double kPercent = 100, kThousandths = 1000;
  static constexpr std::array fields{
      field::i64<&R::begin>("tick", "beginning of the first control tick").not_compared(),
      field::i64<&R::first>("first_control_tick", "").not_compared(),
      field::count<R, field::length<&R::feed_u_s>>("n", CountRule::block_ticks, "control ticks, 1..64"),
      field::count<R, field::length<&R::axis>>("n_axes", CountRule::log_axes),
      field::count<R, field::plant_axes>("n_plant_axes", CountRule::plant_axes,
                                         "n_axes, or 0 in a run without plant"),
      field::count<R, field::length<&R::override_requested>>(
          "n_override", CountRule::all_ticks,
          "n, or 0 in a run whose timeline has no operator and no spindle"),
      field::real<&R::feed_u_s>("feed_u_s", Unit::path_speed, "feed").by("n").shown_as("feed.commanded"),
      field::real<&R::accel_u_s2>("accel_u_s2", Unit::path_accel, "along the path")
          .by("n")
          .shown_as("feed.acceleration"),
      field::real<&R::path_u>("path_u", Unit::path, "along the whole program")
          .by("n")
          .shown_as("path.length"),
      field::real<&R::override_used>("override_used", Unit::none, "ratio in force, 1 is 100 %")
          .by("n")
          .shown_as("feed.override_used", Unit::percent, kPercent),
      field::i8<&R::limited_by>(
          "limited_by",
          "0 program 1 rapid 2 path_feed 3 axis_speed 4 centripetal 5 junction 6 length 7 "
          "stop 8 override 9 hold 10 limiter")
          .by("n")
          .coded(field::limit_word)
          .shown_as("feed.limited_by")
          .in_words(strings_of<kLimitedBy>),
      field::i8<&R::limiting_axis>("limiting_axis", "index in run_t.axis_names, or -1").by("n").not_shown(),
      field::i32<&R::block>("block", "running number of the block at the tick's end")
          .by("n")
          .shown_as("feed.block"),
      field::steps_base(),
      field::steps(),
      field::real<&R::axis, &AxisTicks::command_u>("command_u", Unit::axis, "before the lattice")
          .by("n_axes", "n")
          .shown_as("command"),
      field::real<&R::axis, &AxisTicks::base_u>("base_u", Unit::axis, "x0, motor and carriage")
          .by("n_plant_axes", "n")
          .within(Key::base)
          .not_shown(),
      field::real<&R::axis, &AxisTicks::base_u_s>("base_u_s", Unit::axis_speed, "v0")
          .by("n_plant_axes", "n")
          .within(Key::base_rate)
          .not_shown(),
      field::real<&R::axis, &AxisTicks::link_u>("link_u", Unit::axis,
                                                "x1, flexible part relative to the base; tool = base + link")
          .by("n_plant_axes", "n")
          .within(Key::link)
          .shown_as("vibration", Unit::axis_thousandth, kThousandths),
      field::real<&R::axis, &AxisTicks::link_u_s>("link_u_s", Unit::axis_speed, "v1")
          .by("n_plant_axes", "n")
          .within(Key::link_rate)
          .not_shown(),
      field::real<&R::axis, &AxisTicks::motor_force_N>("motor_force", Unit::force, "of the motor")
          .by("n_plant_axes", "n")
          .within(Key::force)
          .shown_as("motor_force"),
      field::real<&R::override_requested>(
          "override_requested", Unit::none,
          "ratio, 1 is 100 %; operator and spindle together, 0 in a feed hold")
          .by("n_override")
          .shown_as("feed.override_requested", Unit::percent, kPercent)
          .shown_behind("feed.override_used"),
      field::real<&R::limiter>("limiter", Unit::none, "K_max of the axis limiter, 1 where it does nothing")
          .by("n_override")
          .shown_as("feed.limiter", Unit::percent, kPercent)
          .shown_behind("feed.override_used"),
      field::i8<&R::override_note>(
          "override_note", "why requested is not used: 0 it is 1 deferred: braking 2 locked 3 axis limiter")
          .by("n_override")
          .shown_as("feed.override_note")
          .shown_behind("feed.override_used")
          .in_words(strings_of<kOverrideNotes>),
  };
};

}  // namespace kadr::log
