#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "machine/infinity.h"
#include "planner/limits/range_min.h"
#include "planner/path/path.h"
#include "planner/scheduler/run_planner.h"

namespace kadr::planner {
namespace {

/// A point of the plan where acceleration is zero. `place` is the joint (even) or segment (odd) in which s
/// lies.
struct Anchor {
  double s = 0;
  double v = 0;
  std::size_t place = 0;
  std::size_t first_inside() const { return place + (place % 2 == 0 ? 1 : 0); }
  std::size_t last_inside() const { return place - (place % 2 == 0 ? 1 : 0); }
};

struct Ramp {
  double length = 0;
  RampLimits limits{0, 0};
};

/// Work still to do, leftmost on top of the stack. `direct` is the ramp that links the anchors' speeds and
/// fits between them (not set where they are equal).
struct Task {
  enum class Kind : std::uint8_t { region, ramp } kind = Kind::region;
  Anchor a, b;
  Ramp direct;
};

// a shadow is looked for when the level it may win is higher than the plain one by this factor
constexpr double kWorthwhile = 1.01;
// speeds closer than this ratio are one level: no ramps between caps that differ by rounding
constexpr double kSame = 1.0 + 1e-9;
constexpr int kPeakHalvings = 50;   // of a speed range: to its last bits
constexpr int kPlaceHalvings = 45;  // of a fraction of a ramp's time, to 3e-14
constexpr int kLevelRounds = 6;
constexpr std::size_t kFewPlaces = 4;  // so few are looked at one by one
constexpr int kValleyRounds = 12;
constexpr double kValleyMargin = 1.25;
// limits that differ by less than this inside a region are taken as their minimum when two ramps meet below
// the level
constexpr double kUniformEnough = 1.25;

}  // namespace

struct ValleyPlanner::Impl {
  const Path& path;
  const PathLimitTable& table;
  RangeMin caps, accels, jerks;
  bool uniform;
  std::vector<Element>* out = nullptr;
  std::vector<Task> stack;

  Impl(const Path& p, const PathLimitTable& t)
      : path(p), table(t), caps(t.cap_u_s), accels(t.accel_u_s2), jerks(t.jerk_u_s3) {
    const auto same = [](const std::vector<double>& v) {
      return std::adjacent_find(v.begin(), v.end(), std::not_equal_to<>()) == v.end();
    };
    uniform = same(t.accel_u_s2) && same(t.jerk_u_s3);
  }

  // --- places
  // ---------------------------------------------------------------------------------------------------

  double begin_of(std::size_t place) const { return path.start_s_u[place / 2]; }
  double end_of(std::size_t place) const { return path.start_s_u[(place + 1) / 2]; }

  /// Place of s, which is known to lie between two places: galloping from the first, then halving.
  std::size_t locate_after(double s, std::size_t from_place, std::size_t to_place) const {
    const std::vector<double>& start = path.start_s_u;
    std::size_t low = from_place / 2;  // start[low] <= s
    const std::size_t most = (to_place + 1) / 2;
    std::size_t step = 1;
    while (low + step <= most && start[low + step] <= s) low += step, step *= 2;
    std::size_t high = std::min(low + step, most + 1);  // start[high] > s, or beyond
    while (high - low > 1) {
      const std::size_t mid = low + (high - low) / 2;
      (start[mid] <= s ? low : high) = mid;
    }
    return start[low] == s || low == most ? 2 * low : 2 * low + 1;
  }
  std::size_t locate_before(double s, std::size_t from_place, std::size_t to_place) const {
    const std::vector<double>& start = path.start_s_u;
    std::size_t high = (from_place + 1) / 2;  // start[high] >= s
    const std::size_t least = to_place / 2;
    std::size_t step = 1;
    while (high >= least + step && start[high - step] >= s) high -= step, step *= 2;
    std::size_t low = high >= least + step ? high - step : least;
    if (start[low] >= s) return 2 * low;
    while (high - low > 1) {
      const std::size_t mid = low + (high - low) / 2;
      (start[mid] >= s ? high : low) = mid;
    }
    return start[high] == s ? 2 * high : 2 * low + 1;
  }
  Anchor anchor_after(const Anchor& a, double distance, double v, const Anchor& b) const {
    const double s = std::min(a.s + distance, b.s);
    return {s, v, locate_after(s, a.place, b.place)};
  }
  Anchor anchor_before(const Anchor& b, double distance, double v, const Anchor& a) const {
    const double s = std::max(b.s - distance, a.s);
    return {s, v, locate_before(s, b.place, a.place)};
  }

