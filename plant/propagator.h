#pragma once
#include <vector>

#include "machine/base/count.h"
#include "plant/matrix.h"

namespace kadr::plant {

/// e^{A t} at every whole base tick of a control tick, from two tables of 257 matrices:
/// e^{A (256 i + j) delta} = coarse[i] fine[j], delta = one base tick.
class Propagator {
 public:
  /// @param system        A, per control tick
  /// @param control_tick  length of a control tick, 1..65536
  Propagator(const Matrix4& system, Ticks control_tick);
  /// e^{A t} z after `base_ticks`, 0..control_tick; error a few units in the last place of |z|.
  Vector4 apply(Ticks base_ticks, const Vector4& z) const {
    return coarse_[static_cast<std::size_t>(base_ticks.value >> 8)] *
           (fine_[static_cast<std::size_t>(base_ticks.value & 255)] * z);
  }

 private:
  std::vector<Matrix4> coarse_;
  std::vector<Matrix4> fine_;
};

}  // namespace kadr::plant
