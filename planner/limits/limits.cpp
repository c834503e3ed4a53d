#include "planner/limits/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/bezier/curve_bounds.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

using machine::kInfinity;

// shares of an axis limit on arcs, see limits.h
constexpr double kNormalShare = 0.8;
constexpr double kNormalShareMost = 0.98;
constexpr double kTurningJerkShare = 0.4;
constexpr double kTangentJerkShare = 0.8;
constexpr double kNormalJerkShare = 0.6;

constexpr const char* kNoJerkLimit = "nothing limits the jerk";

using AxisVector = std::array<double, kProgramAxes>;

struct Ends {
  AxisVector tangent_begin, tangent_end;
  AxisVector curvature_begin, curvature_end;  // not set on lines
  bool curved = false;
};

/// Derivatives of an arc's two circular coordinates with respect to s, bounded over the whole circle.
struct ArcBounds {
  double tangent = 0;    // |x'|
  double curvature = 0;  // |x''|
  double turning = 0;    // |x'''|
  double skew = 1;  // axis limits are divided by this: x' and x'' are not quite at right angles on a spiral
  double first_tangent = 0, second_tangent = 0;  // each axis, over the angles really passed
};

struct SegmentCaps {
  double speed = kInfinity;
  Signature signature;
  double accel = kInfinity;
  double jerk = kInfinity;
  void lower_speed(double v, LimitedBy reason, int axis = -1) {
    if (v < speed) speed = v, signature = {reason, static_cast<std::int8_t>(axis)};
  }
  void lower_accel(double a) { accel = std::min(accel, a); }
  void lower_jerk(double j) { jerk = std::min(jerk, j); }
};

/// Largest |sin| between two angles.
double largest_sine(double from_rad, double to_rad) {
  const double low = std::min(from_rad, to_rad) / kPi - 0.5;
  const double high = std::max(from_rad, to_rad) / kPi - 0.5;
  if (std::floor(high) >= std::ceil(low)) return 1.0;
  return std::max(std::fabs(exact_sincos(from_rad).sin), std::fabs(exact_sincos(to_rad).sin));
}

ArcBounds arc_bounds(const ArcShape& arc, double length_u) {
  const double w = std::fabs(arc.sweep_rad);
  const double dr = std::fabs(arc.radius_end_u - arc.radius_begin_u);
  const double r = std::max(arc.radius_begin_u, arc.radius_end_u);
  const double r_min = std::min(arc.radius_begin_u, arc.radius_end_u);
  ArcBounds b;
  const double l2 = length_u * length_u;
  b.tangent = std::sqrt(dr * dr + r * w * r * w) / length_u;
  b.curvature = (2.0 * dr * w + r * w * w) / l2;
  b.turning = (3.0 * dr * w * w + r * w * w * w) / (l2 * length_u);
  // |x' . x''| <= skew |x'| |x''|: |a x' + b x''|^2 <= (1 + skew) (|a x'|^2 + |b x''|^2)
  if (dr > 0.0) b.skew = std::sqrt(1.0 + (6.0 * dr < r_min * w ? 6.0 * dr / (r_min * w) : 1.0));
  const double to = arc.angle_begin_rad + arc.sweep_rad;
  b.first_tangent = (dr + r * w * largest_sine(arc.angle_begin_rad, to)) / length_u;
  b.second_tangent = (dr + r * w * largest_sine(arc.angle_begin_rad + 0.5 * kPi, to + 0.5 * kPi)) / length_u;
  return b;
}

/// A guard: Newton ends when a step no longer falls.
constexpr int kCubeRootSteps = 60;

/// Real cube root of x >= 0 by Newton from above, falling steps only: + - * / and powers of two alone.
double cube_root(double x) {
  if (!(x > 0.0) || x == kInfinity) return x;
  int exponent = 0;
  std::frexp(x, &exponent);  // x < 2^exponent
  double r = std::ldexp(1.0, exponent > 0 ? (exponent + 2) / 3 : exponent / 3);
  for (int i = 0; i < kCubeRootSteps; ++i) {
    const double next = (2.0 * r + x / (r * r)) / 3.0;
    if (!(next < r)) break;
    r = next;
  }
  return r;
}

/// Part of an axis' acceleration that may go into turning.
double normal_share(double accel, double centripetal) {
  return centripetal < kInfinity ? std::clamp(centripetal / accel, kNormalShare, kNormalShareMost)
                                 : kNormalShare;
}

