#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "machine/machine.h"
#include "planner/point_to_point/residual.h"
#include "planner/positioning/link_modes.h"
#include "planner/positioning/positioning.h"
#include "planner_support.h"
#include "verified_plan.h"

using namespace kadr;
using namespace kadr::planner;
using kadr::machine::MotorModel;
using kadr::machine::RapidShape;
using kadr::test::ProgramWriter;
using kadr::test::xyz;

namespace {

/// Rapid axes of a small router: 200 mm/s, 2000 mm/s2, jerk 40 000 mm/s3; link of X at 20 Hz, of Y at 31 Hz.
machine::MachineModel flexible_machine(RapidShape shape, double zeta = 0.0) {
  machine::MachineModel m = test::plain_machine();
  m.planner.rapid_law = shape;
  const double hz[] = {20.0, 31.0};
  for (std::size_t c = 0; c < 3; ++c) m.axis[c].max_feed_u_s = 200.0;
  for (std::size_t c = 0; c < 2; ++c) {
    machine::TwoMassModel& p = m.axis[c].plant;
    m.axis[c].has_plant = true;
    p.motor = MotorModel::rigid;
    p.base_mass_kg = 20.0;
    p.link_mass_kg = 4.0;
    const double w = 2.0 * kPi * hz[c];
    p.link_stiffness_N_per_m = p.link_mass_kg * w * w;
    p.link_damping_Ns_per_m = 2.0 * zeta * p.link_mass_kg * w;
  }
  return m;
}

/// Residual vibration of an undriven link after a law, by Runge and Kutta's method: a second way.
double residual_by_steps(const MotionLaw& law, const Mode& mode, double share) {
  const double w = mode.omega_rad_s, z = mode.zeta;
  double x = 0, v = 0;
  for (const JerkPiece& p : law.pieces) {
    const int parts = 1 + static_cast<int>(p.duration_s * w * 40.0);
    const double h = p.duration_s / parts;
    for (int i = 0; i < parts; ++i) {
      const auto rate = [&](double t, double y, double u) {
        return -share * (p.accel_u_s2 + p.jerk_u_s3 * (i * h + t)) - 2 * z * w * u - w * w * y;
      };
      const double k1 = rate(0, x, v), l1 = v;
      const double k2 = rate(h / 2, x + h / 2 * l1, v + h / 2 * k1), l2 = v + h / 2 * k1;
      const double k3 = rate(h / 2, x + h / 2 * l2, v + h / 2 * k2), l3 = v + h / 2 * k2;
      const double k4 = rate(h, x + h * l3, v + h * k3), l4 = v + h * k3;
      x += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return envelope_u({x, v}, mode);
}

/// Swing that a jump of the acceleration limit alone would leave, of an axis.
double jump_swing_u(const machine::MachineModel& m, std::size_t axis, double accel_u_s2) {
  const double w = link_modes(m.axis[axis]).at(0).mode.omega_rad_s;
  return accel_u_s2 / (w * w);
}

}  // namespace

TEST_CASE("a link on a rigid base rings at its own frequency") {
  const machine::MachineModel m = flexible_machine(RapidShape::zv, 0.03);
  const std::vector<DrivenMode> modes = link_modes(m.axis[0]);
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].mode.omega_rad_s == doctest::Approx(2 * kPi * 20).epsilon(1e-12));
  CHECK(modes[0].mode.zeta == doctest::Approx(0.03).epsilon(1e-12));
  CHECK(modes[0].gain == 1.0);
  CHECK(link_modes(m.axis[2]).empty());
}

