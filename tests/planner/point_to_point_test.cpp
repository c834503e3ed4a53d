#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "machine/base/numbers.h"
#include "machine/base/require.h"
#include "planner/point_to_point/point_to_point.h"
#include "tests/support/seed.h"

// Laws of paper 001. Reference values: 40 digits, closed form, of the paper's Table 1 (3.5 m in 4 s, a <= 1
// m/s2, v <= 3 m/s, omega = 100 pi/3 rad/s, so T = 0.06 s). u is the metre.
namespace kadr::planner {
namespace {

constexpr double kOmega = 100 * kPi / 3, kDistance = 3.5, kTime = 4;
const PointTask kTask{3.5, 3, 1};
DrivenMode mode(double omega, double zeta = 0) { return {{omega, zeta}, 1}; }
doctest::Approx near(double value, double relative) { return doctest::Approx(value).epsilon(relative); }
/// Of a value alone: doctest's own scale adds 1.
bool agrees(double value, double reference, double relative) {
  return std::fabs(value - reference) <= relative * std::fabs(reference);
}
/// The paper's energies have the gravity of its misprint.
Load printed_load() {
  Load load;
  load.gravity_m_s2 = printed_gravity_m_s2(kDistance, kTime);
  return load;
}

}  // namespace

TEST_CASE("a T law of xi = 0.25 over 3 m in 4 s: ramps of 1 s, 1 m/s2, 1 m/s") {
  // Vmax = 3/(4 * 0.75) = 1, Amax = 1/(0.25 * 4) = 1; after the ramp 0.5 m, after the cruise 2.5 m
  const PointLaw law = t_law(3, 4, 0.25);
  REQUIRE(law.pieces().size() == 3);
  CHECK(law.duration_s() == 4);
  CHECK(law.peak_speed_u_s() == 1);
  CHECK(law.peak_accel_u_s2() == 1);
  CHECK(std::isinf(law.peak_jerk_u_s3()));
  CHECK(law.at(1).position_u == 0.5);
  CHECK(law.at(2).speed_u_s == 1);
  CHECK(law.at(3).position_u == 2.5);
  CHECK(law.at(3.5).position_u == 2.875);
  CHECK(law.at(-1).position_u == 0);
  CHECK(law.at(9).position_u == 3);
}

TEST_CASE("a T law without cruise has two pieces; edges that do not end at rest break a promise") {
  CHECK(t_law(1, 2, 0.5).pieces().size() == 2);
  const PointEdge stays_fast[] = {{0, 1, 0}, {1, -1, 0}};
  CHECK_THROWS_AS(PointLaw::from_edges(stays_fast, 1), BrokenPromise);
  const PointEdge elsewhere[] = {{0, 1, 0}, {1, -2, 0}, {2, 1, 0}};
  CHECK_THROWS_AS(PointLaw::from_edges(elsewhere, 2), BrokenPromise);  // it covers 1
  CHECK(PointLaw::from_edges(elsewhere, 1).distance_u() == 1);
}

TEST_CASE("averaging a T law over 0.5 s makes the S-curve of seven pieces with jerk a/0.5") {
  // ramps 1 s, cruise 2 s, a = 1: jerk 2, total 4.5 s; at 0.25 s v = j t^2/2 = 0.0625; v = 0.25 at 0.5 s
  const PointLaw law = averaged(t_law(3, 4, 0.25), 0.5);
  REQUIRE(law.pieces().size() == 7);
  CHECK(law.duration_s() == 4.5);
  CHECK(law.peak_jerk_u_s3() == 2);
  CHECK(law.peak_accel_u_s2() == near(1, 1e-15));
  CHECK(law.peak_speed_u_s() == near(1, 1e-15));
  CHECK(law.at(0.25).speed_u_s == near(0.0625, 1e-15));
  CHECK(law.at(0.5).speed_u_s == near(0.25, 1e-15));
  CHECK(law.at(2.25).position_u == near(1.5, 1e-14));
}

TEST_CASE("residual vibration of T laws: 14 reference values, by propagation, by jumps and in closed form") {
  struct Reference {
    double omega, zeta, xi, x1, v1, envelope;
  };
  const Reference all[] = {
      {kOmega, 0, 1.0 / 3, 1.136455123471736e-4, 2.061301580433754e-2, 2.272910246943472e-4},
      {kOmega, 0, .3333, 1.128388435000749e-4, 2.046670226013603e-2, 2.256776870001498e-4},
      {kOmega, .005, .36, 5.191341929806375e-5, -1.095202366002421e-3, 5.290578555721386e-5},
      {kOmega, .005, .3601, 5.274982655671674e-5, -8.651442398819802e-4, 5.335269555266232e-5},
      {kOmega, .005, .3333, 9.639820658964978e-5, 6.365251915051542e-3, 1.142199208610994e-4},
      {kOmega, .005, .48, 5.929320785085513e-5, -1.553112282378515e-3, 6.104872013288290e-5},
      {kOmega, .005, .4803, 6.232047164036407e-5, -9.742913517287278e-4, 6.296588578668870e-5},
      {105, 0, .36, 3.876886978431416e-5, 2.154095429252042e-3, 4.386226706822624e-5},
      {105, 0, .3333, 2.377592242562208e-4, 1.321049752242337e-2, 2.689956826257564e-4},
      {105, 0, .48, 5.123305926725997e-5, 2.846636990146553e-3, 5.796398349512973e-5},
      {105, .005, .3601, 5.214078931495499e-5, 4.080432605594043e-4, 5.230543510307423e-5},
      {105, .005, .3333, 1.234626056480099e-4, 4.611804582040757e-3, 1.312509443657027e-4},
      {105, .005, .4803, 6.390108623638739e-5, -7.743830995162532e-5, 6.390245341508234e-5},
  };
  for (const Reference& r : all) {
    CAPTURE(r.omega);
    CAPTURE(r.zeta);
    CAPTURE(r.xi);
    const DrivenMode m = mode(r.omega, r.zeta);
    const PointLaw law = t_law(kDistance, kTime, r.xi);
    const LinkState end = link_at(law, m, kTime);
    CHECK(agrees(end.link_u, r.x1, 1e-12));
    CHECK(std::fabs(end.link_u_s - r.v1) <= 1e-12 * r.omega * r.envelope);
    CHECK(agrees(envelope_u(end, m.mode), r.envelope, 1e-12));
    CHECK(agrees(residual_amplitude_u(law, m), r.envelope, 1e-12));
    CHECK(agrees(t_law_amplitude_u(kDistance, kTime, r.xi, m.mode), r.envelope, 1e-12));
  }
  for (const double xi : {.36, .48, .33, .325})
    CHECK(residual_amplitude_u(t_law(kDistance, kTime, xi), mode(kOmega)) <= 1e-12);
}

TEST_CASE("largest values after a law: with damping less than the envelope, 0.0527 mm after xi = 0.3601") {
  // of the table "what Table 2 should have been" in docs/motion_laws.md, to the digits printed there
  struct Row {
    double zeta, xi, speed_m_s, amplitude_mm;
  };
  for (const Row& r : {Row{0, .3333, .023633, .225678}, Row{.005, .3601, .005548, .052750},
                       Row{.005, .3333, .011834, .113898}, Row{.005, .4803, .006547, .062320}}) {
    const DrivenMode m = mode(kOmega, r.zeta);
    const ResidualPeaks peaks = residual_peaks(link_at(t_law(kDistance, kTime, r.xi), m, kTime), m.mode);
    CHECK(std::fabs(peaks.link_u_s - r.speed_m_s) <= 5.1e-7);
    CHECK(std::fabs(1e3 * peaks.link_u - r.amplitude_mm) <= 5.1e-7);
  }
}

TEST_CASE("a law by its jumps and by its pieces leaves the same vibration: 500 random shapes and modes") {
  std::mt19937_64 random(kadr::test::property_seed(20260));
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 500; ++i) {
    const DrivenMode m{{draw(20, 400), i % 2 ? draw(0, 0.3) : 0}, draw(0.5, 2)};
    PointLaw law = ramp_law(draw(0.01, 2), draw(0.01, 0.5), draw(0, 0.5), draw(0.01, 0.5));
    if (i % 3 == 1) law = averaged(law, draw(0.001, 0.5));
    if (i % 5 == 1) law = zvd_shaped(law, m.mode);
    if (i % 5 == 2) law = zv_shaped(law, m.mode);
    const double by_pieces = envelope_u(link_at(law, m, law.duration_s()), m.mode);
    const double w = m.mode.omega_rad_s, scale = m.gain * law.peak_accel_u_s2() / (w * w);
    CHECK(std::fabs(residual_amplitude_u(law, m) - by_pieces) <= 1e-12 * scale);
    if (i % 5 == 1 || i % 5 == 2) CHECK(by_pieces <= 1e-12 * scale);
    // half way the state is the same whether one stops there or not
    const LinkState half = link_at(law, m, law.duration_s() / 2);
    CHECK(std::isfinite(half.link_u));
  }
}

