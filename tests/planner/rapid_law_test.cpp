#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "machine/base/numbers.h"
#include "planner/point_to_point/point_to_point.h"

// Laws for rapids: as fast as the limits and a silent load allow.
namespace kadr::planner {
namespace {

class Draw {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  /// Evenly over decades.
  double decades(double low, double high) { return low * std::exp(between(0, std::log(high / low))); }

 private:
  std::mt19937_64 random_{7};
};

/// The shortest time with a zero, by trying all ramps up to the time of `known` on a grid: ta = n T with any
/// rest of the motion, and a rest of m T with any ramp.
double shortest_by_trial_s(const PointTask& t, double period_s, double known_s) {
  double best_s = known_s;
  const auto keeps = [&](double ramp_s, double shift_s) {
    return ramp_s <= shift_s && t.distance_u / shift_s <= t.speed_limit_u_s &&
           t.distance_u / (ramp_s * shift_s) <= t.accel_limit_u_s2;
  };
  for (int n = 1; n * period_s < known_s; ++n)
    for (int i = 1; i < 400; ++i) {
      const double other_s = (known_s - n * period_s) * i / 400;
      if (keeps(n * period_s, other_s) || keeps(other_s, n * period_s))
        best_s = std::fmin(best_s, n * period_s + other_s);
    }
  return best_s;
}

}  // namespace

TEST_CASE("no trial beats the candidates for the fastest silent T law: 300 random tasks") {
  Draw draw;
  for (int i = 0; i < 300; ++i) {
    const PointTask task{draw.decades(1e-4, 5), draw.decades(0.1, 3), draw.decades(0.5, 10)};
    const Mode mode{draw.decades(20, 500), 0};
    const FastZero fast = fastest_zero_law(task, mode);
    const double known_s = fast.duration_s();
    CAPTURE(task.distance_u);
    CHECK(shortest_by_trial_s(task, mode.period_s(), known_s) == known_s);
    // the check sees: what is slower is beaten
    if (i < 20) CHECK(shortest_by_trial_s(task, mode.period_s(), 1.5 * known_s) < 1.5 * known_s);
  }
}

TEST_CASE("every shape of a rapid keeps both limits, covers the distance and is silent: 500 random tasks") {
  Draw draw;
  for (int i = 0; i < 500; ++i) {
    RapidTask task;
    task.motion = {draw.decades(1e-3, 5000), draw.decades(10, 3000), draw.decades(100, 2e4)};
    task.driven.mode = {draw.decades(20, 500), i % 2 ? draw.between(0, .2) : 0};
    for (const RapidShape shape :
         {RapidShape::scurve, RapidShape::t_zero, RapidShape::zv, RapidShape::zvd, RapidShape::automatic}) {
      task.shape = shape;
      const auto rapid = rapid_law(task);
      REQUIRE(rapid);
      CAPTURE(rapid_shape_name(rapid->shape));
      CHECK(rapid->law.peak_speed_u_s() <= task.motion.speed_limit_u_s * (1 + 4e-12));
      CHECK(rapid->law.peak_accel_u_s2() <= task.motion.accel_limit_u_s2 * (1 + 4e-12));
      CHECK(rapid->loss_s >= -1e-12 * rapid->law.duration_s());
      CHECK((shape == RapidShape::automatic) == !rapid->reason.empty());
      const double w = task.driven.mode.omega_rad_s;
      const bool shaped = rapid->shape == RapidShape::zv || rapid->shape == RapidShape::zvd;
      if (shaped || task.driven.mode.zeta == 0)
        CHECK(rapid->amplitude_u <= 1e-10 * task.motion.accel_limit_u_s2 / (w * w));
    }
  }
}

TEST_CASE(
    "3.5 m at 1 m/s2 and 3 m/s, T = 0.06 s: ZV loses 30 ms, ZVD and the S-curve 60 ms, the T law 0.06 ms") {
  RapidTask task;
  task.motion = {3.5, 3, 1};
  task.driven.mode = {100 * kPi / 3, 0};
  const auto loss_ms = [&](RapidShape shape) {
    task.shape = shape;
    return 1e3 * rapid_law(task)->loss_s;
  };
  CHECK(loss_ms(RapidShape::zv) == doctest::Approx(30).epsilon(1e-9));
  CHECK(loss_ms(RapidShape::zvd) == doctest::Approx(60).epsilon(1e-9));
  CHECK(loss_ms(RapidShape::scurve) == doctest::Approx(60).epsilon(1e-9));
  CHECK(std::fabs(loss_ms(RapidShape::t_zero) - .063) <= .001);
}

TEST_CASE("automatic takes the T law only if its frequency is known well enough, and says why") {
  // ta = 31 T: the frequency has to be known to 1/3100
  RapidTask task;
  task.motion = {3.5, 3, 1};
  task.driven.mode = {100 * kPi / 3, 0};
  const auto shape = [&](double uncertainty) {
    task.omega_uncertainty = uncertainty;
    return rapid_law(task)->shape;
  };
  CHECK(shape(3e-4) == RapidShape::t_zero);
  CHECK(shape(4e-4) == RapidShape::zv);
  CHECK(shape(0.01) == RapidShape::zv);
  CHECK(shape(0.02) == RapidShape::zvd);
  task.driven.mode.zeta = .005;
  CHECK(shape(3e-4) == RapidShape::zv);
  CHECK(rapid_law(task)->reason.find("damping") != std::string_view::npos);
}

TEST_CASE("what a rapid can't be planned from is named: negative, endless, too damped, too fine") {
  using Kind = PointFault::Kind;
  const RapidTask good{{1, 1, 1}, {{100, 0}, 1}};
  const auto kind = [&](auto change) {
    RapidTask task = good;
    change(task);
    const auto rapid = rapid_law(task);
    REQUIRE_FALSE(rapid);
    return rapid.error().kind;
  };
  CHECK(rapid_law(good));
  CHECK(kind([](RapidTask& t) { t.motion.distance_u = 0; }) == Kind::not_positive);
  CHECK(kind([](RapidTask& t) { t.motion.speed_limit_u_s = -1; }) == Kind::not_positive);
  CHECK(kind([](RapidTask& t) { t.motion.accel_limit_u_s2 = HUGE_VAL; }) == Kind::not_positive);
  CHECK(kind([](RapidTask& t) { t.driven.mode.omega_rad_s = std::nan(""); }) == Kind::not_positive);
  CHECK(kind([](RapidTask& t) { t.driven.mode.zeta = 1; }) == Kind::bad_damping);
  CHECK(kind([](RapidTask& t) { t.omega_uncertainty = -.1; }) == Kind::bad_share);
  CHECK(kind([](RapidTask& t) { t.driven.mode.omega_rad_s = 1e9; }) == Kind::too_fine);
}

}  // namespace kadr::planner
