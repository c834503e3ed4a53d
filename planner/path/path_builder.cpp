#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "gcode/block.h"
#include "machine/base/numbers.h"
#include "machine/base/require.h"
#include "machine/base/variants.h"
#include "machine/machine.h"
#include "planner/bezier/curve_parts.h"
#include "planner/path/path_builder.h"
#include "planner/path/spline_arcs.h"

namespace kadr::planner {
namespace {

double norm(double a, double b) { return std::sqrt(a * a + b * b); }

/// Signed angle of an arc. End points that coincide up to rounding leave it open whether a full turn or
/// none is meant; the length that the program's reader gave decides.
double signed_sweep(double from_first, double from_second, double to_first, double to_second, int turns,
                    double planar_length_u, double mean_radius_u) {
  const double direction = turns >= 0 ? 1.0 : -1.0;
  const double cross = from_first * to_second - from_second * to_first;
  const double dot = from_first * to_first + from_second * to_second;
  double angle = direction * exact_atan2(cross, dot);
  if (angle <= 0.0) angle += 2.0 * kPi;
  angle += 2.0 * kPi * static_cast<double>(std::max(std::abs(turns) - 1, 0));
  if (planar_length_u > 0.0 && mean_radius_u > 0.0) {
    const double told = planar_length_u / mean_radius_u;
    for (const double other : {angle - 2.0 * kPi, angle + 2.0 * kPi})
      if (other > 0.0 && std::fabs(other - told) < 1e-3 * std::fabs(angle - told)) {
        angle = other;
        break;
      }
  }
  return direction * angle;
}

}  // namespace

PathBuilder::PathBuilder(const machine::MachineModel& machine, const AxisValues& start_u)
    : machine_(machine), path_(static_cast<int>(machine.axis.size())) {
  for (const machine::AxisModel& axis : machine.axis) {
    const int index = axis_index(axis.letter);
    require(index >= 0, "every machine axis has one of the nine letters");
    program_axis_.push_back(index);
    path_.nodes_u.push_back(start_u[static_cast<std::size_t>(index)]);
  }
  path_.start_s_u.push_back(0.0);
}

void PathBuilder::stop() {
  settle();
  if (!path_.segments.empty()) path_.segments.back().stop_at_end = true;
}

Path PathBuilder::take() {
  settle();
  return std::move(path_);
}

bool PathBuilder::add(const gcode::Block& block) {
  add_motion(block);
  return path_.size() > 0 && path_.segments.back().block + 1 == blocks_;
}

void PathBuilder::add_motion(const gcode::Block& block) {
  const gcode::Move* move = gcode::move_of(block);
  require(move != nullptr, "only moves make path");
  PathSegment segment = segment_of(block, *move);
  const auto along_line = [&](const OneOf<gcode::Traverse, gcode::Feed> auto& line) {
    add_line(segment, line, machine_point(line.end));
  };
  const auto to_contact = [&](const gcode::Probe& probe) {
    // the controller stops where the probe changes
    segment.stop_at_end = true;
    add_line(segment, probe, machine_point(probe.contact));
  };
  const auto down_and_up = [&](const gcode::RigidTap& tap) {
    const Point start = last_point();
    segment.stop_at_end = true;
    add_line(segment, tap, machine_point(tap.end));
    add_line(segment, tap, start);
  };
  const auto to_entry = [&](const gcode::Approach& approach) { add_approach(segment, approach); };
  std::visit(Overloaded{along_line, to_contact, down_and_up, to_entry,
                        [&](const gcode::Arc& arc) { add_arc(segment, arc); },
                        [&](const gcode::Spline& spline) { add_spline(segment, spline); },
                        [](const gcode::NoMove auto&) {}},
             block.action);
}

PathSegment PathBuilder::segment_of(const gcode::Block& block, const gcode::Move& move) {
  PathSegment segment;
  segment.rapid = gcode::is<gcode::Traverse, gcode::Approach>(block);
  segment.stop_at_end = move.path_mode == gcode::PathMode::exact_stop;
  if (follows_spindle_ || gcode::is<gcode::RigidTap>(block))
    segment.lock = FeedLock::thread;
  else if (!move.feed_override_enabled)
    segment.lock = FeedLock::disabled;
  pitch_u_rev_ = move.pitch_u_rev;
  segment.made_by = block.kind();
  segment.block = blocks_++;
  segment.span = block.span;
  return segment;
}

void PathBuilder::add_approach(const PathSegment& segment, const gcode::Approach& approach) {
  const Point place = machine_point(approach.end);
  for (const std::string& axes : approach.ways) {
    Point end = last_point();
    for (std::size_t j = 0; j < program_axis_.size(); ++j)
      if (axes.find(machine_.axis[j].letter) != std::string::npos) end[j] = place[j];
    add_line(segment, approach, end);
  }
}

void PathBuilder::add_line(PathSegment segment, const gcode::Move& move, const Point& end) {
  const auto from = last_node();
  double squares = 0.0, xyz_squares = 0.0;
  for (std::size_t j = 0; j < program_axis_.size(); ++j) {
    const double step = end[j] - from[j];
    squares += step * step;
    if (program_axis_[j] < 3) xyz_squares += step * step;
  }
  segment.length_u = std::sqrt(squares);
  set_feed(segment, move, std::sqrt(xyz_squares));
  const SmoothLine line = smooth_line(segment, move, end);
  if (joins(segment, line)) {
    if (is_dense(line)) {
      open_curve(line);
    } else {
      settle();
      if (brakes(segment, line)) return round_into(segment, end, line);
    }
  } else {
    settle();
  }
  append(segment, end);
  last_line_ = line;
}

void PathBuilder::add_arc(PathSegment segment, const gcode::Arc& programmed) {
  if (programmed.plane_rotation_deg != 0) {
    return fault(
        Code::arc_plane_turned, segment.span,
        fmt::format("G10 L2 R turns this plane by {:.6g} degrees about Z", programmed.plane_rotation_deg),
        "turn the work system back by R0, or write the arc as short lines");
  }
  ArcShape arc;
  if (!plane_axes(segment, programmed.plane, arc)) return;
  const Point end = machine_point(programmed.end);
  const auto from = last_node();
  arc = circle(arc, programmed.center_first_mm, programmed.center_second_mm, end);
  double squares = 0.0;      // over the axes that move linearly
  double xyz_squares = 0.0;  // those of them that are X Y Z
  for (std::size_t j = 0; j < program_axis_.size(); ++j) {
    const int axis = static_cast<int>(j);
    if (axis == arc.first_axis || axis == arc.second_axis) continue;
    const double step = end[j] - from[j];
    squares += step * step;
    if (program_axis_[j] < 3) xyz_squares += step * step;
  }
  const double mean_radius = 0.5 * (arc.radius_begin_u + arc.radius_end_u);
  const double told = std::sqrt(std::max(programmed.length_u * programmed.length_u - xyz_squares, 0.0));
  const auto first = static_cast<std::size_t>(arc.first_axis);
  const auto second = static_cast<std::size_t>(arc.second_axis);
  arc.sweep_rad =
      signed_sweep(from[first] - arc.center_first_u, from[second] - arc.center_second_u,
                   end[first] - arc.center_first_u, end[second] - arc.center_second_u, programmed.turns,
                   programmed.feed_length == gcode::FeedLength::xyz ? told : 0.0, mean_radius);
  const double planar = mean_radius * std::fabs(arc.sweep_rad);
  segment.length_u = std::sqrt(squares + planar * planar);
  set_feed(segment, programmed, std::sqrt(xyz_squares + planar * planar));
  settle();
  // a circle of radius zero is a point: only the straight motion of the other axes remains
  append(segment, end, planar > 0.0 ? SegmentShape(arc) : SegmentShape());
}

void PathBuilder::add_spline(PathSegment segment, const gcode::Spline& spline) {
  ArcShape plane;
  if (!plane_axes(segment, gcode::Plane::xy, plane)) return;
  settle();
  if (add_curve(segment, spline, plane)) return;
  std::vector<SplineControl> points;
  for (const gcode::SplinePoint& p : spline.control_points) points.push_back({p.x_mm, p.y_mm, p.weight});
  const double deviation_mm = std::max(kSplineDeviation_mm, spline.path_tolerance_mm);
  const std::vector<CurvePiece> pieces =
      arcs_along(PlaneSpline(std::move(points), spline.order), deviation_mm);
  const bool stops = segment.stop_at_end;
  double length_mm = 0.0;
  for (const CurvePiece& piece : pieces) length_mm += piece.length_mm;
  for (const CurvePiece& piece : pieces) {
    const bool last = &piece == &pieces.back();
    // the last piece ends where the program says, to the last bit
    Point end = last ? machine_point(spline.end) : last_point();
    if (!last) {
      end[static_cast<std::size_t>(plane.first_axis)] = piece.end_first_mm;
      end[static_cast<std::size_t>(plane.second_axis)] = piece.end_second_mm;
    }
    SegmentShape shape;
    if (piece.arc) {
      ArcShape arc = circle(plane, piece.center_first_mm, piece.center_second_mm, end);
      arc.sweep_rad = piece.sweep_rad;
      shape = arc;
    }
    segment.stop_at_end = stops && last;
    segment.path_limits = true;
    segment.length_u = segment.feed_length_u = piece.length_mm;
    segment.feed_u_s = spline.duration_s > 0.0 ? length_mm / spline.duration_s : spline.feed_u_s;
    append(segment, end, std::move(shape));
  }
}

/// Largest curvature that never limits the feed, even at 200 % override.
double PathBuilder::harmless_curvature_per_u(const gcode::Move& move,
                                             std::span<const double> control_u) const {
  constexpr double kFastest = 2.0, kShare = 0.8;
  const double feed_u_s = move.duration_s > 0.0
                              ? PathCurve(control_u, program_axis_.size()).length_u() / move.duration_s
                              : move.feed_u_s;
  double accel = machine_.path.centripetal_accel_mm_s2;
  for (const machine::AxisModel& axis : machine_.axis) accel = std::min(accel, kShare * axis.max_accel_u_s2);
  return accel / (kFastest * feed_u_s * kFastest * feed_u_s);
}

/// A spline of one span without weights, which is a Bezier curve: exactly, in parts.
bool PathBuilder::add_curve(PathSegment segment, const gcode::Spline& spline, const ArcShape& plane) {
  const std::vector<gcode::SplinePoint>& points = spline.control_points;
  const auto plain = [](const gcode::SplinePoint& p) { return p.weight == 1; };
  if (static_cast<int>(points.size()) != spline.order || points.size() > PathCurve::kPowers ||
      !std::all_of(points.begin(), points.end(), plain))
    return false;
  const std::size_t axes = program_axis_.size();
  const Point start = last_point(), end = machine_point(spline.end);
  std::vector<double> control;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // both ends are the path's own nodes, to the last bit
    const bool last = i + 1 == points.size();
    Point at = last ? end : start;
    if (i > 0 && !last) {
      at[static_cast<std::size_t>(plane.first_axis)] = points[i].x_mm;
      at[static_cast<std::size_t>(plane.second_axis)] = points[i].y_mm;
    }
    control.insert(control.end(), at.begin(), at.begin() + static_cast<int>(axes));
  }
  const auto parts = parts_of_like_curvature(control, axes, harmless_curvature_per_u(spline, control));
  if (!parts) return false;
  std::vector<PathCurve> curves;
  double length_mm = 0.0;
  for (const std::vector<double>& part : *parts) length_mm += curves.emplace_back(part, axes).length_u();
  const bool stops = segment.stop_at_end;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool last = i + 1 == curves.size();
    Point to = end;
    if (!last) std::copy_n((*parts)[i + 1].begin(), axes, to.begin());
    segment.stop_at_end = stops && last;
    segment.path_limits = true;
    segment.length_u = segment.feed_length_u = curves[i].length_u();
    segment.feed_u_s = spline.duration_s > 0.0 ? length_mm / spline.duration_s : spline.feed_u_s;
    append(segment, to, std::move(curves[i]));
  }
  return true;
}

