#include "planner/verify/verify.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/path.h"
#include "planner/verify/verify_blocks.h"
#include "planner/verify/verify_curve.h"
#include "planner/verify/verify_pauses.h"

namespace kadr::planner {
namespace {

using AxisVector = std::array<double, kProgramAxes>;

// of a piece's time: until both ends are neighbours
constexpr int kTimeSteps = 70;
// a curve's ends may miss the path's nodes by the rounding of its powers
constexpr double kCurveEnd_u = 1e-9;
// feeds of a thousandth of a millimetre per second take hours for a line: whole ticks and the ulp of such
// times change them by more than their relative tolerance, and by less than this, a step of 1 um in a day
constexpr double kSpeedFloor_u_s = 1e-8;
// a law's pieces add up their rounding: at most this many ulp of the time
constexpr double kTickUlps = 32.0;

using State = VerifiedState;
State at(const JerkPiece& p, double t) { return verified_state(p, t); }

/// x', x'', x''' with respect to s, from the definition of the shapes in path.h.
using Derivatives = VerifiedDerivatives;
Derivatives derivatives(const Path& path, std::size_t segment, double local_s) {
  const PathSegment& seg = path.segments[segment];
  const double length = seg.length_u;
  Derivatives d;
  for (int k = 0; k < path.axes(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    d.d1[i] = (path.node(segment + 1)[i] - path.node(segment)[i]) / length;
  }
  if (seg.kind == SegmentKind::curve) return verified_curve(path.curve_of(segment), local_s);
  if (seg.kind == SegmentKind::line) return d;
  const ArcShape& arc = path.arc_of(segment);
  const double u = std::clamp(local_s / length, 0.0, 1.0);
  const double dr = arc.radius_end_u - arc.radius_begin_u;
  const double r = arc.radius_begin_u + dr * u;
  const double w = arc.sweep_rad;
  const SinCos angle = exact_sincos(arc.angle_begin_rad + w * u);
  const auto set = [&](int axis, double e, double n) {
    const auto i = static_cast<std::size_t>(axis);
    d.d1[i] = (dr * e + r * w * n) / length;
    d.d2[i] = (2.0 * dr * w * n - r * w * w * e) / (length * length);
    d.d3[i] = (-3.0 * dr * w * w * e - r * w * w * w * n) / (length * length * length);
  };
  set(arc.first_axis, angle.cos, -angle.sin);
  set(arc.second_axis, angle.sin, angle.cos);
  return d;
}

class Verifier {
 public:
  Verifier(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
           const VerifyOptions& options, std::span<const Pause> pauses)
      : path_(path),
        plan_(plan),
        law_(plan.law),
        machine_(machine),
        options_(options),
        pauses_(pauses),
        blocks_(plan, machine) {
    tolerance_s_ = 16.0 * kUlp * std::max(path.length_u(), 1.0);
    for (const JerkPiece& p : law_.pieces) top_speed_ = std::max(top_speed_, p.speed_u_s);
  }

  std::vector<Violation> run() {
    if (path_.size() == 0) {
      if (!law_.pieces.empty() && pauses_.empty())
        report("law without path", 0.0, 0, -1, law_.duration_s, 0.0);
      check_pauses();
      return std::move(found_);
    }
    if (law_.pieces.empty()) {
      report("path without law", 0.0, 0, -1, 0.0, path_.length_u());
      return std::move(found_);
    }
    check_ends();
    for (std::size_t k = 0; k < law_.pieces.size() && !full(); ++k) check_link(k);
    if (path_.size() <= options_.whole_up_to) {
      check_window(0, path_.size());
    } else {
      for (std::size_t i = 0; i < path_.size() && !full(); i += options_.stride)
        check_window(i, std::min(i + options_.window, path_.size()));
      check_window(path_.size() - std::min(options_.window, path_.size()), path_.size());
    }
    check_stops();
    check_table();
    check_pauses();
    if (!full() && plan_.segments.size() == path_.size())
      verify_blocks(
          plan_, machine_, options_, pauses_.size(), [this](std::size_t i) { return jerk_limited(i); },
          found_);
    return std::move(found_);
  }

 private:
  bool full() const { return found_.size() >= options_.most; }
  void report(const char* what, double time, std::size_t segment, int axis, double value, double limit) {
    if (!full()) found_.push_back({what, time, static_cast<std::uint32_t>(segment), axis, value, limit});
  }
  /// Written so that NaN is a violation.
  void at_most(const char* what, double time, std::size_t segment, int axis, double value, double limit) {
    if (!(value <= limit * (1.0 + options_.relative_tolerance + loose_)))
      report(what, time, segment, axis, value, limit);
  }
  double speed_tolerance(double v, double a, double time) const {
    return options_.relative_tolerance * (std::fabs(v) + 1e-3 * top_speed_) +
           16.0 * kUlp * time * std::fabs(a) + kSpeedFloor_u_s;
  }

  /// A curve's ends are the path's nodes, its length is that of its chords, within what chords lose.
  void check_curve(std::size_t i) {
    const int chords = options_.chords;
    const double loss = 6.5 / (static_cast<double>(chords) * chords);
    const std::size_t axes = machine_.axis.size();
    const PathCurve& curve = path_.curve_of(i);
    const double length = path_.segments[i].length_u;
    AxisVector from{}, to{};
    double sum = 0, off = 0;
    for (int k = 0; k <= chords; ++k) {
      curve.position(static_cast<double>(k) / chords, {to.data(), axes});
      double square = 0;
      for (std::size_t j = 0; j < axes; ++j) {
        square += (to[j] - from[j]) * (to[j] - from[j]);
        if (k == 0) off = std::max(off, std::fabs(to[j] - path_.node(i)[j]));
        if (k == chords) off = std::max(off, std::fabs(to[j] - path_.node(i + 1)[j]));
      }
      if (k > 0) sum += std::sqrt(square);
      from = to;
    }
    if (!(off <= kCurveEnd_u)) report("ends of a curve", 0.0, i, -1, off, kCurveEnd_u);
    if (!(std::fabs(sum - length) <= loss * length) || curve.length_u() != length)
      report("length of a curve", 0.0, i, -1, length, sum);
  }

  // --- the law by itself
  // ------------------------------------------------------------------------------------------

  void check_ends() {
    const JerkPiece& first = law_.pieces.front();
    const JerkPiece& last = law_.pieces.back();
    const State end = at(last, last.duration_s);
    const std::size_t segment = path_.size() - 1;
    if (first.begin_s != 0.0 || std::fabs(first.s_u) > 0.0)
      report("start", first.begin_s, 0, -1, first.s_u, 0.0);
    if (std::fabs(first.speed_u_s) > 0.0) report("rest at the start", 0.0, 0, -1, first.speed_u_s, 0.0);
    const double tolerance =
        speed_tolerance(0.0, std::fabs(end.a) + std::fabs(end.j) * last.duration_s, law_.duration_s);
    if (!(std::fabs(end.v) <= tolerance))
      report("rest at the end", law_.duration_s, segment, -1, end.v, tolerance);
    if (!(std::fabs(end.s - path_.length_u()) <= way_tolerance(last)) || law_.length_u != path_.length_u())
      report("length", law_.duration_s, segment, -1, end.s, path_.length_u());
    if (!(std::fabs(last.begin_s + last.duration_s - law_.duration_s) <= 4.0 * kUlp * law_.duration_s))
      report("duration", law_.duration_s, segment, -1, last.begin_s + last.duration_s, law_.duration_s);
  }

  double way_tolerance(const JerkPiece& p) const { return way_tolerance(p, at(p, p.duration_s)); }
  double way_tolerance(const JerkPiece& p, const State& end) const {
    return tolerance_s_ + 16.0 * kUlp * law_.duration_s * std::max(p.speed_u_s, end.v) +
           1e-3 * options_.relative_tolerance * (end.s - p.s_u);
  }

  void check_link(std::size_t k) {
    const JerkPiece& p = law_.pieces[k];
    if (!(p.duration_s > 0.0)) report("piece without duration", p.begin_s, segment_, -1, p.duration_s, 0.0);
    if (k + 1 == law_.pieces.size()) return;
    const JerkPiece& q = law_.pieces[k + 1];
    const State end = at(p, p.duration_s);
    if (!(std::fabs(p.begin_s + p.duration_s - q.begin_s) <= 4.0 * kUlp * q.begin_s))
      report("gap in time", q.begin_s, segment_, -1, p.begin_s + p.duration_s, q.begin_s);
    if (!(std::fabs(end.s - q.s_u) <= way_tolerance(p, end)))
      report("continuity of s", q.begin_s, segment_, -1, end.s, q.s_u);
    const double steep = std::fabs(end.a) + std::fabs(end.j) * p.duration_s;
    const double jump = blocks_.stated_jump_u_s(q.begin_s);
    if (!(std::fabs(end.v + jump - q.speed_u_s) <= speed_tolerance(end.v, steep, q.begin_s)))
      report("continuity of speed", q.begin_s, segment_, -1, end.v, q.speed_u_s);
    // acceleration may jump only where a segment at this place has no jerk limit
    const double scale =
        std::max(std::fabs(p.accel_u_s2), std::fabs(q.accel_u_s2)) + std::fabs(end.j) * p.duration_s;
    const double tolerance = options_.relative_tolerance * scale + 32.0 * kUlp * q.begin_s * std::fabs(end.j);
    if (!(std::fabs(end.a - q.accel_u_s2) <= tolerance) && jerk_limited_around(q.s_u))
      report("continuity of acceleration", q.begin_s, segment_, -1, end.a, q.accel_u_s2);
    if (machine_.planner.law == machine::RampLaw::quintic && !by_law() &&
        (end.j != 0.0 || at(q, 0.0).j != 0.0) && !positions(segment_at(0.5 * (p.s_u + end.s))) &&
        !positions(segment_at(q.s_u)))
      report("continuity of jerk", q.begin_s, segment_, -1, end.j, at(q, 0.0).j);
  }

  /// A time law knows no ramps.
  bool by_law() const {
    return machine_.planner.method != machine::PlanMethod::scheduler &&
           machine_.planner.scheduler == machine::SchedulerKind::chained;
  }
  bool jerk_limited_around(double s) const {
    const std::size_t at_s = segment_at(s);
    for (std::size_t i = at_s > 0 ? at_s - 1 : 0; i <= std::min(at_s + 1, path_.size() - 1); ++i) {
      const bool near = path_.start_s_u[i] <= s + tolerance_s_ && path_.start_s_u[i + 1] >= s - tolerance_s_;
      if (near && !jerk_limited(i)) return false;
    }
    return true;
  }
  bool jerk_limited(std::size_t i) const {
    if (!machine_.planner.keeps_jerk()) return false;
    const PathSegment& seg = path_.segments[i];
    if (seg.path_limits && machine_.path.max_jerk_mm_s3 < machine::kInfinity) return true;
    if (!axes_enforced(seg)) return false;
    for (std::size_t j = 0; j < machine_.axis.size(); ++j)
      if (moves(i, j) && machine_.axis[j].max_jerk_u_s3 < machine::kInfinity) return true;
    return false;
  }
  bool moves(std::size_t i, std::size_t axis) const {
    const PathSegment& seg = path_.segments[i];
    if (path_.node(i)[axis] != path_.node(i + 1)[axis]) return true;
    if (seg.kind == SegmentKind::line) return false;
    if (seg.kind == SegmentKind::curve) return path_.curve_of(i).moves(axis);
    const ArcShape& arc = path_.arc_of(i);
    return static_cast<int>(axis) == arc.first_axis || static_cast<int>(axis) == arc.second_axis;
  }
  bool axes_enforced(const PathSegment& seg) const {
    return machine_.planner.axis_limits == machine::AxisLimitRule::enforce || !seg.path_limits ||
           !(machine_.path.max_accel_mm_s2 < machine::kInfinity);
  }

  std::size_t segment_at(double s) const {
    // most questions are about the segment of the last one, or the next
    for (std::size_t i = hint_; i < std::min(hint_ + 2, path_.size() - 1); ++i)
      if (path_.start_s_u[i] <= s && s < path_.start_s_u[i + 1]) return hint_ = i;
    const auto it = std::upper_bound(path_.start_s_u.begin(), path_.start_s_u.end(), s);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(it - path_.start_s_u.begin() - 1, 0));
    return hint_ = std::min(i, path_.size() - 1);
  }

  // --- the law on the path
  // ----------------------------------------------------------------------------------------

  /// The law over the segments from `first` to the one before `last`.
  void check_window(std::size_t first, std::size_t last) {
    const double from_s = path_.start_s_u[first], to_s = path_.start_s_u[last];
    for (std::size_t i = first; i < last && !full(); ++i)
      if (path_.segments[i].kind == SegmentKind::curve) check_curve(i);
    auto p = std::partition_point(law_.pieces.begin(), law_.pieces.end(),
                                  [&](const JerkPiece& piece) { return piece.s_u < from_s; });
    if (p != law_.pieces.begin()) --p;  // it begins before the window and may reach into it
    for (; p != law_.pieces.end() && p->s_u <= to_s && !full(); ++p) check_piece(*p, first, last);
  }

  void check_piece(const JerkPiece& p, std::size_t first, std::size_t last) {
    const double end = p.duration_s;
    const double s_end = at(p, end).s;
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
    if (options_.sample_s < machine::kInfinity) look_on_grid(p);
    for (std::size_t i = std::max(segment_at(p.s_u), first);
         i < last && path_.start_s_u[i] <= s_end && !full(); ++i) {
      if (i > first && path_.start_s_u[i] >= p.s_u) check_joint(p, i);
      if (path_.segments[i].kind == SegmentKind::arc) look_at_quadrants(p, i);
      look_along(p, i);
    }
  }

  /// Samples on a fixed grid of time, so that short pieces do not each get their own.
  void look_on_grid(const JerkPiece& p) {
    const double begin = std::ceil(p.begin_s / options_.sample_s);
    const double count = std::min((p.begin_s + p.duration_s) / options_.sample_s - begin, 1e7);
    for (double i = 0.0; i < count && !full(); i += 1.0)
      look_inside(p, (begin + i) * options_.sample_s - p.begin_s);
  }

  /// Places of an arc where one of its coordinates turns round, or the other is fastest.
  void look_at_quadrants(const JerkPiece& p, std::size_t i) {
    const ArcShape& arc = path_.arc_of(i);
    const double length = path_.segments[i].length_u;
    const double s_end = at(p, p.duration_s).s;
    const double quarter = kPi / 2.0;
    const auto angle = [&](double s) {
      return arc.angle_begin_rad + arc.sweep_rad * std::clamp((s - path_.start_s_u[i]) / length, 0.0, 1.0);
    };
    const double low = std::min(angle(p.s_u), angle(s_end));
    const double high = std::max(angle(p.s_u), angle(s_end));
    const double first = std::ceil(low / quarter);
    for (double n = first; n * quarter <= high && n - first < options_.quadrants && !full(); n += 1.0) {
      const double s = path_.start_s_u[i] + length * (n * quarter - arc.angle_begin_rad) / arc.sweep_rad;
      look_inside(p, time_of(p, s));
    }
  }

  /// Places of a segment, wherever the times of the grid fall: the middle of what a piece does on a line,
  /// whose limits are the same all along, and equal parts of an arc or a curve.
  void look_along(const JerkPiece& p, std::size_t i) {
    const double s_end = at(p, p.duration_s).s;
    const double from = path_.start_s_u[i], to = path_.start_s_u[i + 1];
    if (path_.segments[i].kind == SegmentKind::line) {
      const double s = 0.5 * (std::max(from, p.s_u) + std::min(to, s_end));
      if ((from > p.s_u || to < s_end) && s > p.s_u && s < s_end) look_inside(p, time_of(p, s));
      return;
    }
    for (int k = 1; k < options_.parts; ++k) {
      const double s = from + path_.segments[i].length_u * k / options_.parts;
      if (s > p.s_u && s < s_end) look_inside(p, time_of(p, s));
    }
  }

  /// When a piece reaches s: Newton's method in a bracket that bisection closes.
  double time_of(const JerkPiece& p, double s) const {
    double low = 0.0, high = p.duration_s;
    const double way = at(p, high).s - p.s_u;
    double t = way > 0.0 ? std::clamp(high * (s - p.s_u) / way, low, high) : high;
    for (int i = 0; i < kTimeSteps && low < high; ++i) {
      const State x = at(p, t);
      (x.s < s ? low : high) = t;
      const double next = x.v > 0.0 ? t - (x.s - s) / x.v : low;
      if (next == t) break;
      t = next > low && next < high ? next : 0.5 * (low + high);
    }
    return t;
  }

  void look_inside(const JerkPiece& p, double t) {
    if (t > 0.0 && t < p.duration_s) look(p, t);
  }

  void look(const JerkPiece& p, double t) {
    const State x = at(p, t);
    const double time = p.begin_s + t;
    // a quintic ramp's acceleration and jerk follow from its duration, which ends at rounded times
    loose_ = p.quintic_rise_u_s != 0.0 ? 32.0 * kUlp * time / p.duration_s : 0.0;
    segment_ = segment_at(x.s);
    if (!(x.v >= -speed_tolerance(0.0, std::fabs(x.a) + std::fabs(x.j) * p.duration_s, time)))
      report("speed below zero", time, segment_, -1, x.v, 0.0);
    // where s can't tell two segments apart, one of them has to allow it
    std::size_t first = segment_, last = segment_;
    if (first > 0 && x.s - path_.start_s_u[first] <= tolerance_s_) --first;
    if (last + 1 < path_.size() && path_.start_s_u[last + 1] - x.s <= tolerance_s_) ++last;
    const std::size_t before = found_.size();
    for (std::size_t i = first; i <= last; ++i) {
      const std::size_t mark = found_.size();
      check_limits(i, x, time);
      if (found_.size() == mark) {
        found_.resize(before);
        return;
      }
    }
  }

  void check_limits(std::size_t i, const State& x, double time) {
    const PathSegment& seg = path_.segments[i];
    const machine::PathLimits& limits = machine_.path;
    const double scale = seg.feed_length_u / seg.length_u;  // of F's length per s
    const bool keeps_jerk = machine_.planner.keeps_jerk();
    if (!seg.rapid) at_most("programmed feed", time, i, -1, x.v, seg.feed_u_s);
    if (!seg.rapid && seg.path_limits) at_most("path feed", time, i, -1, x.v * scale, limits.max_feed_mm_s);
    if (seg.path_limits) {
      at_most("path acceleration", time, i, -1, std::fabs(x.a) * scale, limits.max_accel_mm_s2);
      if (keeps_jerk) at_most("path jerk", time, i, -1, std::fabs(x.j) * scale, limits.max_jerk_mm_s3);
    }
    const Derivatives d = derivatives(path_, i, x.s - path_.start_s_u[i]);
    if (seg.kind == SegmentKind::arc) check_centripetal(i, x, d, time);
    const bool excused = seg.kind == SegmentKind::curve && is_excused(i);
    if (seg.kind == SegmentKind::curve && !excused) {
      double square = 0;
      for (const double d2 : d.d2) square += d2 * d2;
      at_most("centripetal acceleration", time, i, -1, x.v * x.v * std::sqrt(square),
              limits.centripetal_accel_mm_s2);
    }
    const bool enforced = axes_enforced(seg);
    for (std::size_t j = 0; j < machine_.axis.size(); ++j) {
      const machine::AxisModel& axis = machine_.axis[j];
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
    if (options_.curves_that_turn_back) return false;
    if (excused_segment_ != i) excused_ = turns_back(path_.curve_of(i));
    excused_segment_ = i;
    return excused_;
  }

  void check_centripetal(std::size_t i, const State& x, const Derivatives& d, double time) {
    const ArcShape& arc = path_.arc_of(i);
    const auto f = static_cast<std::size_t>(arc.first_axis);
    const auto g = static_cast<std::size_t>(arc.second_axis);
    // the part of x'' across the direction of motion in the plane
    const double across = std::fabs(d.d1[f] * d.d2[g] - d.d1[g] * d.d2[f]);
    const double along = std::sqrt(d.d1[f] * d.d1[f] + d.d1[g] * d.d1[g]);
    if (along > 0.0)
      at_most("centripetal acceleration", time, i, -1, x.v * x.v * across / along,
              machine_.path.centripetal_accel_mm_s2);
  }

  /// Joint i between segment i-1 and i, somewhere in this piece.
  void check_joint(const JerkPiece& p, std::size_t i) {
    loose_ = 0.0;
    const double s = path_.start_s_u[i];
    const double t = time_of(p, s);
    // where speed changes within the last bits of s or of time, the lowest of the speeds there counts
    double v = at(p, t).v;
    const double t0 = time_of(p, s - tolerance_s_);
    const double t1 = time_of(p, s + tolerance_s_);
    const double time = p.begin_s + t;
    v = std::min({v, at(p, t0).v, at(p, t1).v}) - 16.0 * kUlp * time * std::fabs(at(p, t).a);
    const Derivatives before = derivatives(path_, i - 1, path_.segments[i - 1].length_u);
    const Derivatives after = derivatives(path_, i, 0.0);
    const double tau = machine_.clock.tau_s();
    at_most("technology point", time, i, -1, v, path_.segments[i].begin_limit_u_s);
    for (std::size_t j = 0; j < machine_.axis.size(); ++j) {
      const machine::AxisModel& axis = machine_.axis[j];
      const double allowed = std::min(axis.junction_accel_u_s2 * tau, axis.junction_jerk_u_s3 * tau * tau);
      const double step = v * std::fabs(after.d1[j] - before.d1[j]);
      at_most("junction", time, i, static_cast<int>(j), step, allowed);
      at_most("curvature step", time, i, static_cast<int>(j), v * v * std::fabs(after.d2[j] - before.d2[j]),
              axis.junction_accel_u_s2);
    }
  }

  // --- stops, ticks and table
  // -------------------------------------------------------------------------------------

  /// A rapid of an axis with a flexible link, where such a rapid ends before anything else moves.
  bool positions(std::size_t i) const {
    if (machine_.planner.rapid_law == machine::RapidShape::scurve || !path_.segments[i].rapid) return false;
    for (std::size_t j = 0; j < machine_.axis.size(); ++j)
      if (moves(i, j) && machine_.axis[j].has_plant) return true;
    return false;
  }
  void check_pauses() {
    // the copies of a shaped rapid need not overlap
    const auto between_copies = [this](double s) {
      const std::size_t i = segment_at(s);
      return positions(i) && s - path_.start_s_u[i] > tolerance_s_ &&
             path_.start_s_u[i + 1] - s > tolerance_s_;
    };
    verify_pauses(path_, plan_, machine_, pauses_, tolerance_s_, between_copies, options_, found_);
  }

  void check_stops() {
    std::size_t k = 0;
    const double tau = machine_.clock.tau_s();
    const double ulps = kTickUlps + static_cast<double>(pauses_.size());  // every pause adds its rounding
    for (std::size_t i = 0; i < path_.size() && !full(); ++i) {
      const bool end = i + 1 == path_.size();
      const bool rapid = positions(i) || (!end && positions(i + 1));
      if (!path_.segments[i].stop_at_end && !end && !rapid) continue;
      const double s = path_.start_s_u[i + 1];
      // rest is a place between pieces, with speed zero there
      bool rests = false;
      double time = 0.0;
      for (; k < law_.pieces.size() && law_.pieces[k].s_u <= s + tolerance_s_; ++k) {
        const JerkPiece& p = law_.pieces[k];
        const State x = at(p, p.duration_s);
        time = p.begin_s + p.duration_s;
        const double steep = std::fabs(x.a) + std::fabs(x.j) * p.duration_s;
        rests = std::fabs(x.s - s) <= way_tolerance(p) && std::fabs(x.v) <= speed_tolerance(0.0, steep, time);
        if (rests) break;
      }
      // and may last a while
      for (; rests && k + 1 < law_.pieces.size() && stands(law_.pieces[k + 1]); ++k)
        time = law_.pieces[k + 1].begin_s + law_.pieces[k + 1].duration_s;
      if (!rests) report("rest at a stop", time, i, -1, s, s);
      if (!machine_.planner.whole_ticks || !rests) continue;
      const double off = std::fabs(time - std::floor(time / tau + 0.5) * tau);
      if (!(off <= kTickSlack_s + ulps * kUlp * time)) report("whole ticks", time, i, -1, off, kTickSlack_s);
    }
  }

  void check_table() {
    if (plan_.segments.size() != path_.size()) {
      report("table size", 0.0, 0, -1, static_cast<double>(plan_.segments.size()),
             static_cast<double>(path_.size()));
      return;
    }
    double time = 0.0, speed = 0.0;
    std::size_t hint = 0;
    HeldTimes held_times(pauses_);
    for (std::size_t i = 0; i < path_.size() && !full(); ++i) {
      const SegmentPlan& row = plan_.segments[i];
      const double held = held_times.held_s(i);
      const double late = std::fabs(row.begin_time_s - (time + held));
      if (!(late <= (held > 0.0 ? kHeldUlps * kUlp * row.begin_time_s : 0.0)) || !(row.end_time_s >= time))
        report("table times", time, i, -1, row.begin_time_s, time + held);
      if (!(row.peak_u_s >= std::max(speed, row.end_u_s) * (1.0 - options_.relative_tolerance)))
        report("table peak", time, i, -1, row.peak_u_s, speed);
      // where the speed jumps, the row tells the one before
      const double jump = blocks_.stated_jump_u_s(row.end_time_s);
      while (hint + 1 < law_.pieces.size() && (jump == 0.0 ? law_.pieces[hint + 1].begin_s <= row.end_time_s
                                                           : law_.pieces[hint + 1].begin_s < row.end_time_s))
        ++hint;
      const JerkPiece& p = law_.pieces[hint];
      time = row.end_time_s;
      speed = row.end_u_s + jump;
      if (path_.size() > options_.whole_up_to && i % options_.stride >= options_.window) continue;
      const State x = at(p, std::clamp(row.end_time_s - p.begin_s, 0.0, p.duration_s));
      if (!(std::fabs(x.s - path_.start_s_u[i + 1]) <= 1e2 * way_tolerance(p)))
        report("table place", row.end_time_s, i, -1, x.s, path_.start_s_u[i + 1]);
      // after hours the ulp of the time times the acceleration is more than a millionth of a crawling feed
      const double steep = std::fabs(p.accel_u_s2) + std::fabs(p.jerk_u_s3) * p.duration_s;
      if (!(std::fabs(x.v - row.end_u_s) <= 1e-6 * top_speed_ + speed_tolerance(0.0, steep, row.end_time_s)))
        report("table speed", row.end_time_s, i, -1, row.end_u_s, x.v);
    }
  }

  const Path& path_;
  const FeedPlan& plan_;
  const MotionLaw& law_;
  const machine::MachineModel& machine_;
  const VerifyOptions& options_;
  std::span<const Pause> pauses_;
  StatedJumps blocks_;
  double tolerance_s_ = 0;  // s can't be told apart below this
  double top_speed_ = 0;
  double loose_ = 0;              // further relative tolerance of what is looked at
  mutable std::size_t hint_ = 0;  // segment of the last segment_at()
  std::size_t excused_segment_ = static_cast<std::size_t>(-1);  // that is_excused() was asked about last
  bool excused_ = false;
  std::size_t segment_ = 0;
  std::vector<Violation> found_;
};

}  // namespace

VerifyOptions production_check() {
  VerifyOptions options;
  options.sample_s = machine::kInfinity;
  options.most = 1;
  options.parts = 4;
  options.quadrants = 8;
  options.chords = 16;
  options.curves_that_turn_back = false;
  options.whole_up_to = 64;
  options.window = 16;
  options.stride = 256;
  return options;
}

std::vector<Violation> verify(const Path& path, const FeedPlan& plan, const machine::MachineModel& machine,
                              const VerifyOptions& options, std::span<const Pause> pauses) {
  return Verifier(path, plan, machine, options, pauses).run();
}

}  // namespace kadr::planner