/// One circular axis on an arc: the normal part first takes its share of speed, then the tangential limits follow.
void lower_speed_on_arc(SegmentCaps& caps, const ArcBounds& b, const machine::AxisModel& axis, int index,
                        double centripetal) {
  const double accel = axis.max_accel_u_s2 / b.skew;
  caps.lower_speed(std::sqrt(normal_share(accel, centripetal) * accel / b.curvature), LimitedBy::centripetal,
                   index);
  const double jerk = axis.max_jerk_u_s3 / b.skew;
  caps.lower_speed(cube_root(kTurningJerkShare * jerk / b.turning), LimitedBy::centripetal, index);
}

void lower_tangential_on_arc(SegmentCaps& caps, const ArcBounds& b, const machine::AxisModel& axis) {
  const double v = caps.speed;
  const double accel = axis.max_accel_u_s2 / b.skew;
  const double normal = v * v * b.curvature;
  caps.lower_accel(std::sqrt(std::max(accel * accel - normal * normal, 0.0)) / b.tangent);
  const double jerk = axis.max_jerk_u_s3 / b.skew;
  caps.lower_accel(kNormalJerkShare * jerk / (3.0 * v * b.curvature));
  if (jerk < kInfinity) caps.lower_jerk((kTangentJerkShare * jerk - v * v * v * b.turning) / b.tangent);
}

/// One axis on a curve: as on an arc, with the axis's share of the motion in the plane of the curve.
void lower_speed_on_curve(SegmentCaps& caps, const CurveBounds& b, const machine::AxisModel& axis, int index,
                          double centripetal) {
  const auto j = static_cast<std::size_t>(index);
  if (!(b.plane[j] > 0.0)) return;
  const double accel = axis.max_accel_u_s2 / b.plane[j];
  caps.lower_speed(std::sqrt(normal_share(accel, centripetal) * accel / b.curvature_per_u),
                   LimitedBy::centripetal, index);
  caps.lower_speed(cube_root(kTurningJerkShare * axis.max_jerk_u_s3 / b.third_u2[j]), LimitedBy::centripetal,
                   index);
}

void lower_tangential_on_curve(SegmentCaps& caps, const CurveBounds& b, const machine::AxisModel& axis,
                               std::size_t j) {
  if (!(b.plane[j] > 0.0)) return;
  const double v = caps.speed;
  const double accel = axis.max_accel_u_s2 / b.plane[j];
  const double normal = v * v * b.curvature_per_u;
  caps.lower_accel(std::sqrt(std::max(accel * accel - normal * normal, 0.0)));
  if (!(axis.max_jerk_u_s3 < kInfinity)) return;
  // the rest after the curve itself; its third derivative has any direction
  const double jerk = (axis.max_jerk_u_s3 - v * v * v * b.third_u2[j]) / b.plane[j];
  caps.lower_accel(kNormalJerkShare * jerk / (3.0 * v * b.curvature_per_u));
  caps.lower_jerk(kTangentJerkShare * jerk);
}

class TableMaker {
 public:
  TableMaker(const Path& path, const machine::MachineModel& machine, double feed_scale)
      : path_(path), machine_(machine), feed_scale_(feed_scale), axes_(machine.axis.size()) {
    const double tau = machine.clock.tau_s();
    for (std::size_t j = 0; j < axes_; ++j)
      speed_step_[j] =
          std::min(machine.axis[j].junction_accel_u_s2 * tau, machine.axis[j].junction_jerk_u_s3 * tau * tau);
  }

  tl::expected<PathLimitTable, PlanError> make() {
    const std::size_t n = path_.size();
    table_.cap_u_s.resize(2 * n + 1);
    table_.signature.resize(2 * n + 1);
    table_.accel_u_s2.resize(n);
    table_.jerk_u_s3.resize(n);
    table_.law = machine_.planner.law;
    table_.cap_u_s.front() = 0.0;
    table_.signature.front() = {LimitedBy::stop, -1};
    Ends ends[2];
    for (std::size_t i = 0; i < n; ++i) {
      Ends& now = ends[i & 1];
      measure_ends(i, now);
      const SegmentCaps caps = segment_caps(i, now);
      if (const char* wrong = fault(i, caps)) return tl::unexpected(refuse(i, wrong));
      table_.cap_u_s[2 * i + 1] = caps.speed;
      table_.signature[2 * i + 1] = caps.signature;
      table_.accel_u_s2[i] = caps.accel;
      table_.jerk_u_s3[i] = caps.jerk;
      if (i > 0) joint_cap(i, ends[(i - 1) & 1], now);
    }
    table_.cap_u_s.back() = 0.0;
    table_.signature.back() = {LimitedBy::stop, -1};
    return std::move(table_);
  }

