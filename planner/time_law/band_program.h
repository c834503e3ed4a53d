#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "planner/time_law/problem.h"

namespace kadr::planner {

/// A limit on three neighbouring unknowns: a[0] x_node + a[1] x_(node+1) + a[2] x_(node+2) <= bound.
struct BandRow {
  std::uint32_t node = 0;
  std::array<double, 3> a{};
  double bound = 1;
};

/// min J(x) over the squared speeds x under rows; x of both ends is given. J is convex, its Hessian tridiagonal.
struct BandProgram {
  std::vector<double> ds_u;    // [nodes], of the interval that ends at a node
  std::vector<double> weight;  // [nodes], of (x_i - x_(i-1))^2
  std::vector<double> cap;     // [nodes], highest x
  std::vector<BandRow> rows;   // every one that can matter, caps among them
  double unit_u2_s2 = 1;       ///< unit of x
};

/// J of a problem and the caps of its nodes as a program without rows; x counts in the highest cap's square.
BandProgram cost_program(const LawProblem& problem, const std::vector<NodeCap>& caps);
/// Adds a row unless the caps already imply it.
/// @return whether it was added
bool add_row(BandProgram& program, const BandRow& row);
/// Origin of a row: accel_rows() and its side.
struct RowOrigin {
  std::size_t row;
  bool upper;
};
/// Adds both sides of every acceleration row that can matter. @return their origins, in order
std::vector<RowOrigin> add_accel_rows(BandProgram& program, const AccelRows& rows);
/// Adds x <= cap of every inner node.
void add_caps(BandProgram& program);

struct BandOptimum {
  std::vector<double> x;            // [nodes]
  std::vector<double> multipliers;  // [rows], s
  double cost_s = 0;
  double bound_s = 0;  ///< J is not below it
  std::uint32_t steps = 0;
  bool converged = false;  ///< if not, x and multipliers are those of the highest bound
};

struct BandOptions {
  double relative_gap = 1e-8;
  double broken = 1e-10;  ///< by how much a row may be, of its bound
  std::uint32_t most_steps = 200;
  std::function<void(std::uint32_t)> each_step;  ///< called with the number of steps done
};

/// Primal-dual interior point with predictor and corrector (Mehrotra); x need not keep the rows on the way.
/// Memory is linear in nodes and rows.
/// @param x  to begin with, > 0 inside; at the ends as given
BandOptimum solve(const BandProgram& program, std::vector<double> x, const BandOptions& options = {});

}  // namespace kadr::planner