void PathBuilder::set_feed(PathSegment& segment, const gcode::Move& move, double xyz_u) {
  // length that F measures; without one the geometry gives it
  segment.path_limits = xyz_u > 0.0;
  segment.feed_length_u = move.length_u > 0.0 ? move.length_u : xyz_u > 0.0 ? xyz_u : segment.length_u;
  if (segment.path_limits && move.feed_length != gcode::FeedLength::xyz) segment.feed_length_u = xyz_u;
  if (segment.rapid)
    segment.feed_u_s = machine::kInfinity;
  else if (move.duration_s > 0.0)
    segment.feed_u_s = segment.length_u / move.duration_s;
  else
    segment.feed_u_s = move.feed_u_s * segment.length_u / segment.feed_length_u;
}

void PathBuilder::append(const PathSegment& segment, const Point& end, SegmentShape shape) {
  last_line_ = {};
  const std::size_t axes = program_axis_.size();
  const double s = path_.start_s_u.back();
  if (!(s + segment.length_u > s)) {
    // too short to count in s: the path ends where the program says, to the last bit, without a new segment
    if (segment.length_u > 0.0) std::copy_n(end.begin(), axes, path_.nodes_u.end() - static_cast<int>(axes));
    if (segment.stop_at_end) stop();
    return;
  }
  if (pitch_u_rev_ > 0.0 && !(segment.feed_u_s > 0.0)) {
    fault(Code::spindle_stands_still, segment.span,
          fmt::format("{} mm per turn, and the spindle turns at 0 rpm", pitch_u_rev_),
          "start the spindle before this move: S and M3 or M4");
    return;
  }
  if (segment.lock == FeedLock::thread && pitch_u_rev_ > 0.0 && !thread_reachable(segment, end)) return;
  path_.nodes_u.insert(path_.nodes_u.end(), end.begin(), end.begin() + static_cast<int>(axes));
  path_.start_s_u.push_back(s + segment.length_u);
  path_.segments.push_back(segment);
  path_.segments.back().begin_limit_u_s = speed_limit_u_s_ * (segment.length_u / segment.feed_length_u);
  speed_limit_u_s_ = machine::kInfinity;
  set_shape(path_.segments.back(), std::move(shape));
}