TEST_CASE("a link on a motor's spring rings at an eigenvalue of the coupled system") {
  // eigenvalues and residues of the 4 x 4 system by Eigen: a second way
  test::Random draw(7);
  const auto random = [&](double low, double high) { return draw.between(low, high); };
  for (int i = 0; i < 200; ++i) {
    machine::AxisModel axis = test::plain_machine().axis[0];
    machine::TwoMassModel& p = axis.plant;
    axis.has_plant = true;
    p.motor = MotorModel::spring;
    p.base_mass_kg = random(1, 30);
    p.link_mass_kg = random(0.5, 10);
    p.link_stiffness_N_per_m = p.link_mass_kg * random(1e3, 4e5);
    p.link_damping_Ns_per_m = 2 * random(0, 0.05) * std::sqrt(p.link_stiffness_N_per_m * p.link_mass_kg);
    p.motor_stiffness_N_per_m = p.base_mass_kg * random(3e4, 4e6);
    p.motor_damping_Ns_per_m = 2 * random(0, 0.4) * std::sqrt(p.motor_stiffness_N_per_m * p.base_mass_kg);
    p.base_friction_Ns_per_m = random(0, 20);
    const double k = p.link_stiffness_N_per_m, c = p.link_damping_Ns_per_m, km = p.motor_stiffness_N_per_m,
                 b = p.motor_damping_Ns_per_m + p.base_friction_Ns_per_m, m0 = p.base_mass_kg,
                 m1 = p.link_mass_kg;
    Eigen::Matrix4d a;
    a << 0, 1, 0, 0,                        //
        -km / m0, -b / m0, k / m0, c / m0,  //
        0, 0, 0, 1,                         //
        km / m0, b / m0, -k * (1 / m0 + 1 / m1), -c * (1 / m0 + 1 / m1);
    const Eigen::EigenSolver<Eigen::Matrix4d> solver(a);
    std::vector<DrivenMode> wanted;
    for (int e = 0; e < 4; ++e) {
      const std::complex<double> s = solver.eigenvalues()[e];
      if (!(s.imag() > 0) || -s.real() / std::abs(s) >= kDampedEnough) continue;
      // X1(s) = e3^T (sI - A)^-1 b Xs with b = (0, Km/m0, 0, -Km/m0) and Xs = A/s^2: residue at s, times 2 and wd
      const Eigen::Vector4cd right = solver.eigenvectors().col(e);
      const Eigen::Vector4cd left = solver.eigenvectors().inverse().row(e).transpose();
      const std::complex<double> drive = left(1) * (km / m0) - left(3) * (km / m0);
      wanted.push_back(
          {{std::abs(s), -s.real() / std::abs(s)}, 2 * s.imag() * std::abs(right(2) * drive / (s * s))});
    }
    std::sort(wanted.begin(), wanted.end(),
              [](const auto& x, const auto& y) { return x.mode.omega_rad_s < y.mode.omega_rad_s; });
    const std::vector<DrivenMode> found = link_modes(axis);
    INFO("case " << i);
    REQUIRE(found.size() == wanted.size());
    for (std::size_t j = 0; j < found.size(); ++j) {
      CHECK(found[j].mode.omega_rad_s == doctest::Approx(wanted[j].mode.omega_rad_s).epsilon(1e-9));
      CHECK(found[j].mode.zeta == doctest::Approx(wanted[j].mode.zeta).epsilon(1e-7));
      CHECK(found[j].gain == doctest::Approx(wanted[j].gain).epsilon(1e-8));
    }
  }
}

TEST_CASE("a stepper's magnetic spring counts as a motor's spring where it stands") {
  machine::AxisModel axis = flexible_machine(RapidShape::zv).axis[0];
  axis.plant.motor = MotorModel::stepper;
  axis.plant.holding_force_N = 400;
  axis.plant.tooth_pitch_u = 2;
  const std::vector<DrivenMode> stepper = link_modes(axis);
  axis.plant.motor = MotorModel::spring;
  axis.plant.motor_stiffness_N_per_m = 400 * 2 * kPi / 2e-3;  // N/m
  const std::vector<DrivenMode> spring = link_modes(axis);
  REQUIRE(stepper.size() == spring.size());
  REQUIRE(!spring.empty());
  CHECK(stepper[0].mode.omega_rad_s == doctest::Approx(spring[0].mode.omega_rad_s).epsilon(1e-12));
  CHECK(spring[0].mode.omega_rad_s < 2 * kPi * 20);  // the base gives way
}

TEST_CASE("a rapid between feed moves begins and ends at rest, and verify() demands it") {
  machine::MachineModel m = flexible_machine(RapidShape::zv);
  ProgramWriter w(m);
  w.line(xyz(10), 50.0);
  w.rapid(xyz(40));
  w.line(xyz(50), 50.0);
  const Path path = w.take();
  const FeedPlan plan = test::planned(path, m);
  CHECK(plan.segments[0].end_u_s == 0.0);
  CHECK(plan.segments[1].end_u_s == 0.0);
  REQUIRE(plan.positioned.size() == 1);
  CHECK(plan.positioned[0].segment == 1);
  CHECK(plan.positioned[0].shape == RapidShape::zv);
  // planned as any other move, it runs through
  machine::MachineModel other = m;
  other.planner.rapid_law = RapidShape::scurve;
  const FeedPlan through = test::planned(path, other);
  CHECK(through.segments[0].end_u_s > 0.0);
  CHECK(test::finds(path, through, m, "rest at a stop"));
}

