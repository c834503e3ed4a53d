#include "emulator/answers/travel.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/path.h"

namespace kadr::answers {

namespace {
constexpr std::size_t kCurveChords = 16;
}

std::vector<AxisTravel> axis_travel(const planner::Path& path) {
  const auto axes = static_cast<std::size_t>(path.axes());
  std::vector<AxisTravel> travel(axes);
  if (path.size() == 0) return travel;
  for (std::size_t a = 0; a < axes; ++a) travel[a].min_u = travel[a].max_u = path.node(0)[a];

  std::vector<double> from_u(axes), to_u(axes);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const planner::PathSegment& segment = path.segments[i];
    const bool arc = segment.kind == planner::SegmentKind::arc;
    for (std::size_t a = 0; a < axes; ++a) {
      const auto [low_u, high_u] = planner::axis_extent(path, i, static_cast<int>(a));
      travel[a].min_u = std::min(travel[a].min_u, low_u);
      travel[a].max_u = std::max(travel[a].max_u, high_u);
    }

    // chords of a sixteenth turn lose at most 1 - cos(pi/16) of the distance at each turning point
    std::size_t chords = 1;
    if (arc) {
      const double sweep_rad = std::fabs(path.arc_of(i).sweep_rad);
      chords = static_cast<std::size_t>(std::min(sweep_rad / (kPi / 8), 1e6)) + 1;
    } else if (segment.kind == planner::SegmentKind::curve) {
      chords = kCurveChords;
    }
    const auto begin = path.node(i);
    std::copy(begin.begin(), begin.end(), from_u.begin());
    for (std::size_t chord = 1; chord <= chords; ++chord) {
      if (chord < chords) {
        const double part = static_cast<double>(chord) / static_cast<double>(chords);
        planner::eval_position(path, i, segment.length_u * part, to_u);
      } else {
        const auto end = path.node(i + 1);
        std::copy(end.begin(), end.end(), to_u.begin());
      }
      for (std::size_t a = 0; a < axes; ++a) {
        const double way_u = std::fabs(to_u[a] - from_u[a]);
        travel[a].travel_u += way_u;
      }
      from_u.swap(to_u);
    }
  }
  return travel;
}

std::int64_t estimate_pulses(const std::vector<AxisTravel>& travel, const machine::MachineModel& machine) {
  double pulses = 0;
  for (std::size_t a = 0; a < travel.size(); ++a) pulses += travel[a].travel_u / machine.axis[a].step_u;
  return static_cast<std::int64_t>(std::min(pulses, 9e18));
}

const char* segment_unit(const planner::Path& path, std::size_t segment,
                         const machine::MachineModel& machine) {
  if (path.segments[segment].kind == planner::SegmentKind::arc) return "mm";
  const auto begin = path.node(segment), end = path.node(segment + 1);
  for (std::size_t a = 0; a < begin.size(); ++a)
    if (begin[a] != end[a] && machine.axis[a].kind == machine::AxisKind::linear) return "mm";
  return "deg";
}

std::string path_unit(const planner::Path& path, const machine::MachineModel& machine) {
  const std::size_t begin = path.approach_size();
  bool linear = path.size() == begin, rotary = false;
  for (std::size_t i = begin; i < path.size() && !(linear && rotary); ++i)
    (segment_unit(path, i, machine)[0] == 'm' ? linear : rotary) = true;
  return !rotary ? "mm" : !linear ? "deg" : "mm+deg";
}

}  // namespace kadr::answers