/// Whether every axis can follow the spindle along a straight thread: slower, it would cut another pitch.
bool PathBuilder::thread_reachable(const PathSegment& segment, const Point& end) {
  constexpr double kRounding = 1e-9;
  constexpr double kSecondsPerMinute = 60.0;
  const double rpm =
      segment.feed_u_s * (segment.feed_length_u / segment.length_u) / pitch_u_rev_ * kSecondsPerMinute;
  const auto refuse = [&](const std::string& who, double needed_u_s, double most_u_s, const char* unit) {
    if (needed_u_s <= most_u_s * (1 + kRounding)) return false;
    fault(Code::thread_too_fast, segment.span,
          fmt::format("{:.4g} {} per turn at {:.0f} rpm need {:.4g} {}/s; {} reaches {:.4g}", pitch_u_rev_,
                      unit, rpm, needed_u_s, unit, who, most_u_s),
          fmt::format("write at most S{:.0f}", std::floor(rpm * most_u_s / needed_u_s)));
    return true;
  };
  const auto from = last_node();
  for (std::size_t j = 0; j < program_axis_.size(); ++j) {
    const machine::AxisModel& axis = machine_.axis[j];
    if (machine_.planner.axis_limits == machine::AxisLimitRule::report) break;
    const double needed_u_s = std::abs(end[j] - from[j]) / segment.length_u * segment.feed_u_s;
    const char* unit = axis.kind == machine::AxisKind::rotary ? "deg" : "mm";
    if (refuse(fmt::format("axis {}", axis.letter), needed_u_s, axis.max_feed_u_s, unit)) return false;
  }
  const double path_u_s = segment.feed_u_s * (segment.feed_length_u / segment.length_u);
  return !segment.path_limits ||
         !refuse("the path (feed.max_mm_s)", path_u_s, machine_.path.max_feed_mm_s, "mm");
}