  // --- ramps with the lowest limits of the segments they span
  // -----------------------------------------------------

  RampLimits limits_between(std::size_t first, std::size_t last) const {
    if (uniform) return {table.accel_u_s2.front(), table.jerk_u_s3.front(), table.law};
    if (first == last) return {table.accel_u_s2[first], table.jerk_u_s3[first], table.law};
    return {accels.min(first, last), jerks.min(first, last), table.law};
  }

  /// Ramp between a.v and w that begins at a and goes towards b: grows until the segments it spans carry it.
  Ramp ramp_from(const Anchor& a, double w, const Anchor& b) const {
    const std::size_t first = a.place / 2;
    if (uniform) return make_ramp(a.v, w, limits_between(first, first));
    const std::size_t most = std::max(first, b.last_inside() / 2);
    std::size_t covered = first;
    Ramp r = make_ramp(a.v, w, limits_between(first, first));
    for (int i = 0; i < kValleyRounds; ++i) {
      if (covered == most || a.s + r.length <= path.start_s_u[covered + 1]) return r;
      const double reach = std::min(a.s + kValleyMargin * r.length, b.s);
      covered = std::min(locate_after(reach, a.place, b.place) / 2, most);
      r = make_ramp(a.v, w, limits_between(first, covered));
    }
    return make_ramp(a.v, w, limits_between(first, most));
  }
  /// The same for a ramp that ends at b, grown backwards towards a.
  Ramp ramp_to(const Anchor& b, double w, const Anchor& a) const {
    const std::size_t last = b.last_inside() / 2;
    if (uniform) return make_ramp(b.v, w, limits_between(last, last));
    const std::size_t least = std::min(last, a.first_inside() / 2);
    std::size_t covered = last;
    Ramp r = make_ramp(b.v, w, limits_between(last, last));
    for (int i = 0; i < kValleyRounds; ++i) {
      if (covered == least || b.s - r.length >= path.start_s_u[covered]) return r;
      const double reach = std::max(b.s - kValleyMargin * r.length, a.s);
      const std::size_t place = locate_before(reach, b.place, a.place);
      covered = std::max(place % 2 == 0 && place > 0 ? place / 2 - 1 : place / 2, least);
      r = make_ramp(b.v, w, limits_between(covered, last));
    }
    return make_ramp(b.v, w, limits_between(least, last));
  }
  static Ramp make_ramp(double v, double w, RampLimits limits) {
    return {ramp_length_u(std::min(v, w), std::max(v, w), limits), limits};
  }

  // --- output
  // -----------------------------------------------------------------------------------------------------

  void emit_ramp(const Anchor& a, const Anchor& b, RampLimits limits) {
    if (a.v == b.v) return emit_hold(a.s, b.s, a.v, {LimitedBy::length, -1});
    const Anchor& low = a.v < b.v ? a : b;
    Signature why{LimitedBy::length, -1};
    if (low.place % 2 == 0 && table.signature[low.place].reason == LimitedBy::junction)
      why = table.signature[low.place];
    out->push_back({a.s, b.s - a.s, a.v, b.v, limits, why});
  }
  void emit_hold(double from, double to, double v, Signature why) {
    if (!(to > from) && why.reason != LimitedBy::length) return;
    if (!out->empty() && out->back().is_hold() && out->back().v0_u_s == v && out->back().signature == why)
      out->back().length_u = to - out->back().s_u;
    else
      out->push_back({from, std::max(to - from, 0.0), v, v, {0, 0}, why});
  }