TEST_CASE("a rapid without a flexible axis is planned as any other move") {
  machine::MachineModel m = flexible_machine(RapidShape::zvd);
  ProgramWriter w(m);
  w.rapid(xyz(0, 0, 30));
  w.line(xyz(0, 0, 40), 50.0);
  const Path path = w.take();
  const FeedPlan plan = test::planned(path, m);
  CHECK(plan.positioned.empty());
  CHECK(plan.segments[0].end_u_s > 0.0);
}

TEST_CASE("every law of a rapid keeps all limits and is silent; an S-curve is not") {
  test::Random draw(11);
  const auto random = [&](double low, double high) { return draw.between(low, high); };
  const std::uint64_t count = test::environment("KADR_COUNT", 60);
  double loudest_scurve = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    machine::MachineModel m = flexible_machine(RapidShape::scurve);
    m.planner.whole_ticks = i % 3 != 0;
    if (i % 4 == 1)
      for (auto& axis : m.axis) axis.max_jerk_u_s3 = machine::kInfinity;
    const AxisValues to = i % 2 == 0 ? xyz(random(0.5, 400)) : xyz(random(0.5, 300), random(0.5, 300));
    for (const RapidShape shape :
         {RapidShape::scurve, RapidShape::t_zero, RapidShape::zv, RapidShape::zvd, RapidShape::automatic}) {
      m.planner.rapid_law = shape;
      ProgramWriter w(m);
      w.rapid(to);
      const Path path = w.take();
      const FeedPlan plan = test::planned(path, m);
      for (std::size_t c = 0; c < 2; ++c) {
        const double share = std::fabs(to[c]) / path.length_u();
        if (!(share > 0)) continue;
        const double swing =
            residual_by_steps(plan.law, link_modes(m.axis[c])[0].mode, share) / jump_swing_u(m, c, 2000);
        INFO("case " << i << " axis " << c << " law " << static_cast<int>(shape) << " swing " << swing);
        if (shape == RapidShape::scurve)
          loudest_scurve = std::max(loudest_scurve, swing);
        else
          CHECK(swing < 2e-4);  // of a jump of acceleration: what is left is the steps of the second method
      }
    }
  }
  CHECK(loudest_scurve > 0.3);
}

TEST_CASE("the fastest silent T law for two vibrations gives each its own interval") {
  const machine::MachineModel m = flexible_machine(RapidShape::t_zero);
  PositioningPlanner planner(m);
  ProgramWriter w(m);
  w.rapid(xyz(90, 120));
  const Path path = w.take();  // 150 mm, shares 0.6 and 0.8
  const Positioning p = planner.plan(path, 0, 250.0, 2500.0, machine::kInfinity);
  CHECK(p.tuned == 2);
  // brute force over both kinds of intervals
  const double t_x = 1.0 / 20, t_y = 1.0 / 31;
  double best = 1e9;
  for (int n = 1; n < 100; ++n)
    for (int k = 1; k < 400; ++k)
      for (const auto& [ramp, shift] : {std::pair{n * t_x, k * t_y}, std::pair{n * t_y, k * t_x}})
        if (shift >= ramp * (1 - 1e-12) && shift * 250.0 >= 150 * (1 - 1e-12) &&
            ramp * shift * 2500.0 >= 150 * (1 - 1e-12))
          best = std::min(best, ramp + shift);
  CHECK(std::ceil(best * 1000 - 1e-9) / 1000 == doctest::Approx(p.law.duration_s()).epsilon(1e-12));
}

TEST_CASE("with damping the swing of a T law's acceleration cancels that of its deceleration") {
  for (const double distance : {6.0, 20.0, 45.0, 80.0})
    for (const double jerk : {machine::kInfinity, 60000.0}) {
      machine::MachineModel m = flexible_machine(RapidShape::t_zero, 0.01);
      for (auto& axis : m.axis) axis.max_jerk_u_s3 = jerk;
      ProgramWriter w(m);
      w.rapid(xyz(distance));
      const Path path = w.take();
      const FeedPlan plan = test::planned(path, m);
      const double left = residual_by_steps(plan.law, link_modes(m.axis[0])[0].mode, 1.0);
      INFO("distance " << distance << " jerk " << jerk);
      CHECK(left < 2e-4 * jump_swing_u(m, 0, 2000));
      CHECK(plan.positioned.at(0).loss_s < 0.12);
    }
}