void PathBuilder::set_shape(PathSegment& segment, SegmentShape shape) {
  if (const auto* arc = std::get_if<ArcShape>(&shape)) {
    segment.kind = SegmentKind::arc;
    segment.shape = static_cast<std::int32_t>(path_.arcs.size());
    path_.arcs.push_back(*arc);
  } else if (auto* curve = std::get_if<PathCurve>(&shape)) {
    segment.kind = SegmentKind::curve;
    segment.shape = static_cast<std::int32_t>(path_.curves.size());
    path_.curves.push_back(std::move(*curve));
  }
}

PathBuilder::Point PathBuilder::machine_point(const AxisValues& program) const {
  Point point{};
  for (std::size_t j = 0; j < program_axis_.size(); ++j)
    point[j] = program[static_cast<std::size_t>(program_axis_[j])];
  return point;
}

PathBuilder::Point PathBuilder::last_point() const {
  Point point{};
  const auto node = last_node();
  std::copy(node.begin(), node.end(), point.begin());
  return point;
}

bool PathBuilder::plane_axes(const PathSegment& segment, gcode::Plane program_plane, ArcShape& arc) {
  const gcode::PlaneAxes plane = gcode::plane_axes(program_plane);
  const auto machine_axis = [&](int program_axis) {
    const auto it = std::find(program_axis_.begin(), program_axis_.end(), program_axis);
    return it == program_axis_.end() ? -1 : static_cast<int>(it - program_axis_.begin());
  };
  arc.first_axis = machine_axis(plane.first);
  arc.second_axis = machine_axis(plane.second);
  if (arc.first_axis >= 0 && arc.second_axis >= 0) return true;
  const char missing =
      kAxisLetters[static_cast<std::size_t>(arc.first_axis < 0 ? plane.first : plane.second)];
  fault(Code::arc_axis_missing, segment.span,
        fmt::format("the {} needs axis {}", motion_name(segment), missing),
        "choose the plane with G17, G18 or G19, or a machine that has both of its axes");
  std::string letters;
  for (const machine::AxisModel& axis : machine_.axis) letters += axis.letter;
  path_.faults.back().notes.push_back("machine '" + machine_.name + "' has the axes " + letters);
  return false;
}

ArcShape PathBuilder::circle(ArcShape arc, double center_first_u, double center_second_u,
                             const Point& end) const {
  const auto first = static_cast<std::size_t>(arc.first_axis);
  const auto second = static_cast<std::size_t>(arc.second_axis);
  const auto from = last_node();
  arc.center_first_u = center_first_u;
  arc.center_second_u = center_second_u;
  arc.radius_begin_u = norm(from[first] - center_first_u, from[second] - center_second_u);
  arc.radius_end_u = norm(end[first] - center_first_u, end[second] - center_second_u);
  arc.angle_begin_rad = exact_atan2(from[second] - center_second_u, from[first] - center_first_u);
  return arc;
}

void PathBuilder::fault(Code code, Span span, std::string label, std::string help) {
  // the passes of a thread and the halves of a tap have one place
  if (!path_.faults.empty() && path_.faults.back().code == code && path_.faults.back().span == span) return;
  Diagnostic d{};
  d.code = code;
  d.span = span;
  d.message = std::string(code_entry(code).title);
  d.label = std::move(label);
  d.help = std::move(help);
  path_.faults.push_back(std::move(d));
}

}  // namespace kadr::planner
