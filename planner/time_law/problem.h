#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine/base/vocabulary.h"
#include "machine/infinity.h"

namespace kadr::planner {

/// A technological limit of speed (paper 000, TT): on a part of the path, or at one point of it.
struct SpeedZone {
  double begin_u = 0;
  double end_u = 0;  ///< >= begin_u
  double speed_u_s = 0;
};

/// Which nodes of an interval have their axes' acceleration limited (paper 000, printed: its end).
enum class AccelTest : std::uint8_t {
  end_node,   ///< as printed; between nodes a limit may be exceeded by some per cent
  both_nodes  ///< for machines
};
inline constexpr Vocabulary<AccelTest, 2> kAccelTests{{
    {AccelTest::end_node, "end_node", "as printed"},
    {AccelTest::both_nodes, "both_nodes", "for machines"},
}};
static_assert(kAccelTests.complete());

/// Weight of the penalty on acceleration in J = sum dt + w (axes |a|)^2.
struct Penalty {
  double weight_s5_u2 = 0.5e-11;
  bool per_length = false;  ///< w ds/(length/892) instead of w: finer nodes do not change the problem
};

/// How fast along a path whose axes are given by their derivatives? s_0 < s_1 < ... are the nodes; between
/// them the squared speed is linear in s, so that acceleration is constant and
///   dt = 2 ds/(v0 + v1),   a = (v1^2 - v0^2)/(2 ds).
/// Limits: |X'_c| v <= V_c, |X'_c a + X''_c v^2| <= A_c, v <= path_feed, |a| <= path_accel, zones.
struct LawProblem {
  std::size_t axes = 0;
  std::vector<double> s_u;             // [nodes], >= 3, strictly ascending
  std::vector<double> slope;           // [nodes][axes], X' in axis units per path unit
  std::vector<double> curvature;       // [nodes][axes], X''
  std::vector<double> max_feed_u_s;    // [axes], > 0
  std::vector<double> max_accel_u_s2;  // [axes], > 0
  double path_feed_u_s = machine::kInfinity;
  double path_accel_u_s2 = machine::kInfinity;
  double begin_u_s = 0;  ///< speed at the first node, exactly
  double end_u_s = 0;    ///< and at the last
  std::vector<SpeedZone> zones;
  // where X' or X'' jump, as at a corner: their values behind each node; empty: the same
  std::vector<double> slope_behind, curvature_behind;  // [nodes][axes]
  std::vector<double> cap_u_s;                         // [nodes], further speed limits of nodes; empty: none
  std::vector<double>
      interval_accel_u_s2;  // [nodes], of |a| in the interval that ends at a node; empty: none
  AccelTest accel_test = AccelTest::both_nodes;
  Penalty penalty;

  std::size_t nodes() const { return s_u.size(); }
  double length_u() const { return s_u.back() - s_u.front(); }
  double ds_u(std::size_t interval) const { return s_u[interval] - s_u[interval - 1]; }
  /// X' and X'' of all axes at a node, and just behind it.
  const double* slopes(std::size_t node) const { return &slope[node * axes]; }
  const double* curvatures(std::size_t node) const { return &curvature[node * axes]; }
  const double* slopes_behind(std::size_t node) const {
    return slope_behind.empty() ? slopes(node) : &slope_behind[node * axes];
  }
  const double* curvatures_behind(std::size_t node) const {
    return curvature_behind.empty() ? curvatures(node) : &curvature_behind[node * axes];
  }
  /// Highest |a| of an interval.
  double accel_limit_u_s2(std::size_t interval) const {
    return interval_accel_u_s2.empty() ? path_accel_u_s2
                                       : std::min(path_accel_u_s2, interval_accel_u_s2[interval]);
  }
  /// Factor on a^2 in the cost of an interval, s^5/u^2.
  double penalty_weight(std::size_t interval) const;
};

/// Why a problem has no solution, and where.
struct LawFailure {
  std::size_t node = 0;
  double s_u = 0;
  std::string reason;  ///< "no speed at this node ...", with measured and allowed values
};

/// What a problem must keep to be one: shapes, ascending nodes, positive finite limits. First broken one.
std::optional<LawFailure> check_problem(const LawProblem& problem);

/// Highest speed of a node, and what holds it there.
struct NodeCap {
  static constexpr std::int32_t kPathFeed = -1, kZone = -2, kGiven = -3;  ///< kGiven: of cap_u_s
  double speed_u_s = 0;
  std::int32_t reason = kPathFeed;  ///< an axis >= 0, or one of the constants
};

/// Caps of all nodes, s_max of paper 000: axis speeds, path feed, zones (a zone binds every node within it
/// and the two that bracket it).
std::vector<NodeCap> node_caps(const LawProblem& problem);

/// Acceleration limits of all intervals as rows |before x_(i-1) + after x_i| <= 1 of the squared speeds.
struct AccelRows {
  std::size_t per_interval = 0;
  std::vector<double> before;  // [nodes][per_interval], interval i ends at node i; none for node 0
  std::vector<double> after;
};
AccelRows accel_rows(const LawProblem& problem);

}  // namespace kadr::planner