 private:
  void measure_ends(std::size_t i, Ends& ends) const {
    eval_line_tangent(i, ends.tangent_begin);
    ends.curved = path_.segments[i].kind != SegmentKind::line;
    if (!ends.curved) {
      ends.tangent_end = ends.tangent_begin;
      return;
    }
    const double length = path_.segments[i].length_u;
    eval_tangent(path_, i, 0.0, {ends.tangent_begin.data(), axes_});
    eval_tangent(path_, i, length, {ends.tangent_end.data(), axes_});
    eval_curvature(path_, i, 0.0, {ends.curvature_begin.data(), axes_});
    eval_curvature(path_, i, length, {ends.curvature_end.data(), axes_});
  }

  void eval_line_tangent(std::size_t i, AxisVector& tangent) const {
    const double* from = path_.nodes_u.data() + i * axes_;
    const double length = path_.segments[i].length_u;
    for (std::size_t j = 0; j < axes_; ++j) tangent[j] = (from[axes_ + j] - from[j]) / length;
  }

  SegmentCaps segment_caps(std::size_t i, const Ends& ends) const {
    const PathSegment& seg = path_.segments[i];
    SegmentCaps caps;
    const machine::PathLimits& limits = machine_.path;
    const double scale = seg.length_u / seg.feed_length_u;
    if (!seg.rapid) {
      caps.lower_speed(seg.feed_u_s * feed_scale_, LimitedBy::program);
      if (seg.path_limits) caps.lower_speed(limits.max_feed_mm_s * scale, LimitedBy::path_feed);
    }
    if (seg.path_limits) {
      caps.lower_accel(limits.max_accel_mm_s2 * scale);
      caps.lower_jerk(limits.max_jerk_mm_s3 * scale);
    }
    // a segment without an acceleration limit of the path keeps those of the axes, whatever the setting
    const bool enforce =
        machine_.planner.axis_limits == machine::AxisLimitRule::enforce || caps.accel == kInfinity;
    if (seg.kind == SegmentKind::curve) return curve_caps(i, caps, enforce);
    const ArcShape* arc = seg.kind == SegmentKind::arc ? &path_.arc_of(i) : nullptr;
    const ArcBounds bounds = arc ? arc_bounds(*arc, seg.length_u) : ArcBounds{};
    if (arc)
      caps.lower_speed(std::sqrt(limits.centripetal_accel_mm_s2 / bounds.curvature), LimitedBy::centripetal);

    for (std::size_t j = 0; j < axes_; ++j) {
      const machine::AxisModel& axis = machine_.axis[j];
      const int index = static_cast<int>(j);
      const bool first = arc && index == arc->first_axis;
      const bool circular = first || (arc && index == arc->second_axis);
      const double share = circular ? (first ? bounds.first_tangent : bounds.second_tangent)
                                    : std::fabs(ends.tangent_begin[j]);
      if (share > 0.0 && (enforce || seg.rapid))
        caps.lower_speed(axis.max_feed_u_s / share, seg.rapid ? LimitedBy::rapid : LimitedBy::axis_speed,
                         index);
      if (!enforce) continue;
      if (circular) {
        lower_speed_on_arc(caps, bounds, axis, index, limits.centripetal_accel_mm_s2);
      } else if (share > 0.0) {
        caps.lower_accel(axis.max_accel_u_s2 / share);
        caps.lower_jerk(axis.max_jerk_u_s3 / share);
      }
    }
    if (arc && enforce)
      for (const int j : {arc->first_axis, arc->second_axis})
        lower_tangential_on_arc(caps, bounds, machine_.axis[static_cast<std::size_t>(j)]);
    return caps;
  }

  SegmentCaps curve_caps(std::size_t i, SegmentCaps caps, bool enforce) const {
    const CurveBounds bounds = curve_bounds(path_.curve_of(i));
    const double centripetal = machine_.path.centripetal_accel_mm_s2;
    caps.lower_speed(std::sqrt(centripetal / bounds.curvature_per_u), LimitedBy::centripetal);
    if (!enforce) return caps;
    for (std::size_t j = 0; j < axes_; ++j) {
      const machine::AxisModel& axis = machine_.axis[j];
      const int index = static_cast<int>(j);
      if (bounds.tangent[j] > 0.0)
        caps.lower_speed(axis.max_feed_u_s / bounds.tangent[j], LimitedBy::axis_speed, index);
      lower_speed_on_curve(caps, bounds, axis, index, centripetal);
    }
    for (std::size_t j = 0; j < axes_; ++j) lower_tangential_on_curve(caps, bounds, machine_.axis[j], j);
    return caps;
  }

