#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "gcode/block.h"
#include "machine/machine.h"

/// The tool path: segments in the machine's n axes, joined end to end. Geometry only; timing is elsewhere.
///
/// Path length s: one metric for all segments, s = sqrt(sum of squares over the machine's axes), mm and deg
/// counted alike, so that axis speeds stay continuous where s does (arc: radius * angle in the plane,
/// combined with the linear motion of all other axes). For a program that moves X Y Z only it is the length
/// in mm. Suffix `_u`.
namespace kadr::planner {

enum class SegmentKind : std::uint8_t { line, arc };

/// Why the operator's percent does not count on a segment.
enum class FeedLock : std::uint8_t {
  none,
  thread,    ///< in step with the spindle: G33, G33.1
  disabled,  ///< M49, M50 P0, and what switches the override off by itself
};

/// Circle in a plane of two machine axes; the other axes move linearly with the angle (helix).
/// The radius runs linearly with the angle from radius_begin to radius_end (equal but for rounding of the
/// program):
///   p_first(phi)  = center_first  + r(phi) cos(phi),   p_second(phi) = center_second + r(phi) sin(phi)
///   phi = angle_begin + sweep * u,  r = radius_begin + (radius_end - radius_begin) * u,  u = s/length in [0,
///   1]
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

/// One piece of path. Its end points are Path::node(i) and Path::node(i + 1).
struct PathSegment {
  SegmentKind kind = SegmentKind::line;
  bool rapid = false;
  bool stop_at_end = false;  ///< exact stop (G61.1) or a stop asked for by the program
  FeedLock lock = FeedLock::none;
  bool path_limits = false;                           ///< feed_length_u is of X Y Z: PathLimits apply to it
  gcode::BlockKind made_by = gcode::BlockKind::feed;  ///< what the program asked for
  std::int32_t arc = -1;                              ///< index into Path::arcs
  std::uint32_t block = 0;  ///< running number of the motion block; a spline has many segments, a tap two
  Span span;
  double length_u = 0;                          ///< > 0
  double begin_limit_u_s = machine::kInfinity;  ///< of the speed where it begins: a technology point
  double feed_length_u = 0;  ///< the length that the programmed feed measures (gcode::FeedLength), mm or deg
  double feed_u_s =
      0;  ///< programmed speed of s (already converted by length_u / feed_length_u); inf for a rapid
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
  /// One past the last segment of the block that segment i belongs to.
  std::size_t block_end(std::size_t i) const {
    const std::uint32_t block = segments[i].block;
    while (i < segments.size() && segments[i].block == block) ++i;
    return i;
  }

  /// The segments from i on; s still counts from the whole path's beginning.
  Path tail(std::size_t i) const;

  std::vector<PathSegment> segments;
  std::vector<ArcShape> arcs;
  std::vector<double> nodes_u;     ///< [(segments + 1) * axes], made by build_path
  std::vector<double> start_s_u;   ///< [segments + 1], path length at each joint; first is 0
  std::vector<Diagnostic> faults;  ///< moves this machine can't make; plan() refuses with the first

 private:
  int axes_;
};

/// What a segment's block is called in logs and tables: "rapid", "line", "arc", "spline", "probe", "tap".
std::string_view motion_name(const PathSegment& segment);
/// Position on a segment at local length s in [0, length]; exact at both ends (returns the node itself).
void eval_position(const Path& path, std::size_t segment, double s_u, std::span<double> position_u);
/// dx/ds there, one value per axis.
void eval_tangent(const Path& path, std::size_t segment, double s_u, std::span<double> tangent);
/// d2x/ds2 there (zero on lines).
void eval_curvature(const Path& path, std::size_t segment, double s_u, std::span<double> curvature_per_u);
/// Smallest and largest position of one axis on a segment, extremes of arcs included.
std::pair<double, double> axis_extent(const Path& path, std::size_t segment, int axis);

/// Whether a block moves the machine.
constexpr bool is_motion(gcode::BlockKind kind) {
  return kind == gcode::BlockKind::traverse || kind == gcode::BlockKind::feed ||
         kind == gcode::BlockKind::arc || kind == gcode::BlockKind::spline ||
         kind == gcode::BlockKind::probe || kind == gcode::BlockKind::rigid_tap;
}

/// Turns motion Blocks into a Path, one by one.
class PathBuilder {
 public:
  /// @param start_u position of every program axis before the first block, machine coordinates
  PathBuilder(const machine::MachineModel& machine, const AxisValues& start_u);
  /// Appends the block's motion; a move of zero length adds nothing. A spline becomes arcs (arcs_along), a
  /// probing move ends at rest where the probe changes, a tap goes to its end and back, at rest between.
  /// @pre is_motion(block.kind)
  void add(const gcode::Block& block);
  /// The last segment ends at rest (dwell, stop, spindle word follows).
  void stop();
  /// A technology point: the next block begins at that speed at most, mm/s or deg/s along what F measures.
  void limit_speed(double speed_u_s) { speed_limit_u_s_ = std::min(speed_limit_u_s_, speed_u_s); }
  /// The blocks from here on follow the spindle's angle, or no longer.
  void follow_spindle(bool on) { follows_spindle_ = on; }
  const Path& path() const { return path_; }
  Path take() { return std::move(path_); }

 private:
  using Point = AxisValues;  ///< by machine axis

  PathSegment segment_of(const gcode::Block& block);
  void add_line(PathSegment segment, const gcode::Block& block, const Point& end);
  void add_arc(PathSegment segment, const gcode::Block& block);
  void add_spline(PathSegment segment, const gcode::Block& block);
  void append(const PathSegment& segment, const gcode::Block& block, const Point& end, const ArcShape& arc);
  void set_feed(PathSegment& segment, const gcode::Block& block, double xyz_u);
  bool plane_axes(const gcode::Block& block, ArcShape& arc);  ///< false: a fault was noted
  ArcShape circle(ArcShape arc, double center_first_u, double center_second_u, const Point& end) const;
  Point machine_point(const AxisValues& program) const;
  std::span<const double> last_node() const { return path_.node(path_.size()); }
  Point last_point() const;
  void fault(Code code, const gcode::Block& block, std::string label, std::string help);

  const machine::MachineModel& machine_;
  Path path_;
  std::vector<int> program_axis_;  ///< [machine axes] index into AxisValues
  std::uint32_t blocks_ = 0;
  bool follows_spindle_ = false;
  double speed_limit_u_s_ = machine::kInfinity;  ///< of the next segment's beginning
};

}  // namespace kadr::planner
