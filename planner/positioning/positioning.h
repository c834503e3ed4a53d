#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "machine/choices.h"
#include "machine/infinity.h"
#include "planner/laws/feed_plan.h"
#include "planner/limits/limits.h"
#include "planner/point_to_point/law.h"
#include "planner/point_to_point/mode.h"

namespace kadr::machine {
struct MachineModel;
}

namespace kadr::planner {

/// A vibration that a motion along the path excites.
struct ExcitedMode {
  DrivenMode driven;
  int axis = -1;     ///< of the machine
  double share = 0;  ///< |dx/ds|: of the path's acceleration that the axis gets
};

/// Limits along the path, and the vibrations to cancel.
struct PositioningTask {
  double distance_u = 0;
  double speed_u_s = 0;
  double accel_u_s2 = 0;
  double jerk_u_s3 = machine::kInfinity;
  std::span<const ExcitedMode> modes;  ///< most excited first
  machine::RapidShape shape = machine::RapidShape::automatic;
  double uncertainty = 0.01;  ///< relative, of the frequencies: automatic
  double tick_s = 0;          ///< the law lasts a whole number of these; 0: as long as it does
};

/// A law from rest to rest and why it is the one.
struct Positioning {
  PointLaw law;
  machine::RapidShape shape = machine::RapidShape::scurve;  ///< never automatic; scurve: nothing rings
  std::string_view reason;                                  ///< of an automatic choice, else empty
  double loss_s = 0;      ///< over the fastest law within the limits, jerk included
  std::size_t tuned = 0;  ///< modes of the task, from the first, that the law is silent at
};

/// The fastest law of a shape, for several vibrations at once (paper 001, section 4 of whose discussion knows
/// one).
///
///   t-zero  ramps of n periods, or n periods between the ramps' beginnings (eq. 14); two vibrations take one
///           each: ta = n T1, tf - ta = m T2, whichever way round is faster. With damping a longer
///           acceleration leaves just what the deceleration cancels, or, if that has died down, the least
///           (Brent)
///   zv zvd  the fastest law within the limits, convolved with two or three impulses for every vibration
///   auto    t-zero if it is silent, loses less than half a period and the frequency is known to 1/(100 n);
///           else zv if the frequency is known to 1 %, else zvd
///
/// At most kMostTuned vibrations are tuned out; what others leave is residual_u(). A finite jerk limit is
/// kept by averaging over accel/jerk seconds, and so is a whole number of ticks: that leaves zeros where they are.
Positioning plan_positioning(const PositioningTask& task);
inline constexpr std::size_t kMostTuned = 2;

/// Appends the pieces of a law that begins at path length s. They end where the law says: edges that are short
/// beside its duration round what they add up to (up to 1e-9 of the way), and that is shared out.
/// @param why  the limit of the cruising speed
void append_pieces(const PointLaw& law, double s_u, const Signature& why, std::vector<JerkPiece>& out);

/// Amplitude of a mode's vibration after the law, in units of its axis.
double residual_u(const PointLaw& law, const ExcitedMode& mode);

/// Makes the tasks of a machine's rapids; knows the vibrations of its axes.
class PositioningPlanner {
 public:
  explicit PositioningPlanner(const machine::MachineModel& machine);
  /// @param speed_u_s ...  limits along the segment (PathLimitTable)
  Positioning plan(const Path& path, std::size_t segment, double speed_u_s, double accel_u_s2,
                   double jerk_u_s3);
  /// Vibrations that a segment excites, most excited first; valid until the next call.
  std::span<const ExcitedMode> excited(const Path& path, std::size_t segment);

 private:
  const machine::MachineModel& machine_;
  std::vector<std::vector<DrivenMode>> modes_;  // [axes]
  std::vector<ExcitedMode> excited_;
};

}  // namespace kadr::planner
