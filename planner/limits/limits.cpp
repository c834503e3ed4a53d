#include "planner/limits/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/require.h"
#include "machine/machine.h"
#include "planner/path/joints.h"
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

/// A segment's joints at both of its ends, by joint.
struct Ends {
  AxisVector tangent_begin, tangent_end;
  AxisVector curvature_begin, curvature_end;  // not set where every joint runs straight
  bool straight = true;
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

/// Turning first takes its share of a joint's limits, which caps the speed ...
void lower_speed_by_turning(SegmentCaps& caps, const JointBounds& b, const machine::AxisModel& axis,
                            int index, double centripetal) {
  if (!(b.skew > 0.0)) return;
  const double accel = axis.max_accel_u_s2 / b.skew;
  caps.lower_speed(std::sqrt(normal_share(accel, centripetal) * accel / b.curvature_per_u),
                   LimitedBy::centripetal, index);
  const double jerk = b.course == JointCourse::circle ? axis.max_jerk_u_s3 / b.skew : axis.max_jerk_u_s3;
  caps.lower_speed(cube_root(kTurningJerkShare * jerk / b.third_per_u2), LimitedBy::centripetal, index);
}

/// ... and the rest, at that speed, is for accelerating along the path.
void lower_tangential(SegmentCaps& caps, const JointBounds& b, const machine::AxisModel& axis) {
  if (!(b.skew > 0.0)) return;
  const double v = caps.speed;
  const double accel = axis.max_accel_u_s2 / b.skew;
  const double normal = v * v * b.curvature_per_u;
  caps.lower_accel(std::sqrt(std::max(accel * accel - normal * normal, 0.0)) / b.tangent);
  if (!(axis.max_jerk_u_s3 < kInfinity)) return;
  const double turning = v * v * v * b.third_per_u2;
  if (b.course == JointCourse::circle) {
    const double jerk = axis.max_jerk_u_s3 / b.skew;
    caps.lower_accel(kNormalJerkShare * jerk / (3.0 * v * b.curvature_per_u));
    caps.lower_jerk((kTangentJerkShare * jerk - turning) / b.tangent);
  } else {
    // the third derivative has any direction
    const double jerk = (axis.max_jerk_u_s3 - turning) / b.skew;
    caps.lower_accel(kNormalJerkShare * jerk / (3.0 * v * b.curvature_per_u));
    caps.lower_jerk(kTangentJerkShare * jerk / b.tangent);
  }
}

class TableMaker {
 public:
  TableMaker(const Joints& joints, const machine::MachineModel& machine, double feed_scale)
      : joints_(joints),
        path_(joints.path()),
        machine_(machine),
        feed_scale_(feed_scale),
        axes_(machine.axis.size()) {
    require(joints.size() == axes_, "each joint has the limits of one axis");
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
      joints_.bound(i, bounds_);
      measure_ends(i, now);
      const SegmentCaps caps = segment_caps(i);
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
    ends.straight = bounds_.straight;
    if (ends.straight) {
      joints_.at(i, 0.0, {.d1 = {ends.tangent_begin.data(), axes_}});
      ends.tangent_end = ends.tangent_begin;
      return;
    }
    joints_.at(i, 0.0,
               {.d1 = {ends.tangent_begin.data(), axes_}, .d2_per_u = {ends.curvature_begin.data(), axes_}});
    joints_.at(i, path_.segments[i].length_u,
               {.d1 = {ends.tangent_end.data(), axes_}, .d2_per_u = {ends.curvature_end.data(), axes_}});
  }

  SegmentCaps segment_caps(std::size_t i) const {
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
    if (bounds_.curvature_per_u > 0.0)
      caps.lower_speed(std::sqrt(limits.centripetal_accel_mm_s2 / bounds_.curvature_per_u),
                       LimitedBy::centripetal);
    lower_by_joints(caps, seg, enforce);
    return caps;
  }

  void lower_by_joints(SegmentCaps& caps, const PathSegment& seg, bool enforce) const {
    for (std::size_t j = 0; j < axes_; ++j) {
      const machine::AxisModel& axis = machine_.axis[j];
      const JointBounds& b = bounds_.joint[j];
      const int index = static_cast<int>(j);
      if (b.slope > 0.0 && (enforce || seg.rapid))
        caps.lower_speed(axis.max_feed_u_s / b.slope, seg.rapid ? LimitedBy::rapid : LimitedBy::axis_speed,
                         index);
      if (!enforce) continue;
      if (b.course != JointCourse::straight) {
        lower_speed_by_turning(caps, b, axis, index, machine_.path.centripetal_accel_mm_s2);
      } else if (b.slope > 0.0) {
        caps.lower_accel(axis.max_accel_u_s2 / b.slope);
        caps.lower_jerk(axis.max_jerk_u_s3 / b.slope);
      }
    }
    if (!enforce || bounds_.straight) return;
    for (std::size_t j = 0; j < axes_; ++j)
      if (bounds_.joint[j].course != JointCourse::straight)
        lower_tangential(caps, bounds_.joint[j], machine_.axis[j]);
  }

  void joint_cap(std::size_t i, const Ends& before, const Ends& after) {
    const double v_before = table_.cap_u_s[2 * i - 1];
    const double v_after = table_.cap_u_s[2 * i + 1];
    double cap = std::min(v_before, v_after);
    Signature signature = table_.signature[v_before <= v_after ? 2 * i - 1 : 2 * i + 1];
    const bool straight = before.straight && after.straight;
    for (std::size_t j = 0; j < axes_; ++j) {
      const double turn = std::fabs(after.tangent_begin[j] - before.tangent_end[j]);
      double v = turn * cap > speed_step_[j] ? speed_step_[j] / turn : cap;
      if (!straight) {
        const double step = std::fabs((after.straight ? 0.0 : after.curvature_begin[j]) -
                                      (before.straight ? 0.0 : before.curvature_end[j]));
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

  const Joints& joints_;
  const Path& path_;
  const machine::MachineModel& machine_;
  double feed_scale_;
  std::size_t axes_;
  SegmentBounds bounds_;     // of the current segment
  AxisVector speed_step_{};  // min(a_inst tau, j_inst tau^2)
  PathLimitTable table_;
};

}  // namespace

tl::expected<PathLimitTable, PlanError> limit_table(const Joints& joints,
                                                    const machine::MachineModel& machine, double feed_scale) {
  return TableMaker(joints, machine, feed_scale).make();
}

tl::expected<PathLimitTable, PlanError> limit_table(const Path& path, const machine::MachineModel& machine,
                                                    double feed_scale) {
  return limit_table(*machine_joints(path, machine), machine, feed_scale);
}

}  // namespace kadr::planner
