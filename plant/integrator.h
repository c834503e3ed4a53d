#pragma once
#include <memory>
#include <vector>

#include "machine/base/count.h"
#include "machine/step_batch.h"
#include "plant/axis_equations.h"
#include "plant/cvode.h"

namespace kadr::plant {

/// Joules since the reset.
struct AxisWork {
  double motor_J = 0;
  double positive_J = 0;  ///< of motor_J, where the motor drives; the rest is given back to it
  double dissipated_J = 0;

  /// Work of the motor over a part short enough not to change its sign.
  void add_motor(double part_J) {
    motor_J += part_J;
    if (part_J > 0) positive_J += part_J;
  }
};

/// Teeth of a motor, signed.
using Teeth = Count<struct TeethTag>;

/// A batch describes the motion of an axis twice, as pulses and as a command. Which of the two its integrator
/// reads is decided here alone, and Plant checks before each tick that it can be read:
///
///   pulses    all motors driven by pulses: reference, oracle and Taylor series. Smooth takes the command as
///   a
///             hint besides, to shape the smooth part of its motion; its result does not depend on it.
///   command   a motor that follows its command, and an axis without a plant. Pulses only count its node.
enum class Reads : std::uint8_t { pulses, command };

/// One machine axis under integration. The motor's equilibrium is the lattice node of the steps so far, moved
/// by the teeth that it has slipped; the equilibrium of a motor that follows its command is that command.
struct AxisMotion {
  AxisEquations equations;
  int axis = 0;         ///< index in the machine and in the batch
  double origin_u = 0;  ///< position of node 0
  double step_u = 0;
  double pitch_u = 0;
  Reads reads() const { return equations.motor.follows_command() ? Reads::command : Reads::pulses; }

  Vector4 z{};               ///< at the end of the last tick, relative to its equilibrium
  Steps node;                ///< since the reset
  Teeth slipped;             ///< since the reset
  double equilibrium_u = 0;  ///< absolute
  double motor_force_N = 0;
  AxisWork work;  ///< kept only if requested

  /// Takes a tick's net steps into node and equilibrium.
  void move_node(Steps steps) {
    node += steps;
    equilibrium_u =
        origin_u + static_cast<double>(node.value) * step_u + static_cast<double>(slipped.value) * pitch_u;
  }
};

/// Moves its axes from one tick end to the next.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Reads and writes z, node, equilibrium and motor force of its axes.
  virtual Outcome advance(const StepBatch& batch) = 0;
  /// The axes were put to rest at new positions: forget the past.
  virtual void reset() = 0;
};

/// Local tolerances of the states of an axis [m, m per tick]: `tolerance_um` in millionths of a metre, or of
/// 1000 degrees for a rotary axis. Tighter where light damping lets errors pile up.
Vector4 local_tolerance(const AxisEquations& equations, double tolerance_um);

/// CVODE on a smooth command plus the exact response to the residual staircase; all axes with linear motors
/// as one system.
std::unique_ptr<Integrator> make_smooth(const std::vector<AxisMotion*>& axes, double tolerance_um);
/// CVODE restarted at every pulse; any motor driven by pulses, one axis.
std::unique_ptr<Integrator> make_reference(AxisMotion& axis, double tolerance_um);
/// Matrix exponential from pulse to pulse; linear motor, one axis.
std::unique_ptr<Integrator> make_oracle(AxisMotion& axis);
/// Taylor series from pulse to pulse; any motor driven by pulses, one axis.
std::unique_ptr<Integrator> make_taylor(AxisMotion& axis);
/// Prescribed base, exact response of the link; one axis.
std::unique_ptr<Integrator> make_rigid(AxisMotion& axis, bool energy);

}  // namespace kadr::plant
