#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/point_to_point/point_to_point.h"
#include "plant/plant.h"

// Two methods that share no code: the plant's equations, driven tick by tick, and the closed form of laws.
namespace kadr {
namespace {

/// The link of a stiff axis that is led along a law, at its end; ends of pieces lie on control ticks of 0.4
/// ms, so a piece's cubic is the command of each tick exactly.
planner::LinkState by_plant(const planner::PointLaw& law, const planner::Mode& mode) {
  machine::MachineModel model;
  model.clock.base_hz = 10'000'000;
  model.clock.control_tick = {4000};
  machine::AxisModel axis;
  axis.step_u = 0.01;
  axis.has_plant = true;
  axis.plant.motor = machine::MotorModel::rigid;
  axis.plant.base_mass_kg = 4.5;
  axis.plant.link_mass_kg = 2;
  axis.plant.link_stiffness_N_per_m = 2 * mode.omega_rad_s * mode.omega_rad_s;
  axis.plant.link_damping_Ns_per_m = 2 * mode.zeta * mode.omega_rad_s * 2;
  model.axis.push_back(axis);
  plant::Plant plant(model);
  StepBatch batch;
  batch.axis.resize(1);
  const auto ticks = std::lround(law.duration_s() / 4e-4);
  for (long i = 0; i < ticks; ++i) {
    const auto begin = law.at(static_cast<double>(i) * 4e-4), end = law.at(static_cast<double>(i + 1) * 4e-4);
    batch.axis[0].command = {begin.position_u, end.position_u, begin.speed_u_s, end.speed_u_s};
    const auto moved = plant.advance(batch);
    REQUIRE(moved);
    batch.tick.value += 1;
  }
  return {plant.state()[0].link_u, plant.state()[0].link_u_s};
}

}  // namespace

TEST_CASE(
    "the plant and the closed form agree on T law, S-curve and shaped law to 1e-8 of the static deflection") {
  // lengths in mm; T = 0.06 s and half of it are whole ticks
  for (const double zeta : {0.0, 0.005}) {
    const planner::Mode mode{100 * kPi / 3, zeta};
    const planner::PointLaw t = planner::t_law(3500, 4, 0.3333);
    for (const planner::PointLaw& law : {t, planner::averaged(t, 0.06), planner::averaged(t, 0.1),
                                         planner::zv_shaped(t, {100 * kPi / 3, 0})}) {
      const planner::LinkState exact = planner::link_at(law, {mode, 1}, law.duration_s());
      const planner::LinkState driven = by_plant(law, mode);
      const double scale = law.peak_accel_u_s2() / (mode.omega_rad_s * mode.omega_rad_s);
      CHECK(std::fabs(driven.link_u - exact.link_u) <= 1e-8 * scale);
      CHECK(std::fabs(driven.link_u_s - exact.link_u_s) <= 1e-8 * scale * mode.omega_rad_s);
    }
    // the check sees: another damping is another vibration
    const planner::LinkState other = planner::link_at(t, {{mode.omega_rad_s, 0.01}, 1}, t.duration_s());
    CHECK(std::fabs(by_plant(t, mode).link_u - other.link_u) > 1e-3 * t.peak_accel_u_s2() / 1e4);
  }
}

}  // namespace kadr
