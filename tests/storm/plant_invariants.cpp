#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "machine/motor.h"
#include "tests/storm/invariants.h"

namespace kadr::storm {
namespace {

using machine::IntegratorKind;

bool has_plant(const FinishedRun& run) { return !run.tape.empty() && !run.tape.front().axis.empty(); }

/// A wrong state of a replay, or an integrator's failure.
struct Replay {
  std::vector<std::vector<AxisState>> states;  ///< [ticks][axes]
  std::string failure;
  bool lost_steps = false;
};

Replay through_plant(const machine::MachineModel& machine, const FinishedRun& run) {
  Replay replay;
  plant::Plant plant(machine, {.energy = machine.log.energy});
  plant.reset(run.start_u);
  for (const TapeTick& tick : run.tape) {
    if (auto moved = plant.advance(tick.batch); !moved) {
      replay.failure = fmt::format("{} at control tick {}: {}", moved.error().flag, moved.error().tick.value,
                                   moved.error().detail);
      return replay;
    }
    replay.lost_steps = replay.lost_steps || !plant.lost_steps().empty();
    replay.states.push_back(plant.state());
  }
  return replay;
}

bool same_state(const AxisState& a, const AxisState& b) {
  const auto same = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(a.base_u, b.base_u) && same(a.base_u_s, b.base_u_s) && same(a.link_u, b.link_u) &&
         same(a.link_u_s, b.link_u_s) && same(a.motor_force_N, b.motor_force_N);
}

}  // namespace

Verdict check_replay_of_pulses(const PreparedCase& prepared, const FinishedRun& run) {
  if (!has_plant(run)) return {};
  const machine::MachineModel& machine = prepared.given.machine.model;
  const Replay replay = through_plant(machine, run);
  if (!replay.failure.empty()) return Finding{Invariant::replay_equal, "the pulses again: " + replay.failure};
  for (std::size_t k = 0; k < run.tape.size(); ++k)
    for (std::size_t a = 0; a < machine.axis.size(); ++a)
      if (!same_state(run.tape[k].axis[a], replay.states[k][a]))
        return Finding{Invariant::replay_equal,
                       fmt::format("the same pulses give another state of axis {} at control tick {}",
                                   machine.axis[a].letter, k)};
  return {};
}

Verdict check_integrators(const PreparedCase& prepared, const FinishedRun& run,
                          std::optional<double>& largest_um) {
  // CVODE from pulse to pulse takes some 20 us a pulse
  constexpr std::int64_t kMostPulses = 3000;
  constexpr std::size_t kMostTicks = 1500;
  // tests/plant keeps 1e-6 um on usual machines; the storm's have frequencies of up to a third of the control rate, and what is
  // far from rest has a larger rounding
  constexpr double kBound_um = 1e-5, kOfSize = 1e-9;
  if (!has_plant(run) || run.summary.pulses > kMostPulses || run.tape.size() > kMostTicks) return {};
  machine::MachineModel machine = prepared.given.machine.model;
  machine.plant.tolerance_um = machine::PlantSettings{}.tolerance_um;
  const bool linear = std::all_of(
      machine.axis.begin(), machine.axis.end(),
      [](const machine::AxisModel& axis) { return !axis.has_plant || machine::Motor(axis).linear(); });
  machine.plant.integrator = IntegratorKind::smooth;
  const Replay smooth = through_plant(machine, run);
  if (smooth.lost_steps) return {};
  double largest = 0;
  for (const IntegratorKind kind : {IntegratorKind::reference, IntegratorKind::oracle}) {
    if (kind == IntegratorKind::oracle && !linear) continue;
    machine.plant.integrator = kind;
    const Replay other = through_plant(machine, run);
    const char* name = kind == IntegratorKind::oracle ? "oracle" : "reference";
    if (smooth.failure.empty() != other.failure.empty())
      return Finding{Invariant::integrators_agree,
                     fmt::format("smooth: {}; {}: {}", smooth.failure.empty() ? "runs" : smooth.failure, name,
                                 other.failure.empty() ? "runs" : other.failure)};
    std::vector<double> lag_um(machine.axis.size());
    for (std::size_t k = 0; k < std::min(smooth.states.size(), other.states.size()); ++k)
      for (std::size_t a = 0; a < machine.axis.size(); ++a) {
        const AxisState &s = smooth.states[k][a], &o = other.states[k][a];
        const double node_u = static_cast<double>(run.tape[k].position[a].value) * machine.axis[a].step_u;
        lag_um[a] = std::max({lag_um[a], 1e3 * std::fabs(s.base_u - node_u), 1e3 * std::fabs(s.link_u)});
        const double apart_um =
            1e3 * std::max(std::fabs(s.base_u - o.base_u), std::fabs(s.link_u - o.link_u));
        largest = std::max(largest, apart_um);
        if (apart_um > kBound_um + kOfSize * lag_um[a])
          return Finding{
              Invariant::integrators_agree,
              fmt::format("smooth and {} are {:.3g} um apart on axis {} at control tick {}, {:.3g} um from "
                          "the command at most",
                          name, apart_um, machine.axis[a].letter, k, lag_um[a])};
      }
  }
  if (smooth.failure.empty()) largest_um = largest;
  return {};
}

}  // namespace kadr::storm
