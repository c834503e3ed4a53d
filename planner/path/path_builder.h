#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "machine/base/axes.h"
#include "planner/path/path.h"

namespace kadr::gcode {
enum class Plane : std::uint8_t;
struct Approach;
struct Arc;
struct Block;
struct Move;
struct Spline;
}  // namespace kadr::gcode

namespace kadr::planner {

/// Turns motion Blocks into a Path, one by one.
///
/// Under G64 P two straight feed moves are joined without a corner, within P of the programmed lines and P of
/// their corner: dense lines (small turns, like lengths) become a curve through the programmed points
/// (PointFit), any other corner that would brake them is cut (RoundedCorner). One half of a rounded corner
/// belongs to each block. Corners at rapids, arcs, threads, probing moves and stops stay as they are.
class PathBuilder {
 public:
  /// @param start_u position of every program axis before the first block, machine coordinates
  PathBuilder(const machine::MachineModel& machine, const AxisValues& start_u);
  /// Appends the block's motion; a move of zero length adds nothing. A probing move ends at rest where the
  /// probe changes, a tap goes to its end and back, an approach way by way, at rest between. A cubic or quadratic spline becomes
  /// curves, any other arcs (arcs_along).
  /// @pre gcode::is_move(block)
  /// @return whether path was added
  bool add(const gcode::Block& block);
  /// The last segment ends at rest (dwell, stop, spindle word follows).
  void stop();
  /// A technology point: the next block begins at that speed at most, mm/s or deg/s along what F measures.
  void limit_speed(double speed_u_s) { speed_limit_u_s_ = std::min(speed_limit_u_s_, speed_u_s); }
  /// The blocks from here on follow the spindle's angle, or no longer.
  void follow_spindle(bool on) { follows_spindle_ = on; }
  /// Motion blocks so far, those of zero length among them: the running number of the next one. Numbers of
  /// segments may still change.
  std::uint32_t blocks() const { return blocks_; }
  /// The path so far; final up to the last stop.
  const Path& path() const { return path_; }
  Path take();

 private:
  using Point = AxisValues;  ///< by machine axis

  /// A straight feed move under G64 P that the path ends with.
  struct SmoothLine {
    /// as programmed; the path may have less of it. 0: the path ends with something else
    double length_u = 0;
    double tolerance_u = 0;  ///< P
    Point direction{};
  };

  void add_motion(const gcode::Block& block);
  PathSegment segment_of(const gcode::Block& block, const gcode::Move& move);
  void add_approach(const PathSegment& segment, const gcode::Approach& approach);
  void add_line(PathSegment segment, const gcode::Move& move, const Point& end);
  void add_arc(PathSegment segment, const gcode::Arc& arc);
  void add_spline(PathSegment segment, const gcode::Spline& spline);
  double harmless_curvature_per_u(const gcode::Move& move, std::span<const double> control_u) const;
  bool add_curve(PathSegment segment, const gcode::Spline& spline, const ArcShape& plane);
  void append(const PathSegment& segment, const Point& end, SegmentShape shape = {});
  void set_shape(PathSegment& segment, SegmentShape shape);
  void set_feed(PathSegment& segment, const gcode::Move& move, double xyz_u);
  /// False: a fault was noted.
  bool plane_axes(const PathSegment& segment, gcode::Plane program_plane, ArcShape& arc);
  ArcShape circle(ArcShape arc, double center_first_u, double center_second_u, const Point& end) const;
  Point machine_point(const AxisValues& program) const;
  std::span<const double> last_node() const { return path_.node(path_.size()); }
  Point last_point() const;
  bool thread_reachable(const PathSegment& segment, const Point& end);
  void fault(Code code, Span span, std::string label, std::string help);

  // path_smoothing.cpp
  SmoothLine smooth_line(const PathSegment& segment, const gcode::Move& move, const Point& end) const;
  bool joins(const PathSegment& segment, const SmoothLine& line) const;
  bool is_dense(const SmoothLine& line) const;
  bool brakes(const PathSegment& segment, const SmoothLine& line) const;
  void open_curve(const SmoothLine& line);
  void settle();
  void fit(std::size_t begin, std::size_t end);
  void split_last(double behind_u);
  void measure_from(std::size_t segment);
  void round_into(PathSegment segment, const Point& end, const SmoothLine& line);
  void cut_last(double trim_u);

  const machine::MachineModel& machine_;
  Path path_;
  std::vector<int> program_axis_;  ///< [machine axes] index into AxisValues
  std::uint32_t blocks_ = 0;
  bool follows_spindle_ = false;
  double pitch_u_rev_ = 0;                       ///< of the move being added
  double speed_limit_u_s_ = machine::kInfinity;  ///< of the next segment's beginning
  SmoothLine last_line_;
  /// first segment of the dense lines that the path ends with; 0: there are none
  std::size_t curve_begin_ = 0;
  double curve_tolerance_u_ = 0;
};

}  // namespace kadr::planner