  void push_region(const Anchor& a, const Anchor& b, const Ramp& direct) {
    // two anchors that s can't tell apart: a ramp shorter than the last bit of s, or nothing
    if (b.s > a.s)
      stack.push_back({Task::Kind::region, a, b, direct});
    else if (a.v != b.v)
      push_ramp(a, b, direct);
  }
  void push_ramp(const Anchor& a, const Anchor& b, const Ramp& r) {
    stack.push_back({Task::Kind::ramp, a, b, r});
  }

  // --- the valley rule
  // --------------------------------------------------------------------------------------------

  void plan(const Run& run, std::vector<Element>& elements) {
    out = &elements;
    stack.clear();
    const Anchor a{path.start_s_u[run.first], 0.0, 2 * run.first};
    const Anchor b{path.start_s_u[run.last + 1], 0.0, 2 * run.last + 2};
    push_region(a, b, {});
    // every region is cut at a place of its own or raised by 1 %, so this bound is far away
    std::size_t rounds = 0;
    const std::size_t most_rounds = 1000 + 64 * (run.last - run.first + 1);
    while (!stack.empty()) {
      require(++rounds <= most_rounds, "the valley rule ends");
      const Task task = stack.back();
      stack.pop_back();
      if (task.kind == Task::Kind::ramp)
        emit_ramp(task.a, task.b, task.direct.limits);
      else
        split(task.a, task.b, task.direct);
    }
  }

  void split(const Anchor& a, const Anchor& b, const Ramp& direct) {
    const std::size_t first = a.first_inside();
    const std::size_t last = b.last_inside();
    const double higher = std::max(a.v, b.v);
    const double lowest = caps.min(first, last);
    const double m = lowest > higher * kSame ? lowest : higher;
    if (m == a.v) return hold_level(a, b, direct);
    const Ramp up = m == b.v ? direct : ramp_from(a, m, b);
    const Ramp down = m == b.v ? Ramp{} : ramp_to(b, m, a);
    if (!(up.length + down.length <= b.s - a.s)) return meet_below(a, b, direct, m);
    const std::size_t place = caps.find_at_most(m * kSame, first, last);
    require(place <= last, "the lowest cap of a region is found in it");
    const Anchor up_end = anchor_after(a, up.length, m, b);
    const Anchor down_begin = anchor_before(b, down.length, m, a);
    // ramps to a higher level are everywhere faster, so a place that these ramps leave at m can't be in a
    // shadow
    const bool shadowed = begin_of(place) < up_end.s || begin_of(place) > down_begin.s;
    if (m > b.v && last > first && shadowed && use_shadows(a, b, m)) return;

    // the plain rule: reach m at the first place that has it, or wherever the ramp ends if that is later
    const Anchor at{std::max(begin_of(place), a.s), m,
                    place % 2 == 0 || begin_of(place) < a.s ? place : place - 1};
    if (at.s > down_begin.s) {  // the way down already passes it
      push_ramp(down_begin, b, down);
      push_region(a, down_begin, up);
    } else if (at.s >= up_end.s) {
      push_region(at, b, down);
      push_region(a, at, up);
    } else {
      emit_ramp(a, up_end, up.limits);
      push_region(up_end, b, down);
    }
  }

