#pragma once
#include <array>
#include <cstdint>

#include "emulator/log/channel.h"

namespace kadr::log {

/// KADR_FEED
struct FeedSample {
  Ticks tick;
  double t_s = 0;
  std::uint32_t block = 0;
  double path_u = 0, commanded_u_s = 0, acceleration_u_s2 = 0, jerk_u_s3 = 0, override_used_pct = 0;
  std::int8_t phase = 0;  ///< 0 at rest, 1 accelerate, 2 cruise, 3 brake
  std::int8_t limited_by = 0;
};

template <std::same_as<FeedSample> R>
struct Channel<R> {
  static constexpr ChannelTitle info{
      "KADR_FEED", "feed_t",
      "for viewers, `log.viewer_rate_hz` (default 100 Hz); same numbers as KADR_TICKS"};
  static constexpr std::size_t first_fields = 10;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", "end of the control tick"),
      field::real<&R::t_s>("t_s", FieldUnit::time, "`tick` in seconds"),
      field::i32<&R::block>("block", "running number"),
      field::real<&R::path_u>("path_u", FieldUnit::path, "along the whole program"),
      field::real<&R::commanded_u_s>("commanded_u_s", FieldUnit::path_speed, "feed"),
      field::real<&R::acceleration_u_s2>("acceleration_u_s2", FieldUnit::path_accel, "along the path"),
      field::real<&R::jerk_u_s3>("jerk_u_s3", FieldUnit::path_jerk, "mean over the control tick"),
      field::real<&R::override_used_pct>("override_used_pct", FieldUnit::percent, "override in force"),
      field::i8<&R::phase>("phase", "0 at rest 1 accelerate 2 cruise 3 brake"),
      field::i8<&R::limited_by>("limited_by", "as ticks_t.limited_by"),
  };
};

}  // namespace kadr::log
