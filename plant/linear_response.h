#pragma once
#include <array>
#include <memory>
#include <vector>

#include "machine/step_batch.h"
#include "plant/axis_equations.h"

namespace kadr::plant {

/// Exact answers of one spring axis over one control tick; built once per set of parameters.
///
///   z(T) = whole_tick z(0) + sum_i d_i row[t_i] - sum_q monomial[q] c_q
///
/// for the input sum_i d_i step H(t - t_i) - sum_q c_q theta^q, both taken from the node at the tick's beginning.
struct LinearResponse {
  struct alignas(32) Row {
    double at[4];
  };
  Matrix4 whole_tick;
  std::vector<Row> row;               // [control tick], by the pulse's offset in base ticks
  std::array<Vector4, 6> monomial{};  // response to theta^q from rest

  explicit LinearResponse(const AxisEquations& equations);
  /// sum_i d_i row[t_i]; the order of the sum depends on the pulses alone.
  Vector4 pulses(const AxisPulses& pulses) const;

  /// One table for axes with the same equations and step, of those in `known` or a new one.
  static std::shared_ptr<const LinearResponse> shared(
      const AxisEquations& equations,
      std::vector<std::pair<AxisEquations, std::shared_ptr<const LinearResponse>>>& known);
};

}  // namespace kadr::plant