  /// The region's lowest cap m is the speed at a: keep it along the places that have it, go on behind them.
  void hold_level(const Anchor& a, const Anchor& b, const Ramp& direct) {
    const double m = a.v;
    const Anchor down_begin = b.v < m ? anchor_before(b, direct.length, m, a) : b;
    const std::size_t last = b.last_inside();
    std::size_t place = a.first_inside();
    double s = a.s;
    while (place <= last && table.cap_u_s[place] <= m * kSame && s < down_begin.s) {
      const double to = std::min(end_of(place), down_begin.s);
      if (to > s) emit_hold(s, to, m, table.signature[place]);
      s = std::max(to, s);
      ++place;
    }
    if (s >= down_begin.s || place > last) {
      if (s < down_begin.s) emit_hold(s, down_begin.s, m, {LimitedBy::length, -1});
      if (b.v < m) emit_ramp(down_begin, b, direct.limits);
      return;
    }
    const Anchor here = place == a.first_inside() ? a : Anchor{s, m, place & ~std::size_t{1}};
    const std::size_t next = caps.find_at_most(m * kSame, place, last);
    if (next <= last && begin_of(next) <= down_begin.s) {
      const Anchor at{begin_of(next), m, next & ~std::size_t{1}};
      push_region(at, b, direct);
      push_region(here, at, {});
    } else {
      if (b.v < m) push_ramp(down_begin, b, direct);
      push_region(here, down_begin, {});
    }
  }

  /// The ramps meet below the level m.
  void meet_below(const Anchor& a, const Anchor& b, const Ramp& direct, double m) {
    const std::size_t first = a.first_inside() / 2;
    const std::size_t last = b.last_inside() / 2;
    const double d = b.s - a.s;
    const double floor = std::max(a.v, b.v);
    const RampLimits lowest = limits_between(first, last);
    double peak = floor;
    Ramp up = a.v < b.v ? direct : Ramp{};
    Ramp down = b.v < a.v ? direct : Ramp{};
    const bool fits = ramp_length_u(std::min(a.v, b.v), floor, lowest) <= d;
    if (fits && near_uniform(a, b, m, lowest)) {
      peak = peak_speed_u_s(a.v, b.v, d, lowest, floor, m);
      if (peak <= floor * kSame) peak = floor;
      up = make_ramp(a.v, peak, lowest);
      down = make_ramp(b.v, peak, lowest);
    } else if (m > floor) {
      double high = m;
      for (int i = 0; i < kPeakHalvings; ++i) {
        const double w = 0.5 * (peak + high);
        const Ramp u = ramp_from(a, w, b);
        const Ramp v = ramp_to(b, w, a);
        if (u.length + v.length <= d)
          peak = w, up = u, down = v;
        else
          high = w;
      }
    }
    const Anchor up_end = anchor_after(a, up.length, peak, b);
    const Anchor down_begin = anchor_before(b, down.length, peak, a);
    if (a.v < peak) emit_ramp(a, up_end, up.limits);
    emit_hold(up_end.s, std::max(down_begin.s, up_end.s), peak, {LimitedBy::length, -1});
    if (b.v < peak) {
      Anchor begin = down_begin;
      begin.s = std::max(begin.s, up_end.s);
      emit_ramp(begin, b, down.limits);
    }
  }

  bool near_uniform(const Anchor& a, const Anchor& b, double m, RampLimits lowest) const {
    if (uniform) return true;
    const RampLimits at_a = ramp_from(a, m, b).limits;
    const RampLimits at_b = ramp_to(b, m, a).limits;
    return std::max(at_a.accel_u_s2, at_b.accel_u_s2) <= kUniformEnough * lowest.accel_u_s2 &&
           std::max(at_a.jerk_u_s3, at_b.jerk_u_s3) <= kUniformEnough * lowest.jerk_u_s3;
  }

  // --- shadows
  // ----------------------------------------------------------------------------------------------------

  struct Level {
    double w = 0;
    Ramp up, down;
    Anchor up_end, down_begin;
  };