TEST_CASE("a force-driven axis rings at omega sqrt(1 + m1/m0): 1.1055 omega for 4.5 and 1 kg") {
  // state of the load at 4 s, paper's force; a law that is silent for a stiff axis is not here
  struct Reference {
    double omega, zeta, xi, x1, v1;
  };
  for (const Reference& r : {Reference{kOmega, 0, .36, 1.041699945980123e-4, 1.629861744789229e-2},
                             Reference{kOmega, .005, .36, 1.100358879335827e-4, 1.629604090057160e-3},
                             Reference{105, .005, .48, 1.259159280590289e-4, 1.970369786119047e-3}}) {
    const DrivenMode m = DrivenMode::of({r.omega, r.zeta}, Drive::force, 4.5, 1);
    CHECK(agrees(m.mode.omega_rad_s, 1.1055415967851333 * r.omega, 1e-15));
    const LinkState end = link_at(t_law(kDistance, kTime, r.xi), m, kTime);
    CHECK(agrees(end.link_u, r.x1, 1e-12));
    CHECK(agrees(end.link_u_s, r.v1, 1e-12));
  }
}

TEST_CASE(
    "energies: T1 11.9236 J, T2 11.3516 J, T3 15.8619 J as printed but for the factor 4; physics reverses "
    "them") {
  struct Row {
    double xi, printed_J, physical_J;
  };
  for (const Row& r :
       {Row{.36, 11.92359, 17.7914}, Row{.3333, 11.3516, 18.0587}, Row{.48, 15.8619, 17.1675}}) {
    const PointLaw law = t_law(kDistance, kTime, r.xi);
    const Work printed = work_of(law, printed_load()), physical = work_of(law, {});
    CHECK(std::fabs(printed.absolute_J - r.printed_J) <= 6e-5);
    CHECK(std::fabs(physical.absolute_J - r.physical_J) <= 6e-5);
    CHECK(printed.absolute_J == near(t_law_energy_J(kDistance, kTime, r.xi, printed_load()), 1e-14));
    // what is stored is given back: the difference is the work of lifting, c xf
    CHECK(printed.positive_J - printed.recuperated_J == near(1.07296875 * 3.5, 1e-13));
    // int a^2 = 2 A^2 ta
    const double a = law.peak_accel_u_s2();
    CHECK(physical.copper_m2_s3 == near(2 * a * a * r.xi * kTime, 1e-13));
  }
}

