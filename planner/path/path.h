#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "gcode/block_kind.h"
#include "machine/base/diagnostic.h"
#include "machine/infinity.h"
#include "planner/bezier/path_curve.h"

namespace kadr::machine {
struct MachineModel;
}

/// The tool path: segments in the machine's n axes, joined end to end. Geometry only; timing is elsewhere, and
/// how the joints move along it is in joints.h.
///
/// Path length s: one metric for all segments, s = sqrt(sum of squares over the machine's axes), mm and deg
/// counted alike, so that axis speeds stay continuous where s does (arc: radius * angle in the plane,
/// combined with the linear motion of all other axes). For a program that moves X Y Z only it is the length
/// in mm. Suffix `_u`.
namespace kadr::planner {

enum class SegmentKind : std::uint8_t { line, arc, curve };

/// Why the operator's override does not apply on a segment.
enum class FeedLock : std::uint8_t {
  none,
  thread,    ///< in step with the spindle: G33, G33.1
  disabled,  ///< M49, M50 P0, and codes that switch the override off themselves
};

/// Circle in a plane of two machine axes; the other axes move linearly with the angle (helix).
/// The radius runs linearly with the angle from radius_begin to radius_end (equal except for rounding of the
/// program):
///   p_first(phi)  = center_first  + r(phi) cos(phi),   p_second(phi) = center_second + r(phi) sin(phi)
///   phi = angle_begin + sweep * u,  r = radius_begin + (radius_end - radius_begin) * u,  u = s/length in [0, 1]
struct ArcShape {
  int first_axis = 0;  ///< machine axis index
  int second_axis = 1;
  double center_first_u = 0;
  double center_second_u = 0;
  double radius_begin_u = 0;
  double radius_end_u = 0;
  double angle_begin_rad = 0;
  double sweep_rad = 0;  ///< signed, > 0 from first to second axis; several turns possible
};

/// Geometry of a segment that is not a straight line.
using SegmentShape = std::variant<std::monostate, ArcShape, PathCurve>;

/// One piece of path. Its end points are Path::node(i) and Path::node(i + 1).
struct PathSegment {
  SegmentKind kind = SegmentKind::line;
  bool rapid = false;
  bool stop_at_end = false;  ///< exact stop (G61.1) or a stop requested by the program
  FeedLock lock = FeedLock::none;
  bool path_limits = false;                           ///< feed_length_u is of X Y Z: PathLimits apply to it
  gcode::BlockKind made_by = gcode::BlockKind::feed;  ///< kind of motion in the program
  std::int32_t shape = -1;  ///< arc: index into Path::arcs; curve: into Path::curves
  std::uint32_t block = 0;  ///< running number of the motion block; a spline has many segments, a tap two
  Span span;
  double length_u = 0;                          ///< > 0
  double begin_limit_u_s = machine::kInfinity;  ///< of the speed where it begins: a technology point
  double feed_length_u = 0;  ///< the length that the programmed feed measures (gcode::FeedLength), mm or deg
  /// programmed speed of s (already converted by length_u / feed_length_u); inf for a rapid
  double feed_u_s = 0;
};

/// Effect of G64 P on a path.
struct Smoothing {
  std::size_t corners = 0;                               ///< rounded (RoundedCorner)
  std::size_t curves = 0;                                ///< dense lines that became curves (PointFit)
  double corner_deviation_u = 0, curve_deviation_u = 0;  ///< largest, from the programmed lines
};

class Path {
 public:
  explicit Path(int axes) : axes_(axes) {}
  int axes() const { return axes_; }
  std::size_t size() const { return segments.size(); }
  /// Joint i between segment i-1 and i; node(0) is the start, node(size()) the end. [axes]
  std::span<const double> node(std::size_t i) const {
    return {nodes_u.data() + i * static_cast<std::size_t>(axes_), static_cast<std::size_t>(axes_)};
  }
  double length_u() const { return start_s_u.empty() ? 0.0 : start_s_u.back(); }
  /// Segments of the approach to the line where the program is entered: the first ones. 0: it is run from its beginning.
  std::size_t approach_size() const {
    std::size_t i = 0;
    while (i < segments.size() && segments[i].made_by == gcode::BlockKind::approach) ++i;
    return i;
  }
  /// Path length at which the program's own path begins, behind the approach.
  double program_begin_u() const { return start_s_u.empty() ? 0.0 : start_s_u[approach_size()]; }
  /// One past the last segment of the block that segment i belongs to.
  std::size_t block_end(std::size_t i) const {
    const std::uint32_t block = segments[i].block;
    while (i < segments.size() && segments[i].block == block) ++i;
    return i;
  }

  /// @pre the segment is an arc; a curve
  const ArcShape& arc_of(std::size_t i) const { return arcs[static_cast<std::size_t>(segments[i].shape)]; }
  const PathCurve& curve_of(std::size_t i) const {
    return curves[static_cast<std::size_t>(segments[i].shape)];
  }

  /// The segments from i on; s still counts from the whole path's beginning.
  Path tail(std::size_t i) const;

  std::vector<PathSegment> segments;
  std::vector<ArcShape> arcs;
  std::vector<PathCurve> curves;
  std::vector<double> nodes_u;    ///< [(segments + 1) * axes], made by build_path
  std::vector<double> start_s_u;  ///< [segments + 1], path length at each joint; first is 0
  Smoothing smoothing;
  std::vector<Diagnostic> faults;  ///< moves this machine can't make; plan() refuses with the first

 private:
  int axes_;
};

/// Name of a segment's block in logs and tables: "rapid", "line", "arc", "spline", "probe", "tap".
std::string_view motion_name(const PathSegment& segment);
/// Position on a segment at local length s in [0, length]; exact at both ends (returns the node itself).
void eval_position(const Path& path, std::size_t segment, double s_u, std::span<double> position_u);
/// Smallest and largest position of one axis on a segment, extremes of arcs included.
std::pair<double, double> axis_extent(const Path& path, std::size_t segment, int axis);

/// Whether a segment is a rapid that planner.rapid_law takes care of: a G0 of an axis with a flexible link.
/// It begins and ends at rest.
bool is_positioning(const Path& path, std::size_t segment, const machine::MachineModel& machine);

}  // namespace kadr::planner
