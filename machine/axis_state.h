#pragma once

namespace kadr {

/// State of one axis of the flexible machine at the end of a control tick, in axis units (mm or deg); made by
/// the plant, read by monitors and log.
struct AxisState {
  double base_u = 0;         ///< x0, absolute machine position
  double base_u_s = 0;       ///< v0
  double link_u = 0;         ///< x1, link relative to base
  double link_u_s = 0;       ///< v1
  double motor_force_N = 0;  ///< N, or N m for a rotary axis
};

}  // namespace kadr