TEST_CASE("work of an S-curve agrees with a sum over 200 000 moments") {
  const PointLaw law = averaged(t_law(kDistance, 3.94, .34), 0.06);
  for (const Load& load : {Load{}, printed_load()}) {
    const Work w = work_of(law, load);
    Work sum;
    constexpr int n = 200'000;
    for (int i = 0; i < n; ++i) {
      const PointState s = law.at((i + 0.5) * law.duration_s() / n);
      const double power =
          load.mass_kg * s.speed_u_s * (load.inertia_ratio() * s.accel_u_s2 + load.weight_m_s2());
      (power > 0 ? sum.positive_J : sum.recuperated_J) += std::fabs(power) * law.duration_s() / n;
      sum.peak_W = std::max(sum.peak_W, power);
      sum.least_W = std::min(sum.least_W, power);
      sum.copper_m2_s3 += s.accel_u_s2 * s.accel_u_s2 * law.duration_s() / n;
    }
    CHECK(w.positive_J == near(sum.positive_J, 1e-8));
    CHECK(std::fabs(w.recuperated_J - sum.recuperated_J) <= 1e-7);
    // the sum samples next to the corners, where power peaks
    CHECK(w.peak_W >= sum.peak_W);
    CHECK(w.least_W <= sum.least_W);
    CHECK(w.peak_W == near(sum.peak_W, 1e-5));
    CHECK(w.least_W == near(sum.least_W, 1e-5));
    CHECK(w.copper_m2_s3 == near(sum.copper_m2_s3, 1e-8));
  }
}

