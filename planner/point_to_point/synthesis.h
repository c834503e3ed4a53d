#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "planner/point_to_point/law.h"
#include "planner/point_to_point/residual.h"
#include "planner/point_to_point/work.h"

namespace kadr::planner {

/// How far, and how fast it may be.
struct PointTask {
  double distance_u = 0;        ///< > 0
  double speed_limit_u_s = 0;   ///< > 0
  double accel_limit_u_s2 = 0;  ///< > 0
};

/// Why there is no law, with the measured and the allowed value.
struct PointFault {
  enum class Kind : std::uint8_t {
    not_positive,  ///< a quantity that has to be a finite number above zero
    bad_damping,   ///< zeta outside 0 <= zeta < 1
    too_short,     ///< no law of this kind is as fast as the time asks for; allowed: the shortest time
    bad_share,     ///< outside of its range; allowed: the nearer end of it
    too_fine,      ///< more zeros or frequencies than can be examined (1e5)
  };
  Kind kind;
  std::string what;  ///< "distance", "time of ZV on T", ...
  double measured = 0, allowed = 0;
  std::string unit;
};
template <class T>
using PointResult = tl::expected<T, PointFault>;

/// Finite and in range, or the first quantity that is not.
PointResult<void> check(const PointTask& task);
PointResult<void> check(const Mode& mode);
PointResult<void> check(const Load& load);

/// Shortest time of any law within both limits (bang_bang_law()).
double shortest_time_s(const PointTask& task);

/// D1 of eq. 4 as an interval of xi, D = duration:
///   (1 - sqrt(1 - 4 d/(a D^2)))/2 <= xi <= min(1/2, 1 - d/(v D))
/// Empty (low > high) if the time is too short; shorter by rounding alone, it is the fastest law's.
struct XiRange {
  double low = 0, high = 0;
  bool empty() const { return low > high; }
  bool has(double xi) const;  ///< within rounding
};
XiRange xi_range(const PointTask& task, double duration_s);

/// A zero of the residual vibration of an undamped mode: whole periods in the ramp (n) or in what is left of
/// the motion (m) (eq. 14).
enum class ZeroBranch : std::uint8_t { ramp, rest };
struct ZeroLaw {
  ZeroBranch branch = ZeroBranch::ramp;
  int count = 0;  ///< n or m
  double xi = 0;
  double energy_J = 0;
};
/// All xi of D1 without residual vibration, by ascending energy; equal ones (to 1e-12) by copper loss, which
/// is least at xi = 1/3.
PointResult<std::vector<ZeroLaw>> zero_laws(const PointTask& task, double duration_s, const Mode& mode,
                                            const Load& load);

/// Result of a synthesis.
struct TChoice {
  double xi = 0;
  std::optional<ZeroLaw> zero;  ///< if it is one, exactly
  int periods = 0;              ///< whole periods nearest to the ramp
  double amplitude_u = 0;
  double energy_J = 0;
};
/// T law of a given time: without damping the zero of least energy, by enumeration; with damping, or if D1
/// has no zero, the least amplitude, by a grid of 24 points a period and Brent's search at each minimum.
PointResult<TChoice> best_t_law(const PointTask& task, double duration_s, const DrivenMode& driven,
                                const Load& load);

/// The shortest T law without residual vibration (undamped), of the candidates
///   (i)  ta = n T,  tf = ta + max(d/(A ta), d/V, ta)   convex in ta, least at min(V/A, sqrt(d/A)):
///        n is one of the two whole numbers beside it
///   (ii) tf - ta = m T,  ta = d/(A m T)                m the least with both d/V and sqrt(d/A) <= m T
struct FastZero {
  ZeroBranch branch = ZeroBranch::ramp;
  int count = 0;
  double ramp_s = 0, shift_s = 0;  ///< ta and tf - ta
  double duration_s() const { return ramp_s + shift_s; }
  PointLaw law(double distance_u) const;
};
FastZero fastest_zero_law(const PointTask& task, const Mode& mode);

/// The double zero of least time: n <= m, n m >= d/(A T^2), m >= d/(V T).
struct DoubleZero {
  int ramp = 0, shift = 0;
};
DoubleZero fastest_double_zero(const PointTask& task, const Mode& mode);

/// A T law whose ramps are whole periods of their own, n1 and n2: silent too.
struct AsymmetricPick {
  int up = 0, down = 0;
  PointLaw law;
  double worst_u = 0;  ///< largest amplitude in the band
};
/// Of all such laws of a given time the one that leaves least if the frequency is off by up to `band`; by
/// trying all pairs. Nothing if none is feasible, or with more than 200 periods in the motion.
std::optional<AsymmetricPick> robust_asymmetric_law(const PointTask& task, double duration_s,
                                                    const DrivenMode& driven, double band);

/// The double zero that lasts at least a given time, the next whole number of periods, and has the shortest
/// ramp (and so the least energy); nothing if its limits allow none.
std::optional<DoubleZero> double_zero_of(const PointTask& task, double duration_s, const Mode& mode);

/// T law of a given time with the shortest ramp its limits allow, which has the least energy of all.
PointResult<PointLaw> steepest_t_law(const PointTask& task, double duration_s);

}  // namespace kadr::planner
