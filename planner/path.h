#pragma once
#include <array>
#include <cstdint>
#include <span>
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
  bool feed_override_enabled = true;
  bool path_limits = false;  ///< feed_length_u is of X Y Z: PathLimits apply to it
  std::int32_t arc = -1;     ///< index into Path::arcs
  std::uint32_t block = 0;   ///< running number of the motion block
  Span span;
  double length_u = 0;       ///< > 0
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

  std::vector<PathSegment> segments;
  std::vector<ArcShape> arcs;
  std::vector<double> nodes_u;     ///< [(segments + 1) * axes], made by build_path
  std::vector<double> start_s_u;   ///< [segments + 1], path length at each joint; first is 0
  std::vector<Diagnostic> faults;  ///< moves this machine can't make; plan() refuses with the first

 private:
  int axes_;
};

/// Position on a segment at local length s in [0, length]; exact at both ends (returns the node itself).
void eval_position(const Path& path, std::size_t segment, double s_u, std::span<double> position_u);
/// dx/ds there, one value per axis.
void eval_tangent(const Path& path, std::size_t segment, double s_u, std::span<double> tangent);
/// d2x/ds2 there (zero on lines).
void eval_curvature(const Path& path, std::size_t segment, double s_u, std::span<double> curvature_per_u);
/// Smallest and largest position of one axis on a segment, extremes of arcs included.
std::pair<double, double> axis_extent(const Path& path, std::size_t segment, int axis);

/// Turns motion Blocks into a Path, one by one.
class PathBuilder {
 public:
  /// @param start_u position of every program axis before the first block, machine coordinates
  PathBuilder(const machine::MachineModel& machine, const AxisValues& start_u);
  /// Appends the block's motion; a move of zero length adds nothing. Only traverse, feed and arc blocks.
  void add(const gcode::Block& block);
  /// The last segment ends at rest (dwell, stop, spindle word follows).
  void stop();
  const Path& path() const { return path_; }
  Path take() { return std::move(path_); }

 private:
  bool arc_shape(const gcode::Block& block, ArcShape& arc);  ///< all but the sweep; false: a fault was noted
  double end_of(const gcode::Block& block, int axis) const;  ///< by machine axis
  void move_last_node(const gcode::Block& block);

  const machine::MachineModel& machine_;
  Path path_;
  std::vector<int> program_axis_;  ///< [machine axes] index into AxisValues
  std::uint32_t blocks_ = 0;
};

}  // namespace kadr::planner
