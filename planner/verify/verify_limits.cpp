#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/verify/verify_context.h"
#include "planner/verify/verify_curve.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

using AxisVector = std::array<double, kProgramAxes>;

/// A curve's ends may miss the path's nodes by the rounding of its powers.
constexpr double kCurveEnd_u = 1e-9;
/// Samples of one piece by the grid of time: more tell nothing new.
constexpr double kMostSamples = 1e7;
/// A quintic ramp's acceleration and jerk follow from its duration, which ends at rounded times.
constexpr double kQuinticUlps = 32.0;
constexpr double kJointUlps = 16.0;  ///< of the time: a joint's speed

/// Derivatives of every joint by s at one place, or those of the path's own axes.
struct Derivatives {
  Derivatives(const Joints& joints, std::size_t segment, double local_s) {
    const std::size_t n = joints.size();
    joints.at(segment, local_s,
              {.d1 = {d1.data(), n}, .d2_per_u = {d2.data(), n}, .d3_per_u2 = {d3.data(), n}});
  }
  AxisVector d1{}, d2{}, d3{};
};

/// The law on the segments from `first` to the one before `last`.
class LimitVerifier {
 public:
  LimitVerifier(VerifyContext& context, std::size_t first, std::size_t last)
      : c_(context), first_(first), last_(last) {}

  void run() {
    const double from_s = c_.path.start_s_u[first_], to_s = c_.path.start_s_u[last_];
    for (std::size_t i = first_; i < last_ && !c_.full(); ++i)
      if (c_.path.segments[i].kind == SegmentKind::curve) check_curve(i);
    const std::vector<JerkPiece>& pieces = c_.law.pieces;
    auto p = std::partition_point(pieces.begin(), pieces.end(),
                                  [&](const JerkPiece& piece) { return piece.s_u < from_s; });
    if (p != pieces.begin()) --p;  // it begins before the window and may reach into it
    for (; p != pieces.end() && p->s_u <= to_s && !c_.full(); ++p) check_piece(*p);
  }

 private:
  /// Written so that NaN is a violation.
  void at_most(const char* what, double time, std::size_t segment, int axis, double value, double limit) {
    if (!(value <= limit * (1.0 + c_.options.relative_tolerance + loose_)))
      c_.report(what, time, segment, axis, value, limit);
  }

  /// A curve's ends are the path's nodes, its length is that of its chords, within what chords lose.
  void check_curve(std::size_t i) {
    const int chords = c_.options.chords;
    const double loss = 6.5 / (static_cast<double>(chords) * chords);
    const std::size_t axes = c_.machine.axis.size();
    const PathCurve& curve = c_.path.curve_of(i);
    const double length = c_.path.segments[i].length_u;
    AxisVector from{}, to{};
    double sum = 0, off = 0;
    for (int k = 0; k <= chords; ++k) {
      curve.position(static_cast<double>(k) / chords, {to.data(), axes});
      double square = 0;
      for (std::size_t j = 0; j < axes; ++j) {
        square += (to[j] - from[j]) * (to[j] - from[j]);
        if (k == 0) off = std::max(off, std::fabs(to[j] - c_.path.node(i)[j]));
        if (k == chords) off = std::max(off, std::fabs(to[j] - c_.path.node(i + 1)[j]));
      }
      if (k > 0) sum += std::sqrt(square);
      from = to;
    }
    if (!(off <= kCurveEnd_u)) c_.report("ends of a curve", 0.0, i, -1, off, kCurveEnd_u);
    if (!(std::fabs(sum - length) <= loss * length) || curve.length_u() != length)
      c_.report("length of a curve", 0.0, i, -1, length, sum);
  }

