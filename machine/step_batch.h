#pragma once
#include <cstdint>
#include <vector>

#include "machine/base/count.h"

namespace kadr {

/// Lattice node of a position, in steps from machine zero: floor(x/step + 1/2), so that every axis counts consistently from block to
/// block. Positions beyond 2^52 steps break a promise: doubles count no further.
Steps lattice_node(double position_u, double step_u);

/// Motion of one axis that the interpolator followed in this control tick, before the lattice; axis units (mm or deg).
struct AxisCommand {
  double position_begin_u = 0;
  double position_end_u = 0;
  double speed_begin_u_s = 0;  ///< just after the tick's beginning
  /// just before its end; differs from the next begin at a corner taken without a stop
  double speed_end_u_s = 0;
};

/// Pulses of one axis in one control tick. Offsets never decrease and are < the control tick's length.
/// They are bare 16-bit numbers: the widest array of a run, whose loops run in vector registers.
struct AxisPulses {
  std::vector<std::uint16_t> offset_ticks;  ///< [count], base ticks from the beginning of the control tick
  std::int8_t first_sign = 1;               ///< +1 or -1, direction of the first pulse
  /// pulse indices at which the direction flips; empty in almost every tick
  std::vector<std::uint16_t> reversals;
  AxisCommand command;

  std::size_t count() const { return offset_ticks.size(); }
  /// Calls f(offset_ticks, sign) for each pulse in order.
  template <class F>
  void for_each(F&& f) const {
    int sign = first_sign;
    std::size_t next = 0;
    for (std::size_t i = 0; i < offset_ticks.size(); ++i) {
      if (next < reversals.size() && reversals[next] == i) {
        sign = -sign;
        ++next;
      }
      f(offset_ticks[i], sign);
    }
  }
  /// Sum of the signs: the steps the axis moved in this tick.
  Steps net_steps() const {
    const auto n = static_cast<std::int64_t>(offset_ticks.size());
    if (reversals.empty()) return {first_sign * n};
    Steps net;
    for_each([&](std::uint16_t, int sign) { net.value += sign; });
    return net;
  }
  void clear() {
    offset_ticks.clear();
    reversals.clear();
    first_sign = 1;
  }
};

/// All step pulses of one control tick, axis by axis; made by the interpolator, read by plant and log.
/// Per axis the running sum of net_steps() equals the commanded steps at the tick's end. Storage is reused.
struct StepBatch {
  ControlTicks tick;             ///< number of the control tick; it begins at base tick tick * tau
  std::vector<AxisPulses> axis;  ///< [machine axes]
};

}  // namespace kadr