  /// Highest level whose ramps may pass places lower than it; false if nothing worthwhile is found.
  bool find_level(const Anchor& a, const Anchor& b, double m, double start, bool left, bool right,
                  Level& found) const {
    const std::size_t first = a.first_inside();
    const std::size_t last = b.last_inside();
    double w = start;
    for (int i = 0; i < kLevelRounds; ++i) {
      if (!(w > kWorthwhile * m)) return false;
      found = {w, ramp_from(a, w, b), ramp_to(b, w, a), {}, {}};
      if (!(found.up.length + found.down.length <= b.s - a.s)) {
        // too high to be reached: the peak two ramps can have, a little below to leave a plateau
        const RampLimits both{std::min(found.up.limits.accel_u_s2, found.down.limits.accel_u_s2),
                              std::min(found.up.limits.jerk_u_s3, found.down.limits.jerk_u_s3), table.law};
        const double floor = std::max(a.v, b.v);
        if (!(ramp_length_u(std::min(a.v, b.v), floor, both) <= b.s - a.s)) return false;
        w = peak_speed_u_s(a.v, b.v, b.s - a.s, both, floor, w) * (1.0 - 1e-12);
        continue;
      }
      found.up_end = anchor_after(a, found.up.length, w, b);
      found.down_begin = anchor_before(b, found.down.length, w, a);
      const std::size_t low = left ? found.up_end.place : first;
      const std::size_t high = right ? found.down_begin.place : last;
      const double lowest = low <= high ? caps.min(std::max(low, first), std::min(high, last)) : w;
      if (lowest >= w) return true;
      w = lowest;
    }
    return false;
  }

  bool use_shadows(const Anchor& a, const Anchor& b, double m) {
    const std::size_t first = a.first_inside();
    const std::size_t last = b.last_inside();
    const double third = (b.s - a.s) / 3.0;
    const std::size_t left_third = std::clamp(locate_after(a.s + third, a.place, b.place), first, last);
    const std::size_t right_third =
        std::clamp(locate_before(b.s - third, b.place, a.place), left_third, last);
    Level level;
    if (find_level(a, b, m, caps.min(left_third, right_third), true, true, level)) {
      const bool left = keeps_below_caps(a, level.up_end, level.up.limits, b);
      const bool right = keeps_below_caps(level.down_begin, b, level.down.limits, b);
      if (left && right) {
        push_ramp(level.down_begin, b, level.down);
        push_region(level.up_end, level.down_begin, {});
        emit_ramp(a, level.up_end, level.up.limits);
        return true;
      }
    }
    if (find_level(a, b, m, caps.min(first, right_third), false, true, level) &&
        keeps_below_caps(level.down_begin, b, level.down.limits, b)) {
      push_ramp(level.down_begin, b, level.down);
      push_region(a, level.down_begin, level.up);
      return true;
    }
    if (find_level(a, b, m, caps.min(left_third, last), true, false, level) &&
        keeps_below_caps(a, level.up_end, level.up.limits, b)) {
      push_region(level.up_end, b, level.down);
      emit_ramp(a, level.up_end, level.up.limits);
      return true;
    }
    return false;
  }

  /// Speed of the ramp p -> q at a fraction of its time, and the path up to there.
  static void ramp_at(const Anchor& p, const Anchor& q, RampLimits l, double fraction, double& s, double& v) {
    const double low = std::min(p.v, q.v);
    const double dv = std::fabs(q.v - p.v);
    const double time = ramp_time_s(dv, l);
    const bool rising = q.v > p.v;
    // measured from the low end; the second half mirrors the first about its middle
    const double t = time * (rising ? fraction : 1.0 - fraction);
    if (l.law == machine::RampLaw::quintic) {
      const JerkPiece piece{0.0, time, 0.0, low, 0.0, 0.0, {}, -1, dv};
      v = piece.speed_after_u_s(t);
      s = rising ? p.s + piece.way_u(t) : q.s - piece.way_u(t);
      return;
    }
    const double half = 0.5 * time;
    const double x = t <= half ? t : time - t;
    const double t_jerk = l.jerk_u_s3 * dv <= l.accel_u_s2 * l.accel_u_s2 ? half : l.accel_u_s2 / l.jerk_u_s3;
    double gain = 0.0, way = 0.0;  // speed above low, path beyond low * x
    const double jerk = t_jerk > 0.0 && l.jerk_u_s3 < machine::kInfinity ? l.jerk_u_s3 : 0.0;
    const double y = std::min(x, t_jerk);
    gain = 0.5 * jerk * y * y;
    way = jerk * y * y * y / 6.0;
    if (x > t_jerk) {
      const double z = x - t_jerk;
      way += gain * z + 0.5 * l.accel_u_s2 * z * z;
      gain += l.accel_u_s2 * z;
    }
    double from_low = low * x + way;
    v = low + gain;
    if (t > half) {
      v = low + dv - gain;
      // the whole ramp less what the mirror image has left
      from_low = 0.5 * (2.0 * low + dv) * time - ((low + dv) * x - way);
    }
    s = rising ? p.s + from_low : q.s - from_low;
  }

