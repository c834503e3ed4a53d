#pragma once
#include "machine/step_batch.h"
#include "plant/axis_equations.h"
#include "plant/cvode.h"
#include "plant/integrator.h"

namespace kadr::plant {

/// Moves an axis from pulse to pulse by the Taylor series of its solution. Between two pulses the equations
/// are autonomous and analytic; the motor's law brings the series of its force (machine/motor.h). Terms are
/// added until two in a row are below 1e-20 m, which takes 6 to 10 orders between dense pulses; an interval
/// longer than the fastest rate allows is cut into equal parts. Error per interval: about 1e-14 um, rounding besides.
class TaylorAxis {
 public:
  explicit TaylorAxis(const AxisEquations& equations);

  /// Through one control tick, pulses included. With `work` the motor's work and the losses are summed as
  /// well. Fails if a series does not converge or the motion is too fast to be cut up.
  Outcome advance_tick(Vector4& z, const AxisPulses& pulses, AxisWork* work) const;

 private:
  Outcome advance(Vector4& z, double ticks, AxisWork* work) const;
  template <class Law>
  bool advance_part(const Law& law, Vector4& z, double h, AxisWork* work) const;
  struct Products;
  void add_work(AxisWork& work, const Products& of) const;

  AxisEquations eq_;
  double rate_ = 0;
};

}  // namespace kadr::plant
