#pragma once
#include <cstdint>

namespace kadr::planner {

/// Arrays of one step of the dynamic programme, from the levels k of one node to the levels j of the next.
/// All arrays may be read and written up to the next multiple of kDpLanes behind their count.
struct DpStep {
  // levels of the node before
  std::int32_t before_count;
  const double* before_speed;  // [k]
  const double* before_square;
  const double* before_cost;               // [k], kDpInfeasible where a level can't be reached
  std::int32_t before_first, before_last;  ///< first and last level that can be
  std::int32_t before_lower;               ///< as LevelRange
  double before_low, before_kept, before_step_low, before_step_high;
  // levels of this node
  std::int32_t count;
  const double* speed;  // [j]
  const double* square;
  // the interval
  std::int32_t rows;
  const double* row_before;  // |row_before x_k + row_after x_j| <= 1
  const double* row_after;
  double twice_ds;
  double square_weight;  ///< of (x_j - x_k)^2 in the cost
  // scratch [j]
  double* least_square;
  double* most_square;
  // out [j]
  double* cost;         // least cost to reach level j, kDpInfeasible where it can't be
  std::int32_t* first;  // admissible k: [first, last], empty if first > last
  std::int32_t* last;
};

constexpr double kDpInfeasible = 1e300;
constexpr std::int32_t kDpLanes = 8;   ///< arrays are padded to a multiple of it
constexpr double kDpTolerance = 1e-9;  ///< relative, of acceleration limits

/// For a level j every limit is linear in x_k = v_k^2, so the admissible k are one interval:
///   max_r (-1/|b_r| - (a_r/b_r) x_j) <= x_k <= min_r (1/|b_r| - (a_r/b_r) x_j);
/// the cost is the least of cost_k + 2 ds/(v_k + v_j) + w (x_j - x_k)^2 in it. Variants differ in lanes alone
/// and give the same bits: no fused operations, each element on its own, the least of them exact.
/// @return number of transitions evaluated
std::uint64_t dp_step_sse2(const DpStep& step);
std::uint64_t dp_step_avx2(const DpStep& step);  ///< on processors that have AVX2
using DpStepFunction = std::uint64_t (*)(const DpStep&);
/// The widest that this processor has.
DpStepFunction dp_step_function();

}  // namespace kadr::planner
