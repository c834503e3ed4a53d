#pragma once
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "planner/laws/feed_plan.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::planner {

class Joints;
class Path;

/// One broken limit found by verify().
struct Violation {
  std::string what;  ///< "axis speed", "junction", "continuity", "length", ...
  double time_s = 0;
  std::uint32_t segment = 0;
  int axis = -1;
  double value = 0;
  double limit = 0;
};

struct VerifyOptions {
  double relative_tolerance = 1e-9;
  double sample_s = 1e-3;  ///< besides every piece end, joint and extreme of a piece; infinite: none besides
  std::size_t most = 20;   ///< stop after that many
  int parts = 10;          ///< of every arc and curve, between which the limits are looked at
  int quadrants = 1'000'000'000;  ///< of an arc in a piece, at whose ends the limits are looked at
  int chords = 256;               ///< of every curve, whose sum is compared with its length

  /// Whether the law may be at rest at its pauses alone. A run under an override also stands wherever that is 0.
  bool stands_at_pauses_alone = true;
  /// Whether acceleration, jerk and centripetal acceleration are looked at on curves that turn back.
  bool curves_that_turn_back = true;

  /// Paths of at most so many segments are looked at wholly. Of longer ones the limits, the corners, the
  /// shapes of curves and the table's places are looked at on the first `window` of every `stride` segments
  /// and on the last `window`; everything else on the whole path.
  std::size_t whole_up_to = std::numeric_limits<std::size_t>::max();
  std::size_t window = 16, stride = 256;
};

/// What prepare() asks of every plan: cheap enough to be always on (docs/pipeline.md says what it looks at).
VerifyOptions production_check();

/// Independent check of any planner's output against path and machine alone; it shares no code with the
/// planners (caps, junction rule and ramps are computed again from the definitions). What the joints do at a
/// place is asked of Joints, place by place; their bounds over segments, by which planners cap, are not used.
/// Axis limits are limits of joints, and Violation::axis is the joint. Checks, at every piece end, joint of
/// segments, inner extreme and sample: s and speed continuous (acceleration too where jerk is limited, jerk
/// too with quintic ramps), speed >= 0, path and axis speed, axis acceleration and jerk (normal and
/// tangential parts together on arcs), centripetal acceleration, programmed feed, junction step per axis,
/// rest at the ends and at every stop, total length, whole ticks where asked. Laws of paper 000 promise no
/// jerk (PlannerSettings::keeps_jerk): theirs is not looked at. Of a plan block by block also: whole ticks
/// and acceleration zero at every block end, and a jump of speed there only if the table states it and kl
/// explains it.
/// @param pauses  that plan() was asked for: the law stands there so long, and nowhere else
std::vector<Violation> verify(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                              const VerifyOptions& options = {}, std::span<const Pause> pauses = {});
/// The same for other joints than the machine's own (machine_joints).
std::vector<Violation> verify(const Joints& joints, const FeedPlan& plan,
                              const machine::MachineModel& machine, const VerifyOptions& options = {},
                              std::span<const Pause> pauses = {});

}  // namespace kadr::planner
