#pragma once
#include <cstdint>
#include <vector>

#include "planner/time_law/solver.h"

namespace kadr::planner {

/// The limit of a law at a node: the first one that it reaches.
struct ActiveLimit {
  enum class Kind : std::uint8_t {
    none,
    speed,              ///< the node's cap; `of` is its NodeCap::reason
    path_acceleration,  ///< in the interval that ends at the node
    axis_acceleration   ///< `of` is the axis
  };
  Kind kind = Kind::none;
  std::int32_t of = 0;
  bool operator==(const ActiveLimit&) const = default;
};

/// Looks at every node but the first: its speed, else the acceleration that comes nearest to its limit in the
/// interval behind it.
/// @param within  relative distance from a limit that counts as reached
/// @return [nodes - 1]
std::vector<ActiveLimit> active_limits(const LawProblem& problem, const std::vector<double>& speed_u_s,
                                       double within = 1e-6);

}  // namespace kadr::planner
