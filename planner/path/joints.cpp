#include "planner/path/joints.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"
#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/bezier/curve_bounds.h"
#include "planner/path/arc_place.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

std::size_t index_of(int axis) { return static_cast<std::size_t>(axis); }

/// Derivatives of a straight line in all axes; those of an arc's plane are set afterwards.
void line_at(const Path& path, std::size_t segment, const JointValues& out) {
  const auto from = path.node(segment);
  const auto to = path.node(segment + 1);
  const double length = path.segments[segment].length_u;
  for (std::size_t j = 0; j < out.d1.size(); ++j) out.d1[j] = (to[j] - from[j]) / length;
  std::fill(out.d2_per_u.begin(), out.d2_per_u.end(), 0.0);
  std::fill(out.d3_per_u2.begin(), out.d3_per_u2.end(), 0.0);
}

void arc_at(const Path& path, std::size_t segment, double s_u, const JointValues& out) {
  const ArcShape& arc = path.arc_of(segment);
  const double length = path.segments[segment].length_u;
  const ArcPlace place(arc, std::clamp(s_u / length, 0.0, 1.0));
  const auto set = [&](std::span<double> values, const ArcPlace::Pair& by_share, double scale) {
    values[index_of(arc.first_axis)] = by_share.first / scale;
    values[index_of(arc.second_axis)] = by_share.second / scale;
  };
  if (!out.d1.empty()) set(out.d1, place.first(), length);
  if (!out.d2_per_u.empty()) set(out.d2_per_u, place.second(), length * length);
  if (!out.d3_per_u2.empty()) set(out.d3_per_u2, place.third(), length * length * length);
}

void curve_at(const PathCurve& curve, double s_u, const JointValues& out) {
  const LengthDerivatives x = curve.by_length(curve.t(s_u));
  std::copy_n(x.d1.begin(), out.d1.size(), out.d1.begin());
  std::copy_n(x.d2.begin(), out.d2_per_u.size(), out.d2_per_u.begin());
  std::copy_n(x.d3.begin(), out.d3_per_u2.size(), out.d3_per_u2.begin());
}

/// Largest |sin| between two angles.
double largest_sine(double from_rad, double to_rad) {
  const double low = std::min(from_rad, to_rad) / kPi - 0.5;
  const double high = std::max(from_rad, to_rad) / kPi - 0.5;
  if (std::floor(high) >= std::ceil(low)) return 1.0;
  return std::max(std::fabs(exact_sincos(from_rad).sin), std::fabs(exact_sincos(to_rad).sin));
}

void bound_line(const Path& path, std::size_t segment, SegmentBounds& out) {
  const auto from = path.node(segment);
  const auto to = path.node(segment + 1);
  const double length = path.segments[segment].length_u;
  for (std::size_t j = 0; j < from.size(); ++j) {
    out.joint[j].course = JointCourse::straight;
    out.joint[j].slope = std::fabs((to[j] - from[j]) / length);
  }
}

/// Derivatives of an arc's two circular coordinates are bounded over the whole circle, but for their slopes:
/// those over the angles really passed.
void bound_arc(const ArcShape& arc, double length_u, SegmentBounds& out) {
  const double w = std::fabs(arc.sweep_rad);
  const double dr = std::fabs(arc.radius_end_u - arc.radius_begin_u);
  const double r = std::max(arc.radius_begin_u, arc.radius_end_u);
  const double r_min = std::min(arc.radius_begin_u, arc.radius_end_u);
  const double l2 = length_u * length_u;
  JointBounds b;
  b.course = JointCourse::circle;
  b.tangent = std::sqrt(dr * dr + r * w * r * w) / length_u;
  b.curvature_per_u = (2.0 * dr * w + r * w * w) / l2;
  b.third_per_u2 = (3.0 * dr * w * w + r * w * w * w) / (l2 * length_u);
  // x' and x'' of a spiral are not quite at right angles, |x' . x''| <= q |x'| |x''|:
  // |a x' + b x''|^2 <= (1 + q) (|a x'|^2 + |b x''|^2)
  if (dr > 0.0) b.skew = std::sqrt(1.0 + (6.0 * dr < r_min * w ? 6.0 * dr / (r_min * w) : 1.0));
  const double to = arc.angle_begin_rad + arc.sweep_rad;
  out.straight = false;
  out.curvature_per_u = b.curvature_per_u;
  b.slope = (dr + r * w * largest_sine(arc.angle_begin_rad, to)) / length_u;
  out.joint[index_of(arc.first_axis)] = b;
  b.slope = (dr + r * w * largest_sine(arc.angle_begin_rad + 0.5 * kPi, to + 0.5 * kPi)) / length_u;
  out.joint[index_of(arc.second_axis)] = b;
}

