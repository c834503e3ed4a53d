#pragma once
#include <span>

#include "machine/choices.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::planner {

/// Factor of an axis limiter on a feed (paper 003, section 5).
struct LimitedFeed {
  double factor = 1.0;  ///< K_max = min over the axes of K_j (eq. 11), in (0, 1]
  int axis = -1;        ///< that it comes from, -1: none
};

/// K_j of one axis whose share of the feed is f = |e_j| F, with F_max its highest speed and d the band, or F_max if
/// that is less:
///   threshold (eq. 10)   K = F_max / f above F_max, else 1
///   paper (eq. 13-16)    K = [F_max - d + (1 - k(x)) D] / f for D = f - F_max + d in [0, 2 d], x = D / (2
///   d),
///                        k = (3 x^2 - 2 x^3) / 2;  1 below,  F_max / f above
///   matched              the same with k = x^2 - x^3 / 2, so that the slope of the limited feed is
///   continuous
///                        at both ends too (docs/papers.md)
double axis_factor(machine::LimiterKind kind, double axis_speed_u_s, double max_u_s, double band_u_s);

/// Of a feed in a direction e = dx/ds [axes].
LimitedFeed limited_feed(const machine::MachineModel& machine, std::span<const double> tangent,
                         double feed_u_s);

}  // namespace kadr::planner