  void check_piece(const JerkPiece& p) {
    const double end = p.duration_s;
    const double s_end = verified_state(p, end).s;
    look(p, 0.0);
    look(p, end);
    if (stands(p)) return;
    if (p.quintic_rise_u_s != 0.0) {
      // largest acceleration in the middle, largest jerks where 1 - 6 x + 6 x^2 = 0
      for (const double x : {0.5, 0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)})
        look_inside(p, x * end);
    } else if (p.jerk_u_s3 != 0.0) {
      look_inside(p, -p.accel_u_s2 / p.jerk_u_s3);
    }
    if (c_.options.sample_s < machine::kInfinity) look_on_grid(p);
    for (std::size_t i = std::max(c_.segment_at(p.s_u), first_);
         i < last_ && c_.path.start_s_u[i] <= s_end && !c_.full(); ++i) {
      if (i > first_ && c_.path.start_s_u[i] >= p.s_u) check_joint(p, i);
      if (c_.path.segments[i].kind == SegmentKind::arc) look_at_quadrants(p, i);
      look_along(p, i);
    }
  }

  /// Samples on a fixed grid of time, so that short pieces do not each get their own.
  void look_on_grid(const JerkPiece& p) {
    const double begin = std::ceil(p.begin_s / c_.options.sample_s);
    const double count = std::min((p.begin_s + p.duration_s) / c_.options.sample_s - begin, kMostSamples);
    for (double i = 0.0; i < count && !c_.full(); i += 1.0)
      look_inside(p, (begin + i) * c_.options.sample_s - p.begin_s);
  }

  /// Places of an arc where one of its coordinates turns round, or the other is fastest.
  void look_at_quadrants(const JerkPiece& p, std::size_t i) {
    const ArcShape& arc = c_.path.arc_of(i);
    const double length = c_.path.segments[i].length_u;
    const double s_end = verified_state(p, p.duration_s).s;
    const double quarter = kPi / 2.0;
    const auto angle = [&](double s) {
      return arc.angle_begin_rad + arc.sweep_rad * std::clamp((s - c_.path.start_s_u[i]) / length, 0.0, 1.0);
    };
    const double low = std::min(angle(p.s_u), angle(s_end));
    const double high = std::max(angle(p.s_u), angle(s_end));
    const double first = std::ceil(low / quarter);
    for (double n = first; n * quarter <= high && n - first < c_.options.quadrants && !c_.full(); n += 1.0) {
      const double s = c_.path.start_s_u[i] + length * (n * quarter - arc.angle_begin_rad) / arc.sweep_rad;
      look_inside(p, c_.time_of(p, s));
    }
  }

  /// Places of a segment, wherever the times of the grid fall: the middle of what a piece does on a line,
  /// whose limits are the same all along, and equal parts of an arc or a curve.
  void look_along(const JerkPiece& p, std::size_t i) {
    const double s_end = verified_state(p, p.duration_s).s;
    const double from = c_.path.start_s_u[i], to = c_.path.start_s_u[i + 1];
    if (c_.path.segments[i].kind == SegmentKind::line) {
      const double s = 0.5 * (std::max(from, p.s_u) + std::min(to, s_end));
      if ((from > p.s_u || to < s_end) && s > p.s_u && s < s_end) look_inside(p, c_.time_of(p, s));
      return;
    }
    for (int k = 1; k < c_.options.parts; ++k) {
      const double s = from + c_.path.segments[i].length_u * k / c_.options.parts;
      if (s > p.s_u && s < s_end) look_inside(p, c_.time_of(p, s));
    }
  }

  void look_inside(const JerkPiece& p, double t) {
    if (t > 0.0 && t < p.duration_s) look(p, t);
  }

  void look(const JerkPiece& p, double t) {
    const VerifiedState x = verified_state(p, t);
    const double time = p.begin_s + t;
    // a quintic ramp's acceleration and jerk follow from its duration, which ends at rounded times
    loose_ = p.quintic_rise_u_s != 0.0 ? kQuinticUlps * kUlp * time / p.duration_s : 0.0;
    const std::size_t here = c_.segment_at(x.s);
    if (!(x.v >= -c_.speed_tolerance(0.0, std::fabs(x.a) + std::fabs(x.j) * p.duration_s, time)))
      c_.report("speed below zero", time, here, -1, x.v, 0.0);
    // where s can't tell two segments apart, one of them has to allow it
    std::size_t first = here, last = here;
    if (first > 0 && x.s - c_.path.start_s_u[first] <= c_.slack_u()) --first;
    if (last + 1 < c_.path.size() && c_.path.start_s_u[last + 1] - x.s <= c_.slack_u()) ++last;
    const std::size_t before = c_.found.size();
    for (std::size_t i = first; i <= last; ++i) {
      const std::size_t mark = c_.found.size();
      check_limits(i, x, time);
      if (c_.found.size() == mark) {
        c_.found.resize(before);
        return;
      }
    }
  }

  void check_limits(std::size_t i, const VerifiedState& x, double time) {
    const PathSegment& seg = c_.path.segments[i];
    const machine::PathLimits& limits = c_.machine.path;
    const double scale = seg.feed_length_u / seg.length_u;  // of F's length per s
    const bool keeps_jerk = c_.machine.planner.keeps_jerk();
    if (!seg.rapid) at_most("programmed feed", time, i, -1, x.v, seg.feed_u_s);
    if (!seg.rapid && seg.path_limits) at_most("path feed", time, i, -1, x.v * scale, limits.max_feed_mm_s);
    if (seg.path_limits) {
      at_most("path acceleration", time, i, -1, std::fabs(x.a) * scale, limits.max_accel_mm_s2);
      if (keeps_jerk) at_most("path jerk", time, i, -1, std::fabs(x.j) * scale, limits.max_jerk_mm_s3);
    }
    const double local_s = x.s - c_.path.start_s_u[i];
    const Derivatives d(c_.joints, i, local_s);
    const bool excused = seg.kind == SegmentKind::curve && is_excused(i);
    if (seg.kind != SegmentKind::line && !excused) {
      const Joints& axes = c_.joints.axes();
      if (&axes == &c_.joints)
        check_centripetal(i, x, d, time);
      else
        check_centripetal(i, x, Derivatives(axes, i, local_s), time);
    }
    const bool enforced = c_.axes_enforced(seg);
    for (std::size_t j = 0; j < c_.machine.axis.size(); ++j) {
      const machine::AxisModel& axis = c_.machine.axis[j];
      const int index = static_cast<int>(j);
      if (d.d1[j] == 0.0 && d.d2[j] == 0.0 && d.d3[j] == 0.0) continue;
      if (enforced || seg.rapid)
        at_most("axis speed", time, i, index, std::fabs(x.v * d.d1[j]), axis.max_feed_u_s);
      if (!enforced || excused) continue;
      at_most("axis acceleration", time, i, index, std::fabs(x.a * d.d1[j] + x.v * x.v * d.d2[j]),
              axis.max_accel_u_s2);
      if (!keeps_jerk) continue;
      at_most("axis jerk", time, i, index,
              std::fabs(x.j * d.d1[j] + 3.0 * x.v * x.a * d.d2[j] + x.v * x.v * x.v * d.d3[j]),
              axis.max_jerk_u_s3);
    }
  }

  /// Whether the planner is known to miss limits on this curve: the one exception (curves_that_turn_back).
  bool is_excused(std::size_t i) {
    if (c_.options.curves_that_turn_back) return false;
    if (excused_segment_ != i) excused_ = turns_back(c_.path.curve_of(i));
    excused_segment_ = i;
    return excused_;
  }

  /// A limit of the path: by the curvature of a curve, and of an arc in its plane.
  /// @param d  of the axes
  void check_centripetal(std::size_t i, const VerifiedState& x, const Derivatives& d, double time) {
    double curvature = 0;
    if (c_.path.segments[i].kind == SegmentKind::arc) {
      const ArcShape& arc = c_.path.arc_of(i);
      const auto f = static_cast<std::size_t>(arc.first_axis);
      const auto g = static_cast<std::size_t>(arc.second_axis);
      // the part of x'' across the direction of motion in the plane
      const double across = std::fabs(d.d1[f] * d.d2[g] - d.d1[g] * d.d2[f]);
      const double along = std::sqrt(d.d1[f] * d.d1[f] + d.d1[g] * d.d1[g]);
      if (!(along > 0.0)) return;
      curvature = across / along;
    } else {
      for (const double d2 : d.d2) curvature += d2 * d2;
      curvature = std::sqrt(curvature);
    }
    at_most("centripetal acceleration", time, i, -1, x.v * x.v * curvature,
            c_.machine.path.centripetal_accel_mm_s2);
  }

  /// Joint i between segment i-1 and i, somewhere in this piece.
  void check_joint(const JerkPiece& p, std::size_t i) {
    loose_ = 0.0;
    const double s = c_.path.start_s_u[i];
    const double t = c_.time_of(p, s);
    // where speed changes within the last bits of s or of time, the lowest of the speeds there counts
    double v = verified_state(p, t).v;
    const double t0 = c_.time_of(p, s - c_.slack_u());
    const double t1 = c_.time_of(p, s + c_.slack_u());
    const double time = p.begin_s + t;
    v = std::min({v, verified_state(p, t0).v, verified_state(p, t1).v}) -
        kJointUlps * kUlp * time * std::fabs(verified_state(p, t).a);
    const Derivatives before(c_.joints, i - 1, c_.path.segments[i - 1].length_u);
    const Derivatives after(c_.joints, i, 0.0);
    const double tau = c_.machine.clock.tau_s();
    at_most("technology point", time, i, -1, v, c_.path.segments[i].begin_limit_u_s);
    for (std::size_t j = 0; j < c_.machine.axis.size(); ++j) {
      const machine::AxisModel& axis = c_.machine.axis[j];
      const double allowed = std::min(axis.junction_accel_u_s2 * tau, axis.junction_jerk_u_s3 * tau * tau);
      const double step = v * std::fabs(after.d1[j] - before.d1[j]);
      at_most("junction", time, i, static_cast<int>(j), step, allowed);
      at_most("curvature step", time, i, static_cast<int>(j), v * v * std::fabs(after.d2[j] - before.d2[j]),
              axis.junction_accel_u_s2);
    }
  }

  VerifyContext& c_;
  std::size_t first_, last_;
  double loose_ = 0;  // further relative tolerance of what is looked at
  std::size_t excused_segment_ = static_cast<std::size_t>(-1);  // that is_excused() was asked about last
  bool excused_ = false;
};

}  // namespace

void verify_limits(VerifyContext& c, std::size_t first, std::size_t last) {
  LimitVerifier(c, first, last).run();
}

}  // namespace kadr::planner