TEST_CASE(
    "at 4 s without damping the exact optimum is xi = 0.325 (m = 45), 11.189352 J; the paper's T1 is sixth") {
  const auto zeros = zero_laws(kTask, kTime, {kOmega, 0}, printed_load());
  REQUIRE(zeros);
  CHECK(zeros->size() == 24);
  CHECK(zeros->front().branch == ZeroBranch::rest);
  CHECK(zeros->front().count == 45);
  CHECK(zeros->front().xi == near(.325, 1e-14));
  CHECK(std::fabs(zeros->front().energy_J - 11.189352) <= 5e-7);
  CHECK((*zeros)[5].xi == near(.36, 1e-14));
  CHECK((*zeros)[5].count == 24);
  const auto choice = best_t_law(kTask, kTime, mode(kOmega), printed_load());
  REQUIRE(choice);
  CHECK(choice->xi == zeros->front().xi);
  CHECK(choice->amplitude_u <= 1e-12);
}

TEST_CASE("at 4 s with a damping of 0.005 the least amplitude is 0.051124 mm at xi = 0.3297907 (n = 22)") {
  const auto choice = best_t_law(kTask, kTime, mode(kOmega, .005), printed_load());
  REQUIRE(choice);
  CHECK(std::fabs(choice->xi - .3297907) <= 5e-8);
  CHECK(choice->periods == 22);
  CHECK(std::fabs(1e3 * choice->amplitude_u - .051124) <= 5e-7);
  CHECK(std::fabs(choice->energy_J - 11.2822) <= 5e-5);
  // no xi of a fine grid is better
  for (double xi = .3232234; xi <= .5; xi += 1e-5)
    CHECK(t_law_amplitude_u(kDistance, kTime, xi, {kOmega, .005}) >= choice->amplitude_u);
}

TEST_CASE("a time that is too short is refused with the shortest one: 3.741657 s for 3.5 m") {
  const auto choice = best_t_law(kTask, 3.7, mode(kOmega), {});
  REQUIRE_FALSE(choice);
  CHECK(choice.error().kind == PointFault::Kind::too_short);
  CHECK(choice.error().measured == 3.7);
  CHECK(choice.error().allowed == near(2 * std::sqrt(3.5), 1e-15));
  CHECK(best_t_law(kTask, choice.error().allowed, mode(kOmega), {}));
}

TEST_CASE("the fastest silent T law takes 3.741720 s, 0.06 ms more than bang-bang") {
  const FastZero fast = fastest_zero_law(kTask, {kOmega, 0});
  CHECK(std::fabs(fast.duration_s() - 3.741720) <= 5e-7);
  CHECK(fast.count == 31);
  CHECK(fast.duration_s() - shortest_time_s(kTask) <= 1e-4);
  CHECK(residual_amplitude_u(fast.law(kDistance), mode(kOmega)) <= 1e-12);
  const DoubleZero twice = fastest_double_zero(kTask, {kOmega, 0});
  CHECK(twice.ramp == 31);
  CHECK(twice.shift == 32);
}

}  // namespace kadr::planner
