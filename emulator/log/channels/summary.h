#pragma once
#include <array>
#include <cstdint>

#include "emulator/log/channel.h"
#include "emulator/log/records.h"

namespace kadr::log {

/// KADR_SUMMARY
struct LogSummary {
  RunSummary run;
  std::uint64_t content_hash = 0;
  std::uint64_t log_hash = 0;   ///< of the whole log (ContentHash::add_summary)
  std::size_t log_hash_at = 0;  ///< where it was read, in bytes from the message's beginning; 0: it has none
};

namespace field {
/// A value of RunSummary, and one of each axis' summary.
template <auto kMember>
constexpr auto run_real(std::string_view name, FieldUnit unit, std::string_view sentence) {
  return real<&LogSummary::run, kMember>(name, unit, sentence);
}
template <auto kMember>
constexpr auto run_i64(std::string_view name, std::string_view sentence) {
  return i64<&LogSummary::run, kMember>(name, sentence);
}
template <auto kMember>
constexpr auto axis_real(std::string_view name, FieldUnit unit, std::string_view sentence) {
  return real<&LogSummary::run, &RunSummary::axis, kMember>(name, unit, sentence).by("n_axes");
}
template <auto kMember>
constexpr auto axis_i64(std::string_view name, std::string_view sentence) {
  return i64<&LogSummary::run, &RunSummary::axis, kMember>(name, sentence).by("n_axes");
}

/// The hash of the whole log: a reader has to know its place, because its own bytes are hashed as zeros.
constexpr Field<LogSummary> log_hash() {
  auto f = i64<&LogSummary::log_hash>(
      "log_hash", "XXH3 of every message, these eight bytes as zeros (docs/log_format.md)");
  f.get = [](const Reading& reading, LogSummary& summary) {
    const std::size_t at = reading.in.position();
    summary.log_hash = static_cast<std::uint64_t>(reading.in.i64());
    if (reading.in.ok()) summary.log_hash_at = at;
  };
  return f.not_compared();
}
}  // namespace field

// `kadr diff` compares what the run came to: peaks and means follow from the ticks
template <std::same_as<LogSummary> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_SUMMARY", "summary_t", "last event; a log without it was cut off"};
  static constexpr std::size_t first_fields = 46;
  using Unit = FieldUnit;
  using Run = RunSummary;
  using Axis = AxisSummary;
  static constexpr std::array fields{
      field::run_i64<&Run::ticks>("tick", "length of the run"),
      field::seconds_of<&R::run, &Run::ticks>("t_s"),
      field::text<&R::run, &Run::outcome>("outcome",
                                          "\"complete\" \"alarm\" \"emergency stop\" \"held\" \"stopped by "
                                          "--until\" \"interrupted\" \"plant error\""),
      field::run_i64<&Run::control_ticks>("control_ticks", "").not_compared(),
      field::i32<&R::run, &Run::blocks>("blocks", ""),
      field::run_real<&Run::path_u>("path_u", Unit::path, "length of the path"),
      field::run_real<&Run::mean_feed_u_s>("mean_feed_u_s", Unit::path_speed, "over the time in motion")
          .not_compared(),
      field::run_real<&Run::peak_feed_u_s>("peak_feed_u_s", Unit::path_speed, "").not_compared(),
      field::run_real<&Run::motion_s>("motion_s", Unit::time, "").not_compared(),
      field::run_real<&Run::dwell_s>("dwell_s", Unit::time, "").not_compared(),
      field::run_i64<&Run::pulses>("pulses", "of all axes"),
      field::run_i64<&Run::steps_hash>("steps_hash", "offsets and signs of every pulse, by tick and axis")
          .not_compared(),
      field::i64<&R::content_hash>("content_hash",
                                   "XXH3 of every message before this one (docs/log_format.md)")
          .not_compared(),
      field::run_real<&Run::path_error_u>(
          "path_error_u", Unit::path, "largest distance of the tool from the command, over the axes X Y Z")
          .not_compared(),
      field::run_real<&Run::held_error_u>(
          "held_error_u", Unit::path, "tick_feed = constant: largest distance from the law along the path")
          .not_compared(),
      field::count<R, field::length<&R::run, &Run::axis>>("n_axes", CountRule::axes),
      field::axis_i64<&Axis::pulses>("axis_pulses", "counted, both directions"),
      field::axis_i64<&Axis::net_steps>("net_steps", ""),
      field::axis_i64<&Axis::end_steps>("end_steps", "lattice node at the end, from machine zero"),
      field::axis_real<&Axis::end_u>("end_u", Unit::axis, ""),
      field::axis_real<&Axis::min_u>("min_u", Unit::axis, "commanded, at control ticks").not_compared(),
      field::axis_real<&Axis::max_u>("max_u", Unit::axis, "commanded, at control ticks").not_compared(),
      field::axis_real<&Axis::peak_feed_u_s>("peak_axis_feed_u_s", Unit::axis_speed, "").not_compared(),
      field::axis_i64<&Axis::peak_feed_tick>("peak_axis_feed_tick", "").not_compared(),
      field::axis_real<&Axis::peak_accel_u_s2>("peak_accel_u_s2", Unit::axis_accel, "").not_compared(),
      field::axis_real<&Axis::peak_jerk_u_s3>("peak_jerk_u_s3", Unit::axis_jerk, "").not_compared(),
      field::axis_real<&Axis::peak_vibration_u>("peak_vibration_u", Unit::axis, "|x1|").not_compared(),
      field::axis_i64<&Axis::peak_vibration_tick>("peak_vibration_tick", "").not_compared(),
      field::i32<&R::run, &Run::axis, &Axis::peak_vibration_line>("peak_vibration_line", "")
          .by("n_axes")
          .not_compared(),
      field::axis_real<&Axis::rms_vibration_u>("rms_vibration_u", Unit::axis, "").not_compared(),
      field::axis_real<&Axis::residual_u>("residual_u", Unit::axis, "largest envelope after a stop")
          .not_compared(),
      field::axis_real<&Axis::peak_following_u>("peak_following_u", Unit::axis, "|tool - command|")
          .not_compared(),
      field::axis_real<&Axis::rms_following_u>("rms_following_u", Unit::axis, "").not_compared(),
      field::axis_i64<&Axis::lost_steps>("lost_steps", ""),
      field::axis_real<&Axis::positive_J>("positive_J", Unit::energy,
                                          "work of the motor where it drives; 0 without log.energy")
          .not_compared(),
      field::axis_real<&Axis::recuperated_J>("recuperated_J", Unit::energy, "and where it brakes")
          .not_compared(),
      field::count<R, field::length<&R::run, &Run::limited_by>>("n_limits", CountRule::any),
      field::text<&R::run, &Run::limited_by, &LimitShare::limited_by>("limited_by", "descending time")
          .by("n_limits")
          .not_compared(),
      field::real<&R::run, &Run::limited_by, &LimitShare::time_s>("limited_s", Unit::time, "")
          .by("n_limits")
          .not_compared(),
      field::run_real<&Run::planned_s>("planned_s", Unit::time, "motion at 100 %, as planned").not_compared(),
      field::count<R, field::length<&R::run, &Run::lost_by>>("n_losses", CountRule::any,
                                                             "0 in a run without override steps"),
      field::text<&R::run, &Run::lost_by, &LimitShare::limited_by>(
          "lost_by", "\"override\", \"hold\", \"spindle load\", \"limiter\", \"deferral\"")
          .by("n_losses")
          .not_compared(),
      field::real<&R::run, &Run::lost_by, &LimitShare::time_s>("lost_s", Unit::time,
                                                               "more than planned; < 0: gained")
          .by("n_losses")
          .not_compared(),
      field::run_i64<&Run::alarms>("n_alarms", ""),
      field::run_i64<&Run::warnings>("n_warnings", "of the program: its KADR_DIAG of severity 2"),
      field::i32<&R::run, &Run::exit_code>("exit_code", "of `kadr run`"),
      field::log_hash(),
  };
};

}  // namespace kadr::log