  /// The same question for a few places, between two fractions of the ramp's time: each by the speed with
  /// which the ramp comes to its higher end.
  bool below_each_cap(const Anchor& p, const Anchor& q, RampLimits limits, double t0, double t1,
                      std::size_t from, std::size_t to) const {
    for (std::size_t place = from; place <= to; ++place) {
      const double edge = q.v > p.v ? end_of(place) : begin_of(place);
      double low = t0, high = t1;
      double s, v;
      for (int i = 0; i < kPlaceHalvings; ++i) {
        const double mid = 0.5 * (low + high);
        ramp_at(p, q, limits, mid, s, v);
        (s < edge ? low : high) = mid;
      }
      ramp_at(p, q, limits, q.v > p.v ? low : high, s, v);
      if (v > table.cap_u_s[place]) return false;
    }
    return true;
  }

  /// True if the ramp p -> q is at or below every cap inside it (q and p themselves excepted). Halves in time
  /// until a part's highest speed is below the lowest cap it passes.
  bool keeps_below_caps(const Anchor& p, const Anchor& q, RampLimits limits, const Anchor& b) const {
    struct Part {
      double t0, t1;
      int depth;
    };
    constexpr int kDepth = 7;
    Part parts[kDepth + 2];
    int count = 0;
    parts[count++] = {0.0, 1.0, 0};
    const std::size_t first = p.first_inside();
    const std::size_t last = q.last_inside();
    if (first > last) return true;
    while (count > 0) {
      const Part part = parts[--count];
      double s0, v0, s1, v1;
      ramp_at(p, q, limits, part.t0, s0, v0);
      ramp_at(p, q, limits, part.t1, s1, v1);
      const auto place_at = [&](double s) {
        return std::clamp(locate_after(std::clamp(s, p.s, b.s), p.place, b.place), first, last);
      };
      const std::size_t from = part.t0 > 0.0 ? place_at(s0) : first;
      const std::size_t to = part.t1 < 1.0 ? std::max(place_at(s1), from) : last;
      const double lowest = caps.min(from, to);
      if (std::max(v0, v1) <= lowest) continue;
      if (std::min(v0, v1) > lowest) return false;
      if (to <= from + kFewPlaces) {
        if (!below_each_cap(p, q, limits, part.t0, part.t1, from, to)) return false;
        continue;
      }
      if (part.depth == kDepth) return false;
      const double mid = 0.5 * (part.t0 + part.t1);
      parts[count++] = {mid, part.t1, part.depth + 1};
      parts[count++] = {part.t0, mid, part.depth + 1};
    }
    return true;
  }
};

ValleyPlanner::ValleyPlanner(const Path& path, const PathLimitTable& table)
    : impl_(std::make_unique<Impl>(path, table)) {}
ValleyPlanner::~ValleyPlanner() = default;
void ValleyPlanner::plan(const Run& run, std::vector<Element>& out) { impl_->plan(run, out); }

}  // namespace kadr::planner