  void joint_cap(std::size_t i, const Ends& before, const Ends& after) {
    const double v_before = table_.cap_u_s[2 * i - 1];
    const double v_after = table_.cap_u_s[2 * i + 1];
    double cap = std::min(v_before, v_after);
    Signature signature = table_.signature[v_before <= v_after ? 2 * i - 1 : 2 * i + 1];
    const bool curved = before.curved || after.curved;
    for (std::size_t j = 0; j < axes_; ++j) {
      const double turn = std::fabs(after.tangent_begin[j] - before.tangent_end[j]);
      double v = turn * cap > speed_step_[j] ? speed_step_[j] / turn : cap;
      if (curved) {
        const double step = std::fabs((after.curved ? after.curvature_begin[j] : 0.0) -
                                      (before.curved ? before.curvature_end[j] : 0.0));
        const double allowed = machine_.axis[j].junction_accel_u_s2;
        if (v * v * step > allowed) v = std::sqrt(allowed / step);
      }
      if (v < cap) cap = v, signature = {LimitedBy::junction, static_cast<std::int8_t>(j)};
    }
    if (path_.segments[i].begin_limit_u_s < cap)
      cap = path_.segments[i].begin_limit_u_s, signature = {LimitedBy::program, -1};
    const bool positions = is_positioning(path_, i - 1, machine_) || is_positioning(path_, i, machine_);
    if (path_.segments[i - 1].stop_at_end || positions) cap = 0.0, signature = {LimitedBy::stop, -1};
    table_.cap_u_s[2 * i] = cap;
    table_.signature[2 * i] = signature;
  }

  /// Error in a segment's limits, or nothing. Written so that NaN is an error too.
  const char* fault(std::size_t i, const SegmentCaps& caps) const {
    const PathSegment& seg = path_.segments[i];
    if (!seg.rapid && !(seg.feed_u_s > 0.0 && seg.feed_u_s < kInfinity)) return "feed";
    if (!(caps.speed > 0.0)) return "largest feed is zero";
    if (!(caps.speed < kInfinity)) return "nothing limits the feed";
    if (!(caps.accel > 0.0)) return "acceleration limit is zero";
    if (!(caps.accel < kInfinity)) return "nothing limits the acceleration";
    if (!(caps.jerk > 0.0)) return "jerk limit is zero";
    if (machine_.planner.law == machine::RampLaw::quintic && !(caps.jerk < kInfinity)) return kNoJerkLimit;
    return nullptr;
  }

  PlanError refuse(std::size_t i, const std::string& wrong) const {
    const PathSegment& seg = path_.segments[i];
    const bool feed = wrong == "feed";
    const bool quintic = wrong == kNoJerkLimit;
    Diagnostic d{};
    d.code = feed      ? Code::feed_not_plannable
             : quintic ? Code::quintic_without_jerk
                       : Code::limit_not_plannable;
    d.span = seg.span;
    d.message = std::string(code_entry(d.code).title);
    if (feed) {
      d.label = fmt::format("feed along the path is {} mm/s", seg.feed_u_s);
      d.notes.push_back("allowed: above 0 and finite");
      d.help = "set a feed with F before this move, e.g. F300";
    } else {
      std::string moving;
      for (std::size_t j = 0; j < axes_; ++j)
        if (path_.node(i)[j] != path_.node(i + 1)[j] || seg.kind == SegmentKind::arc)
          moving += machine_.axis[j].letter;
      d.label = wrong + " for this move of " + moving;
      if (quintic) {
        d.notes.push_back(
            "needed: a finite jerk limit of the axes or of [path] (planner.law is \"quintic\")");
        d.help = "give these axes a max_jerk, or set planner.law to \"jerk_limited\"";
      } else {
        d.notes.push_back("needed: speed and acceleration limits above 0 and finite, jerk above 0 or inf");
        d.help = "correct the limits of these axes (or of [path]) in the machine file";
      }
    }
    return {std::move(d)};
  }

  const Path& path_;
  const machine::MachineModel& machine_;
  double feed_scale_;
  std::size_t axes_;
  AxisVector speed_step_{};  // min(a_inst tau, j_inst tau^2)
  PathLimitTable table_;
};

}  // namespace

tl::expected<PathLimitTable, PlanError> limit_table(const Path& path, const machine::MachineModel& machine,
                                                    double feed_scale) {
  return TableMaker(path, machine, feed_scale).make();
}

}  // namespace kadr::planner