/// x' and x'' by the path's own tangent and curvature, of which `plane` is an axis's share.
void bound_curve(const PathCurve& curve, SegmentBounds& out) {
  const CurveBounds bounds = curve_bounds(curve);
  out.straight = false;
  out.curvature_per_u = bounds.curvature_per_u;
  for (std::size_t j = 0; j < curve.axes(); ++j)
    out.joint[j] = {JointCourse::curve,     bounds.tangent[j],  1.0,
                    bounds.curvature_per_u, bounds.third_u2[j], bounds.plane[j]};
}

}  // namespace

DirectJoints::DirectJoints(const Path& path) : Joints(path, static_cast<std::size_t>(path.axes())) {}

void DirectJoints::at(std::size_t segment, double s_u, const JointValues& out) const {
  if (!out.position_u.empty()) eval_position(path(), segment, s_u, out.position_u);
  if (out.d1.empty() && out.d2_per_u.empty() && out.d3_per_u2.empty()) return;
  switch (path().segments[segment].kind) {
    case SegmentKind::line:
      return line_at(path(), segment, out);
    case SegmentKind::arc:
      line_at(path(), segment, out);
      return arc_at(path(), segment, s_u, out);
    case SegmentKind::curve:
      return curve_at(path().curve_of(segment), s_u, out);
  }
}

void DirectJoints::bound(std::size_t segment, SegmentBounds& out) const {
  out.straight = true;
  out.curvature_per_u = 0.0;
  const PathSegment& seg = path().segments[segment];
  switch (seg.kind) {
    case SegmentKind::line:
      return bound_line(path(), segment, out);
    case SegmentKind::arc:
      bound_line(path(), segment, out);
      return bound_arc(path().arc_of(segment), seg.length_u, out);
    case SegmentKind::curve:
      return bound_curve(path().curve_of(segment), out);
  }
}

std::pair<double, double> DirectJoints::extent_u(std::size_t segment, std::size_t joint) const {
  return axis_extent(path(), segment, static_cast<int>(joint));
}

bool DirectJoints::moves(std::size_t segment, std::size_t joint) const {
  if (path().node(segment)[joint] != path().node(segment + 1)[joint]) return true;
  switch (path().segments[segment].kind) {
    case SegmentKind::line:
      return false;
    case SegmentKind::arc: {
      const ArcShape& arc = path().arc_of(segment);
      return joint == index_of(arc.first_axis) || joint == index_of(arc.second_axis);
    }
    case SegmentKind::curve:
      return path().curve_of(segment).moves(joint);
  }
  return false;
}

double DirectJoints::turn_rad(std::size_t segment) const {
  const bool circle = path().segments[segment].kind == SegmentKind::arc;
  return circle ? std::fabs(path().arc_of(segment).sweep_rad) : 0.0;
}

std::unique_ptr<const Joints> machine_joints(const Path& path, const machine::MachineModel& machine) {
  require(path.axes() == static_cast<int>(machine.axis.size()), "path and machine have the same axes");
  return std::make_unique<DirectJoints>(path);
}

}  // namespace kadr::planner
