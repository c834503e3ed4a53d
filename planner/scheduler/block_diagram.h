#pragma once
#include <cstdint>
#include <vector>

#include "machine/choices.h"
#include "planner/limits/ramp.h"

namespace kadr::planner {

/// Feed of one block over time, acceleration zero at both ends (paper 003, section 1.1, Fig. 1):
///
///   F_HK        ________
///              /        \      entry -> main, hold, main -> end;   main >= entry, main >= end
///   F_KK,i-1  /          \ F_KK,i
///
/// A block that only brakes or only accelerates lacks the other parts.
struct BlockDiagram {
  double length_u = 0;      ///< > 0
  RampLimits limits{0, 0};  ///< of its ramps
  double entry_u_s = 0;     ///< F_KK of the block before
  double main_u_s = 0;      ///< F_HK
  double end_u_s = 0;       ///< F_KK
  double brake_factor = 1;  ///< the ramp main -> end lasts that many times its shortest (rule b), >= 1
  double kl = 1;            ///< factor on every speed (eq. 3), 0 < kl <= 1
  std::int64_t ticks = 0;   ///< control ticks that it fills; 0: as long as it takes
  TickRule rule = TickRule::none;

  /// Time without kl: T = T(main - entry) + T(main - end) brake_factor + (length - S - S) / main.
  double time_s() const;
};

/// Makes a block last a whole number m of control ticks, m tau >= T (paper 003, eq. 2).
///
/// `exact`: the first of these that works; with a to c the length is exact and kl = 1.
///   a  lower F_HK, not below either end: T(F_HK) falls strictly, so a bisection finds m tau
///   b  a block that only brakes: hold entry for t_c, then brake for T_r, with t_c + T_r = m tau and
///      T_r = 2 (entry m tau - L) / (entry - end), if T_r <= m tau
///   c  lower F_KK, not below the exit with the longest braking path: from there on a lower exit needs less
///      path, and exits between would no longer fit (lowest_exit_u_s)
///   d  eq. 3-4, the part of a tick that is left being spent at F_KK:  kl = L / (L + F_KK (m tau - T)).
///      Both ends are scaled too, so the feed jumps there. At F_KK = 0 the block rests, and nothing jumps.
/// `kl`: rule d for every block, as the paper has it.
void fill_block_ticks(BlockDiagram& block, double tau_s, machine::BlockTicks how);

/// Lowest end speed of a block that enters with v0, such that this and every speed up to v0 can be braked to
/// within the distance, acceleration zero at both ends.
///
/// With a jerk limit the braking path S(v0 -> v1) is longest at some v1 > 0: at v1 = v0/3 while the ramp does
/// not reach a, else at a^2/2j. Below that exits may fit again; the search stops there. A quintic ramp's path
/// is longest at v0/3 while it does not reach a, and grows again beyond a drop that does.
/// @return within 1e-15 v0 of the exact value, [0, v0]
double lowest_exit_u_s(double v0_u_s, double distance_u, RampLimits limits);

/// Limits of the speeds of a block, for its pieces.
struct BlockReasons {
  Signature up, hold, down;
};

/// Elements of a block that begins at s, kl applied; the rest at the end of a block that stops early is not
/// among them.
/// @return factor on all times (1 up to rounding) with which they last ticks * tau_s minus that rest
double append_elements(const BlockDiagram& block, double s_u, double tau_s, const BlockReasons& why,
                       std::vector<Element>& out);

}  // namespace kadr::planner
