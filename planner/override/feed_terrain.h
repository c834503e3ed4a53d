#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "planner/limits/limits.h"
#include "planner/limits/ramp.h"
#include "planner/limits/range_min.h"
#include "planner/path/path.h"

namespace kadr::planner {

/// Overrides in force on the path ahead, as ratios: 1 is 100 %.
struct Percent {
  double feed = 1.0;
  double rapid = 1.0;
  double frozen = 1.0;  ///< of moves that keep the override of their beginning
  bool operator==(const Percent&) const = default;
};

/// A place where the feed must be low enough: the next one ahead whose cap is below all caps before it.
struct Valley {
  std::size_t place = 0;
  double s_u = 0;
  double cap_u_s = 0;  ///< under the override
  bool hard = false;   ///< the cap is the machine's or the path's, whatever the override
  /// It can't be left with acceleration 0 for the next valley that can: braking for that one has to be below
  /// the cap here.
  bool tight = false;
};

/// The caps of a path under an override. Hard caps (corners, curvature, axes, stops, moves that no override
/// changes) are separate from the programmed feed (paper 003, eq. 6-8 with the hard part taken out of F_HK):
///   cap = min(hard cap, F p)      a rapid: hard cap * p_rapid
/// A move that runs into one at a fixed feed (a thread) is not slowed below that feed.
class FeedTerrain {
 public:
  /// @param table  caps with the highest override to come; its accelerations are valid up to that
  FeedTerrain(const Path& path, const machine::MachineModel& machine, PathLimitTable table);

  const Path& path() const { return path_; }
  bool proportional() const { return proportional_; }
  /// Cap at a place (limits.h) under an override; 0 at a stop.
  double cap_u_s(std::size_t place, const Percent& percent) const;
  double hard_cap_u_s(std::size_t place) const { return table_.cap_u_s[place]; }
  const Signature& signature(std::size_t place) const { return table_.signature[place]; }
  /// The reason of a segment's cap.
  Signature cap_reason(std::size_t segment, const Percent& percent) const;

  /// No override changes the segment's feed from within it.
  bool locked(std::size_t segment) const { return path_.segments[segment].lock != FeedLock::none; }
  /// Last segment of the run (rest to rest) that segment i belongs to.
  std::size_t run_end(std::size_t segment) const;
  /// Segment at s, at or after a known one before it.
  std::size_t segment_at(double s_u, std::size_t from) const;

  /// Lowest limits over segments [first, last].
  RampLimits limits(std::size_t first, std::size_t last) const;
  /// The same times a factor.
  RampLimits scaled(std::size_t first, std::size_t last, double scale) const;

  /// Valleys ahead of a segment up to `until_u`, each lower than the one before and than `below_u_s`.
  /// @return whether there can be more of them after `until_u`
  bool valleys(std::size_t segment, double below_u_s, double until_u, const Percent& percent,
               std::vector<Valley>& out) const;
  /// Finds the tight valleys, and leaves out those that any braking for the next passes below.
  /// @param scale  factor on the limits
  void thin_out(std::vector<Valley>& valleys, double scale) const;
  /// Length of braking from w to a valley, with the lowest limits on the way.
  double braking_u(double w_u_s, const Valley& valley, double scale, RampLimits& limits) const;

  /// Braking from w for `next` passes a tight valley before it faster than its cap, or
  /// would have to begin before `begin_u`.
  bool passes_above(double w_u_s, double begin_u, const Valley& tight, const Valley& next,
                    double scale) const;

  /// Factor on accelerations and jerks: 1, or in proportional mode the override, as the whole diagram is
  /// multiplied by it (eq. 5); while the speed is still that of a higher one, that one.
  double limit_scale(const Percent& percent, std::size_t segment, double speed_u_s) const;

 private:
  double target_u_s(std::size_t segment, const Percent& percent) const;
  double factor(std::size_t place, const Percent& percent) const;
  /// First place of [from, last] whose cap may be at most that; last + 1: none.
  std::size_t next_at_most(double level_u_s, std::size_t from, std::size_t last,
                           const Percent& percent) const;

  const Path& path_;
  bool proportional_;          ///< every cap is multiplied by the override
  std::array<bool, 3> fixed_;  ///< by FeedLock: no override at all
  PathLimitTable table_;
  std::vector<double> feed_u_s_;        // [segments], inf where no override applies
  std::vector<double> rapid_u_s_;       // [segments], inf except for rapids
  std::vector<double> least_u_s_;       // [segments], feed of the locked move that follows, else 0
  std::vector<std::size_t> stops_;      // joints with cap 0, ascending
  std::vector<std::size_t> lock_ends_;  // joints after threads, ascending
  RangeMin caps_, feeds_, rapids_, accels_, jerks_;
  bool uniform_ = false;
};

}  // namespace kadr::planner
