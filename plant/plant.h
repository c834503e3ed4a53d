#pragma once
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "machine/axis_state.h"
#include "machine/step_batch.h"

namespace kadr::machine {
struct MachineModel;
}

/// The flexible machine: two masses per axis, driven by the step pulses of each control tick (paper 001, eq.
/// 5-6).
///
///   m1 (x0'' + x1'') + c x1' + k x1 = 0
///   m0 x0'' = F_motor - b0 x0' + k x1 + c x1'           tool position on the axis = x0 + x1
///   F_motor = force(x0 - x_step) - bm x0', force by the motor's law (machine/motor.h)
///   rigid: x0 follows the command (StepBatch's AxisCommand, cubic between the tick's ends) exactly
namespace kadr::plant {

using kadr::AxisState;

/// A numerical fault: the run ends, the log stays readable.
struct PlantError {
  std::string flag;  ///< CVODE's name of its return flag, or our own
  ControlTicks tick;
  int axis = -1;
  std::string detail;
};

/// Lost steps, found at the tick's end: the motor lags by more than half a tooth pitch.
struct LostSteps {
  int axis = 0;
  ControlTicks tick;
  /// Whole teeth in steps, since the last report; negative if the rotor stayed behind a motion in plus direction.
  Steps steps;
};

/// Per axis energy since the reset, joules; closes: motor work = kinetic + spring + dissipated, to 1e-9 of
/// the work with a tolerance of 1e-8 um. motor_damping is part of the motor, so its losses are negative motor work.
struct EnergyBalance {
  double motor_work_J = 0;
  /// Where the motor drives; positive_J - motor_work_J is what the load gives back to it (recuperated), their
  /// sum what paper 001 calls |P|. The sign is taken part by part between two pulses.
  double positive_work_J = 0;
  double kinetic_J = 0;
  double spring_J = 0;
  double dissipated_J = 0;
};

struct PlantOptions {
  bool energy = false;  ///< work and losses are integrated from pulse to pulse: about 0.1 us per pulse
};

/// Integrators smooth (CVODE on a smooth command plus the exact response to the residual staircase; steppers
/// by Taylor series from pulse to pulse), reference (CVODE re-initialised at every pulse) and oracle (closed
/// form, linear motors only) stand behind this one class. Only rigid axes and axes without plant follow the
/// command itself; for the others it is a hint that the result does not depend on.
class Plant {
 public:
  /// @throws nothing; a machine whose axes have no plant gives states that equal the command
  explicit Plant(const machine::MachineModel& machine, PlantOptions options = {});
  Plant(Plant&&) noexcept;
  ~Plant();
  /// Moves all axes through one control tick. batch.axis has the machine's axes in order, offsets ascending
  /// and within the tick (promises). Allocates nothing unless it fails. Fails by a CVODE flag, or:
  /// BAD_PARAMETERS, ORACLE_NEEDS_LINEAR_MOTOR, COMMAND_JUMP (a rigid axis's command does not begin where it
  /// ended), NOT_FINITE, SERIES_NOT_CONVERGED, MOTION_TOO_FAST. After a failure only reset() helps.
  tl::expected<void, PlantError> advance(const StepBatch& batch);
  const std::vector<AxisState>& state() const;       ///< [axes], at the end of the last tick
  const std::vector<LostSteps>& lost_steps() const;  ///< found in the last tick
  EnergyBalance energy(int axis) const;              ///< only with PlantOptions::energy (a promise)
  /// Jumps to rest at the given positions (start of a run, emergency stop).
  void reset(const std::vector<double>& position_u);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr::plant
