// The step for a number of lanes; included by one file per instruction set, which defines KADR_DP_LANES and
// KADR_DP_STEP. Nothing of the standard library: an inline function compiled here for a newer processor must
// not become the one that the rest of the program calls.
#include "planner/time_law/dp_step.h"

// NOLINTBEGIN(misc-definitions-in-headers): a body, included once per instruction set

namespace kadr::planner {
namespace {

constexpr std::int32_t kLanes = KADR_DP_LANES;
using Lanes = double __attribute__((vector_size(kLanes * 8)));

constexpr double kLevelSlack = 1e-9;  ///< of a level's number: rounding of its square root

inline Lanes all(double v) {
  Lanes out{};
  for (std::int32_t q = 0; q < kLanes; ++q) out[q] = v;
  return out;
}
/// Any place in an array: lanes need no alignment.
inline Lanes load(const double* p) {
  Lanes out;
  __builtin_memcpy(&out, p, sizeof out);
  return out;
}
inline void store(double* p, const Lanes& lanes) { __builtin_memcpy(p, &lanes, sizeof lanes); }

/// Squares of v_k between which every limit holds, for all j.
inline void admissible_squares(const DpStep& d) {
  for (std::int32_t j = 0; j < d.count; j += kLanes) {
    const Lanes x = load(d.square + j);
    Lanes least = all(0.0), most = all(1e30);
    for (std::int32_t r = 0; r < d.rows; ++r) {
      const double b = d.row_before[r], a = d.row_after[r];
      const double size = b < 0.0 ? -b : b;
      if (size < 1e-16) {  // x_k has no part in it
        const Lanes w = all(a) * x, limit = all(1.0 + kDpTolerance);
        most = ((w > limit) | (w < -limit)) ? all(-1.0) : most;
        continue;
      }
      const Lanes half = all((1.0 + kDpTolerance) / size), w = all(a / b) * x;
      const Lanes low = -half - w, high = half - w;
      least = low > least ? low : least;
      most = high < most ? high : most;
    }
    store(d.least_square + j, least);
    store(d.most_square + j, most);
  }
}

/// Numbers of the levels k between these squares.
inline void admissible_levels(const DpStep& d) {
  if (d.before_count == 1) {
    const double x = d.before_square[0];
    for (std::int32_t j = 0; j < d.count; ++j) {
      d.first[j] = 0;
      d.last[j] = d.most_square[j] >= x * (1.0 - 1e-12) && d.least_square[j] <= x * (1.0 + 1e-12) ? 0 : -1;
    }
    return;
  }
  const double per_low = 1.0 / d.before_step_low;
  const double per_high = d.before_step_high > 0.0 ? 1.0 / d.before_step_high : per_low;
  const double kept = static_cast<double>(d.before_lower - 1);
  const double first = d.before_first, last = d.before_last;
  for (std::int32_t j = 0; j < d.count; ++j) {
    const double most = d.most_square[j] > 0.0 ? d.most_square[j] : 0.0;
    const double low = __builtin_sqrt(d.least_square[j]), high = __builtin_sqrt(most);
    double k =
        low <= d.before_kept ? (low - d.before_low) * per_low : kept + (low - d.before_kept) * per_high;
    double n =
        high <= d.before_kept ? (high - d.before_low) * per_low : kept + (high - d.before_kept) * per_high;
    k -= kLevelSlack;
    k = k > first ? k : first;
    k = k < 1e6 ? k : 1e6;
    n += kLevelSlack;
    n = n < last ? n : last;
    n = n > -1.0 ? n : -1.0;
    n = d.most_square[j] < 0.0 || d.least_square[j] > d.most_square[j] ? -1.0 : n;
    const std::int32_t whole = static_cast<std::int32_t>(k);
    d.first[j] = static_cast<double>(whole) < k ? whole + 1 : whole;
    d.last[j] = n < 0.0 ? -1 : static_cast<std::int32_t>(n);
  }
}

inline double least_cost(const DpStep& d, std::int32_t j) {
  const std::int32_t first = d.first[j], last = d.last[j];
  const Lanes vj = all(d.speed[j]), xj = all(d.square[j]), twice_ds = all(d.twice_ds),
              weight = all(d.square_weight);
  const auto costs = [&](std::int32_t k) {
    const Lanes x = xj - load(d.before_square + k);
    return load(d.before_cost + k) + twice_ds / (load(d.before_speed + k) + vj) + weight * x * x;
  };
  Lanes best = all(kDpInfeasible);
  std::int32_t k = first;
  for (; k + kLanes - 1 <= last; k += kLanes) {
    const Lanes c = costs(k);
    best = c < best ? c : best;
  }
  if (k <= last) {
    Lanes c = costs(k);
    for (std::int32_t q = last - k + 1; q < kLanes; ++q) c[q] = kDpInfeasible;
    best = c < best ? c : best;
  }
  double least = best[0];
  for (std::int32_t q = 1; q < kLanes; ++q) least = best[q] < least ? best[q] : least;
  return least;
}

}  // namespace

std::uint64_t KADR_DP_STEP(const DpStep& d) {
  admissible_squares(d);
  admissible_levels(d);
  std::uint64_t looked_at = 0;
  for (std::int32_t j = 0; j < d.count; ++j) {
    d.cost[j] = kDpInfeasible;
    if (d.first[j] > d.last[j]) continue;
    looked_at += static_cast<std::uint64_t>(d.last[j] - d.first[j] + 1);
    d.cost[j] = least_cost(d, j);
  }
  return looked_at;
}

}  // namespace kadr::planner
// NOLINTEND(misc-definitions-in-headers)
