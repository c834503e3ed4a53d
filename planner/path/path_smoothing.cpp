#include <algorithm>
#include <array>
#include <cmath>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/bezier/corner.h"
#include "planner/bezier/point_fit.h"
#include "planner/path/path_builder.h"

namespace kadr::planner {
namespace {

// lines are dense if they turn by at most 35 degrees and one is at most four times as long as the other
constexpr double kDenseTurn = 0.6;  // |difference of the directions|
constexpr double kDenseLengths = 4;
// and if the curve through them, of curvature turn/length, will be well within the tolerance
constexpr double kDenseShare = 0.5;
// of half a line: kept by a corner, so that there is a line between two corners
constexpr double kMostTrim = 1.0 - 1.0 / 1024;
// below this there is no corner, only rounding
constexpr double kStraight = 1e-9;

double turn_of(const AxisValues& before, const AxisValues& after, std::size_t axes) {
  double square = 0;
  for (std::size_t k = 0; k < axes; ++k) square += (after[k] - before[k]) * (after[k] - before[k]);
  return std::sqrt(square);
}

PathSegment of_length(PathSegment segment, double length_u) {
  segment.feed_length_u *= length_u / segment.length_u;
  segment.length_u = length_u;
  return segment;
}

}  // namespace

/// A segment as seen by the next one; length 0 if nothing can be smoothed there.
PathBuilder::SmoothLine PathBuilder::smooth_line(const PathSegment& segment, const gcode::Move& move,
                                                 const Point& end) const {
  SmoothLine line;
  if (segment.made_by != gcode::BlockKind::feed || segment.lock == FeedLock::thread ||
      move.path_mode != gcode::PathMode::continuous || !(move.path_tolerance_mm > 0) ||
      !(segment.length_u > 0))
    return line;
  line.length_u = segment.length_u;
  line.tolerance_u = move.path_tolerance_mm;
  const auto from = last_node();
  for (std::size_t k = 0; k < program_axis_.size(); ++k)
    line.direction[k] = (end[k] - from[k]) / segment.length_u;
  return line;
}

bool PathBuilder::joins(const PathSegment& segment, const SmoothLine& line) const {
  if (!(line.length_u > 0 && last_line_.length_u > 0)) return false;
  const PathSegment& last = path_.segments.back();
  return !last.stop_at_end && last.lock == segment.lock && path_.faults.empty() &&
         turn_of(last_line_.direction, line.direction, program_axis_.size()) > kStraight;
}

bool PathBuilder::is_dense(const SmoothLine& line) const {
  const double turn = turn_of(last_line_.direction, line.direction, program_axis_.size());
  const double a = std::min(last_line_.length_u, line.length_u);
  const double b = std::max(last_line_.length_u, line.length_u);
  if (!(turn <= kDenseTurn && b <= kDenseLengths * a)) return false;
  // the curvature turn/((a + b)/2) over the longer chord
  const double bulge = b * b * turn / (4 * (a + b));
  return bulge <= kDenseShare * std::min(last_line_.tolerance_u, line.tolerance_u);
}

/// Whether the corner's jump of speed is more than an axis takes at the feed of both lines.
bool PathBuilder::brakes(const PathSegment& segment, const SmoothLine& line) const {
  const double v = std::min(path_.segments.back().feed_u_s, segment.feed_u_s);
  const double tau = machine_.clock.tau_s();
  for (std::size_t j = 0; j < machine_.axis.size(); ++j) {
    const machine::AxisModel& axis = machine_.axis[j];
    const double allowed = std::min(axis.junction_accel_u_s2 * tau, axis.junction_jerk_u_s3 * tau * tau);
    if (v * std::fabs(line.direction[j] - last_line_.direction[j]) > allowed) return true;
  }
  return false;
}

/// A curve through dense lines begins in the middle of the first of them.
void PathBuilder::open_curve(const SmoothLine& line) {
  const double tolerance = std::min(last_line_.tolerance_u, line.tolerance_u);
  if (curve_begin_ == 0) {
    const SmoothLine first = last_line_;
    split_last(0.5 * first.length_u);
    curve_begin_ = path_.size() - 1;
    curve_tolerance_u_ = tolerance;
  }
  curve_tolerance_u_ = std::min(curve_tolerance_u_, tolerance);
}

/// Dense lines that end here become a curve, which ends in the middle of the last of them.
void PathBuilder::settle() {
  if (curve_begin_ == 0) return;
  const SmoothLine last = last_line_;
  split_last(0.5 * last.length_u);
  fit(curve_begin_, path_.size() - 1);
  measure_from(curve_begin_);
  curve_begin_ = 0;
  last_line_ = last;
}

/// Curves through the nodes of segments [begin, end); where they leave the tolerance, the lines meet in a corner.
void PathBuilder::fit(std::size_t begin, std::size_t end) {
  if (end - begin < 2) return;
  const auto axes = program_axis_.size();
  const std::span<const double> points(path_.nodes_u.data() + begin * axes, (end - begin + 1) * axes);
  PointFit curve = fit_points(points, axes);
  const auto worst = std::max_element(curve.deviation_u.begin(), curve.deviation_u.end());
  if (!(*worst <= curve_tolerance_u_)) {
    const auto at = begin + static_cast<std::size_t>(worst - curve.deviation_u.begin());
    const std::size_t joint = at == begin ? begin + 1 : at;
    fit(begin, joint);
    fit(joint, end);
    return;
  }
  for (std::size_t i = begin; i < end; ++i) {
    PathCurve shape(curve.control_u[i - begin], axes);
    PathSegment& segment = path_.segments[i];
    segment = of_length(segment, shape.length_u());
    set_shape(segment, std::move(shape));
  }
  path_.smoothing.curves += end - begin;
  path_.smoothing.curve_deviation_u = std::max(path_.smoothing.curve_deviation_u, *worst);
}

/// Cuts the last line in two, the second of a given length.
void PathBuilder::split_last(double behind_u) {
  PathSegment& last = path_.segments.back();
  const auto axes = program_axis_.size();
  const double length_u = last.length_u;
  const PathSegment behind = of_length(last, behind_u);
  last = of_length(last, length_u - behind_u);
  last.stop_at_end = false;
  const Point end = last_point();
  double* node = path_.nodes_u.data() + path_.size() * axes;
  for (std::size_t k = 0; k < axes; ++k) node[k] = end[k] - behind_u * last_line_.direction[k];
  path_.start_s_u.back() = path_.start_s_u[path_.size() - 1] + last.length_u;
  path_.nodes_u.insert(path_.nodes_u.end(), end.begin(), end.begin() + static_cast<int>(axes));
  path_.start_s_u.push_back(path_.start_s_u.back() + behind_u);
  path_.segments.push_back(behind);
  path_.segments.back().begin_limit_u_s = machine::kInfinity;
}

void PathBuilder::measure_from(std::size_t segment) {
  for (std::size_t i = segment; i < path_.size(); ++i)
    path_.start_s_u[i + 1] = path_.start_s_u[i] + path_.segments[i].length_u;
}

/// Appends a line after a rounded corner, half of which belongs to the line before.
void PathBuilder::round_into(PathSegment segment, const Point& end, const SmoothLine& line) {
  const auto axes = program_axis_.size();
  const Point corner = last_point();
  const SmoothLine before = last_line_;
  const auto direction = [&](const SmoothLine& of) { return std::span(of.direction.data(), axes); };
  const auto rounded = round_corner({corner.data(), axes}, direction(before), direction(line),
                                    std::min(before.tolerance_u, line.tolerance_u),
                                    0.5 * kMostTrim * std::min(before.length_u, line.length_u));
  if (rounded) {
    cut_last(rounded->trim_u);
    const PathSegment last = path_.segments.back();
    for (const bool second : {false, true}) {
      const std::vector<double> half =
          part_of_curve(rounded->control_u, axes, second ? 0.5 : 0, second ? 1 : 0.5);
      PathCurve shape(half, axes);
      Point to{};
      std::copy_n(half.end() - static_cast<int>(axes), axes, to.begin());
      // a technology point is where the second half begins
      const double limit = speed_limit_u_s_;
      if (!second) speed_limit_u_s_ = machine::kInfinity;
      const PathSegment piece = of_length(second ? segment : last, shape.length_u());
      append(piece, to, std::move(shape));
      if (!second) speed_limit_u_s_ = limit;
    }
    segment = of_length(segment, segment.length_u - rounded->trim_u);
    path_.smoothing.corners += 1;
    path_.smoothing.corner_deviation_u = std::max(path_.smoothing.corner_deviation_u, rounded->deviation_u);
  }
  append(segment, end);
  last_line_ = line;
}

/// Takes a piece off the end of the last line.
void PathBuilder::cut_last(double trim_u) {
  PathSegment& last = path_.segments.back();
  last = of_length(last, last.length_u - trim_u);
  const auto axes = program_axis_.size();
  double* node = path_.nodes_u.data() + path_.size() * axes;
  for (std::size_t k = 0; k < axes; ++k) node[k] -= trim_u * last_line_.direction[k];
  path_.start_s_u.back() = path_.start_s_u[path_.size() - 1] + last.length_u;
}

}  // namespace kadr::planner