TEST_CASE(
    "where a swing has died down before the deceleration a T law leaves the least, and that is stated") {
  machine::MachineModel m = flexible_machine(RapidShape::t_zero, 0.04);
  m.planner.whole_ticks = false;
  for (auto& axis : m.axis) axis.max_jerk_u_s3 = machine::kInfinity;
  ProgramWriter w(m);
  w.rapid(xyz(300));
  const Path path = w.take();
  const FeedPlan plan = test::planned(path, m);
  REQUIRE(plan.positioned.size() == 1);
  const Mode mode = link_modes(m.axis[0])[0].mode;
  const double stated = plan.positioned[0].residual_u[0];
  CHECK(stated > 0.0);
  CHECK(residual_by_steps(plan.law, mode, 1.0) == doctest::Approx(stated).epsilon(1e-3));
  // an impulse shaper is silent even so
  m.planner.rapid_law = RapidShape::zv;
  const FeedPlan shaped = test::planned(path, m);
  CHECK(residual_by_steps(shaped.law, mode, 1.0) < 1e-4 * stated);
}

TEST_CASE("the automatic choice follows the rule, and says why") {
  const auto shape_for = [](double zeta, double pct, double distance) {
    machine::MachineModel m = flexible_machine(RapidShape::automatic, zeta);
    m.planner.rapid_frequency_pct = pct;
    ProgramWriter w(m);
    w.rapid(xyz(distance));
    const Path path = w.take();
    const FeedPlan plan = test::planned(path, m);
    CHECK(!plan.positioned.at(0).reason.empty());
    return plan.positioned.at(0).shape;
  };
  // 6.25 mm: bang-bang takes 2 sqrt(d/A) = 111.8 ms, ramps of one period 2 * 50 ms are too fast for A: d/(A
  // T) = 62.5 ms between the ramps' beginnings, 112.5 ms in all
  CHECK(shape_for(0.0, 0.1, 6.25) == RapidShape::t_zero);
  CHECK(shape_for(0.0, 1.0, 6.25) ==
        RapidShape::zv);  // 1.25 periods, zeros known to 1 % of their width: 0.8 %
  CHECK(shape_for(0.0, 5.0, 6.25) == RapidShape::zvd);  // not known to 1 %
  CHECK(shape_for(0.045, 0.1, 200) == RapidShape::zv);  // damped so much that no T law is silent
  // 200 mm: the speed limit asks for a ramp of 100 ms, two periods; but the time between the ramps is 1 s, 20 periods
  CHECK(shape_for(0.0, 0.1, 200) == RapidShape::zv);
}

TEST_CASE(
    "3.5 m at 1 m/s2 and 3 m/s, T = 0.06 s: ZV loses 30 ms, ZVD 60 ms, the T law 0.06 ms; automatic if known "
    "to 1/3200") {
  const ExcitedMode mode{{{100 * kPi / 3, 0}, 1}, 0, 1};
  const auto law = [&](RapidShape shape, double uncertainty) {
    return plan_positioning({3.5, 3, 1, machine::kInfinity, {&mode, 1}, shape, uncertainty, 0});
  };
  CHECK(law(RapidShape::zv, 0).loss_s == doctest::Approx(0.03).epsilon(1e-9));
  CHECK(law(RapidShape::zvd, 0).loss_s == doctest::Approx(0.06).epsilon(1e-9));
  CHECK(std::fabs(law(RapidShape::t_zero, 0).loss_s - 63e-6) <= 1e-6);
  CHECK(law(RapidShape::automatic, 3e-4).shape == RapidShape::t_zero);
  CHECK(law(RapidShape::automatic, 4e-4).shape == RapidShape::zv);
  CHECK(law(RapidShape::automatic, 0.02).shape == RapidShape::zvd);
}

TEST_CASE("ZVD is less than ZV sensitive to a frequency that is off") {
  const auto worst = [](RapidShape shape) {
    machine::MachineModel m = flexible_machine(shape);
    ProgramWriter w(m);
    w.rapid(xyz(100));
    const Path path = w.take();
    const FeedPlan plan = test::planned(path, m);
    double most = 0;
    for (const double off : {-0.1, -0.05, 0.05, 0.1}) {
      Mode mode = link_modes(m.axis[0])[0].mode;
      mode.omega_rad_s *= 1 + off;
      most = std::max(most, residual_by_steps(plan.law, mode, 1.0));
    }
    return most;
  };
  CHECK(worst(RapidShape::zvd) < 0.3 * worst(RapidShape::zv));
}
