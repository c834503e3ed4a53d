#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/run_program.h"

/// Rapids of planner.rapid_law in the emulated machine: real step pulses, two masses under CVODE, and what
/// still vibrates after the stop.
namespace kadr::test {
namespace {

using machine::RapidShape;

machine::MachineModel rig(RapidShape shape) {
  SourceSet sources;
  auto file = machine::read_machine(SourceText("rig1.toml", std::string(machine::shipped_machine("rig1"))),
                                    sources, {});
  REQUIRE(file);
  file->model.planner.rapid_law = shape;
  return file->model;
}

struct Stop {
  double swing_um = 0;  ///< largest |x1| from 0.2 s after the stop on, when the motor's own vibration is gone
  double stated_um = 0;  ///< amplitude that the plan says is left
  double time_s = 0;     ///< of the rapid
};

/// One rapid of 1000 mm, then standing for 0.8 s.
/// @param off  by which the link's frequency differs from the one that the law was tuned to
Stop stop_after(const machine::MachineModel& model, double off = 0.0) {
  RunResult r;
  r.in = make_inputs("G21 G90\nG0 X1000\nG4 P0.8\nM2\n", model);
  prepare_run(r);
  Stop stop;
  if (!r.job->planned.plan.positioned.empty())
    stop.stated_um = 1e3 * r.job->planned.plan.positioned[0].residual_u[0];
  stop.time_s = r.job->planned.plan.segments[0].end_time_s;
  r.in.given.machine.model.axis[0].plant.link_stiffness_N_per_m *= (1 + off) * (1 + off);
  run_prepared(r);
  const auto from = static_cast<std::size_t>((stop.time_s + 0.2) * 1000);
  for (std::size_t k = from; k < r.log.ticks.size(); ++k)
    stop.swing_um = std::max(stop.swing_um, 1e3 * std::fabs(r.log.ticks[k].axis[0].link_u));
  return stop;
}

}  // namespace

TEST_CASE("on the emulated rig a rapid law leaves the swing of the steps alone") {
  // time-optimal with ramps that have nothing to do with the link: 16.7 periods
  const Stop plain = stop_after(rig(RapidShape::scurve));
  CHECK(plain.swing_um > 50);
  for (const RapidShape shape : {RapidShape::t_zero, RapidShape::zv, RapidShape::zvd}) {
    const Stop stop = stop_after(rig(shape));
    INFO("law " << static_cast<int>(shape) << ": " << stop.swing_um << " um after " << stop.time_s
                << " s, plain " << plain.swing_um << " um after " << plain.time_s << " s");
    CHECK(stop.swing_um <= 0.01 * plain.swing_um);
    CHECK(stop.stated_um < 1e-3 * plain.swing_um);
    CHECK(stop.time_s - plain.time_s < 0.061);  // no more than the period
  }
}

TEST_CASE("a law tuned to the link's own frequency rings on a base that gives way") {
  // negative: planned for a rigid base, run on the motor's spring
  machine::MachineModel rigid = rig(RapidShape::t_zero);
  rigid.axis[0].plant.motor = machine::MotorModel::rigid;
  RunResult r;
  r.in = make_inputs("G21 G90\nG0 X1000\nG4 P0.8\nM2\n", rigid);
  prepare_run(r);
  r.in.given.machine.model.axis[0].plant.motor = machine::MotorModel::spring;
  run_prepared(r);
  double swing_um = 0;
  for (auto k = static_cast<std::size_t>((r.job->planned.plan.segments[0].end_time_s + 0.2) * 1000);
       k < r.log.ticks.size(); ++k)
    swing_um = std::max(swing_um, 1e3 * std::fabs(r.log.ticks[k].axis[0].link_u));
  CHECK(swing_um > 5 * stop_after(rig(RapidShape::t_zero)).swing_um);
}

TEST_CASE("ZVD keeps the emulated rig within 7.5 um over 10 % of its frequency, a T law does not") {
  double zvd_um = 0, t_um = 0;
  for (const double off : {-0.1, -0.05, 0.05, 0.1}) {
    zvd_um = std::max(zvd_um, stop_after(rig(RapidShape::zvd), off).swing_um);
    t_um = std::max(t_um, stop_after(rig(RapidShape::t_zero), off).swing_um);
  }
  INFO("ZVD " << zvd_um << " um, T law " << t_um << " um");
  CHECK(zvd_um <= 7.5);
  CHECK(t_um > 50);
}

TEST_CASE("the swing on the emulated rig is that of the closed form") {
  // a long move with damping: the vibration after the acceleration has decayed, and no T law is silent
  for (const double zeta : {0.02, 0.04}) {
    machine::MachineModel m = rig(RapidShape::t_zero);
    machine::TwoMassModel& p = m.axis[0].plant;
    p.motor = machine::MotorModel::rigid;
    p.link_damping_Ns_per_m = 2 * zeta * std::sqrt(p.link_stiffness_N_per_m * p.link_mass_kg);
    RunResult r;
    run_program(r, "G21 G90\nG0 X3000\nG4 P0.2\nM2\n", m);
    const double stated_u = r.job->planned.plan.positioned.at(0).residual_u[0];
    const auto residual = r.log.of_kind("residual");
    REQUIRE(!residual.empty());
    CHECK(stated_u > 0.005);
    CHECK(residual[0].value == doctest::Approx(stated_u).epsilon(0.01));
  }
}

TEST_CASE(
    "the motors' energy of a run is the sum of its blocks', and what a motor keeps ends in the dampers") {
  machine::MachineModel m = rig(RapidShape::zv);
  m.log.energy = true;
  RunResult r;
  run_program(r, "G21 G90\nG0 X500\nG1 X600 F6000\nG0 X0\nG4 P3\nM2\n", m);
  double positive_J = 0, recuperated_J = 0;
  REQUIRE(r.log.block_ends.size() == 3);
  for (const log::BlockEndRecord& b : r.log.block_ends) {
    REQUIRE(b.positive_J.size() == 1);
    CHECK(b.positive_J[0] > 0);
    positive_J += b.positive_J[0];
    recuperated_J += b.recuperated_J[0];
  }
  const log::AxisSummary& x = r.summary.axis[0];
  CHECK(positive_J == doctest::Approx(x.positive_J).epsilon(1e-9));
  CHECK(recuperated_J == doctest::Approx(x.recuperated_J).epsilon(1e-9));
  // rigid body: 500 mm to and fro, (m0 + m1) v^2/2 goes in and comes back: v^2 = A d
  CHECK(x.positive_J > 0.5 * 5.5 * 0.4);
  CHECK(x.recuperated_J < x.positive_J);
  // without the key nothing is measured
  m.log.energy = false;
  RunResult plain;
  run_program(plain, "G21 G90\nG0 X500\nM2\n", m);
  CHECK(plain.summary.axis[0].positive_J == 0);
  CHECK(plain.log.block_ends.at(0).positive_J.empty());
}

}  // namespace kadr::test
