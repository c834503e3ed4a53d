#include "planner/scheduler/valley.h"

#include <algorithm>
#include <cmath>

#include "machine/base/require.h"
#include "machine/infinity.h"
#include "planner/path/path.h"
#include "planner/scheduler/shadow.h"
#include "planner/scheduler/valley_ramps.h"

namespace kadr::planner {
namespace {

/// Work still to do, leftmost on top of the stack. `direct` is the ramp that links the anchors' speeds and
/// fits between them (not set where they are equal).
struct Task {
  enum class Kind : std::uint8_t { region, ramp } kind = Kind::region;
  Anchor a, b;
  Ramp direct;
};

/// Speeds closer than this ratio are one level: no ramps between caps that differ by rounding.
constexpr double kSame = 1.0 + 1e-9;
constexpr int kPeakHalvings = 50;  ///< of a speed range: to its last bits
/// Limits that differ by less than this inside a region are taken as their minimum when two ramps meet below the level.
constexpr double kUniformEnough = 1.25;
/// Every region is cut at a place of its own or raised by 1 %, so these bounds are far away.
constexpr std::size_t kLeastRounds = 1000, kRoundsPerSegment = 64;

}  // namespace

class ValleyPlanner::Impl {
 public:
  Impl(const Path& path, const PathLimitTable& table) : r_(path, table) {}

  void plan(const Run& run, std::vector<Element>& elements) {
    out_ = &elements;
    stack_.clear();
    const Anchor a{r_.path.start_s_u[run.first], 0.0, 2 * run.first};
    const Anchor b{r_.path.start_s_u[run.last + 1], 0.0, 2 * run.last + 2};
    push_region(a, b, {});
    std::size_t rounds = 0;
    const std::size_t most_rounds = kLeastRounds + kRoundsPerSegment * (run.last - run.first + 1);
    while (!stack_.empty()) {
      require(++rounds <= most_rounds, "the valley rule ends");
      const Task task = stack_.back();
      stack_.pop_back();
      if (task.kind == Task::Kind::ramp)
        emit_ramp(task.a, task.b, task.direct.limits);
      else
        split(task.a, task.b, task.direct);
    }
  }

 private:
  void emit_ramp(const Anchor& a, const Anchor& b, RampLimits limits) {
    if (a.v == b.v) return emit_hold(a.s, b.s, a.v, {LimitedBy::length, -1});
    const Anchor& low = a.v < b.v ? a : b;
    Signature why{LimitedBy::length, -1};
    if (low.place % 2 == 0 && r_.table.signature[low.place].reason == LimitedBy::junction)
      why = r_.table.signature[low.place];
    out_->push_back({a.s, b.s - a.s, a.v, b.v, limits, why});
  }
  void emit_hold(double from, double to, double v, Signature why) {
    if (!(to > from) && why.reason != LimitedBy::length) return;
    if (!out_->empty() && out_->back().is_hold() && out_->back().v0_u_s == v && out_->back().signature == why)
      out_->back().length_u = to - out_->back().s_u;
    else
      out_->push_back({from, std::max(to - from, 0.0), v, v, {0, 0}, why});
  }

  void push_region(const Anchor& a, const Anchor& b, const Ramp& direct) {
    // two anchors at the same s: a ramp shorter than the last bit of s, or nothing
    if (b.s > a.s)
      stack_.push_back({Task::Kind::region, a, b, direct});
    else if (a.v != b.v)
      push_ramp(a, b, direct);
  }
  void push_ramp(const Anchor& a, const Anchor& b, const Ramp& r) {
    stack_.push_back({Task::Kind::ramp, a, b, r});
  }

  void split(const Anchor& a, const Anchor& b, const Ramp& direct) {
    const std::size_t first = a.first_inside();
    const std::size_t last = b.last_inside();
    const double higher = std::max(a.v, b.v);
    const double lowest = r_.caps.min(first, last);
    const double m = lowest > higher * kSame ? lowest : higher;
    if (m == a.v) return hold_level(a, b, direct);
    const Ramp up = m == b.v ? direct : r_.ramp_from(a, m, b);
    const Ramp down = m == b.v ? Ramp{} : r_.ramp_to(b, m, a);
    if (!(up.length + down.length <= b.s - a.s)) return meet_below(a, b, direct, m);
    const std::size_t place = r_.caps.find_at_most(m * kSame, first, last);
    require(place <= last, "the lowest cap of a region is found in it");
    const Anchor up_end = r_.anchor_after(a, up.length, m, b);
    const Anchor down_begin = r_.anchor_before(b, down.length, m, a);
    // ramps to a higher level are everywhere faster, so a place that these ramps leave at m can't be in a shadow
    const bool shadowed = r_.begin_of(place) < up_end.s || r_.begin_of(place) > down_begin.s;
    if (m > b.v && last > first && shadowed && use_shadows(a, b, m)) return;

    // the plain rule: reach m at the first place that has it, or wherever the ramp ends if that is later
    const Anchor at{std::max(r_.begin_of(place), a.s), m,
                    place % 2 == 0 || r_.begin_of(place) < a.s ? place : place - 1};
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

  /// The region's lowest cap m is the speed at a: keep it along the places that have it, continue after them.
  void hold_level(const Anchor& a, const Anchor& b, const Ramp& direct) {
    const double m = a.v;
    const Anchor down_begin = b.v < m ? r_.anchor_before(b, direct.length, m, a) : b;
    const std::size_t last = b.last_inside();
    std::size_t place = a.first_inside();
    double s = a.s;
    while (place <= last && r_.table.cap_u_s[place] <= m * kSame && s < down_begin.s) {
      const double to = std::min(r_.end_of(place), down_begin.s);
      if (to > s) emit_hold(s, to, m, r_.table.signature[place]);
      s = std::max(to, s);
      ++place;
    }
    if (s >= down_begin.s || place > last) {
      if (s < down_begin.s) emit_hold(s, down_begin.s, m, {LimitedBy::length, -1});
      if (b.v < m) emit_ramp(down_begin, b, direct.limits);
      return;
    }
    const Anchor here = place == a.first_inside() ? a : Anchor{s, m, place & ~std::size_t{1}};
    const std::size_t next = r_.caps.find_at_most(m * kSame, place, last);
    if (next <= last && r_.begin_of(next) <= down_begin.s) {
      const Anchor at{r_.begin_of(next), m, next & ~std::size_t{1}};
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
    const RampLimits lowest = r_.limits_between(first, last);
    double peak = floor;
    Ramp up = a.v < b.v ? direct : Ramp{};
    Ramp down = b.v < a.v ? direct : Ramp{};
    const bool fits = ramp_length_u(std::min(a.v, b.v), floor, lowest) <= d;
    if (fits && near_uniform(a, b, m, lowest)) {
      peak = peak_speed_u_s(a.v, b.v, d, lowest, floor, m);
      if (peak <= floor * kSame) peak = floor;
      up = ValleyRamps::make_ramp(a.v, peak, lowest);
      down = ValleyRamps::make_ramp(b.v, peak, lowest);
    } else if (m > floor) {
      double high = m;
      for (int i = 0; i < kPeakHalvings; ++i) {
        const double w = 0.5 * (peak + high);
        const Ramp u = r_.ramp_from(a, w, b);
        const Ramp v = r_.ramp_to(b, w, a);
        if (u.length + v.length <= d)
          peak = w, up = u, down = v;
        else
          high = w;
      }
    }
    const Anchor up_end = r_.anchor_after(a, up.length, peak, b);
    const Anchor down_begin = r_.anchor_before(b, down.length, peak, a);
    if (a.v < peak) emit_ramp(a, up_end, up.limits);
    emit_hold(up_end.s, std::max(down_begin.s, up_end.s), peak, {LimitedBy::length, -1});
    if (b.v < peak) {
      Anchor begin = down_begin;
      begin.s = std::max(begin.s, up_end.s);
      emit_ramp(begin, b, down.limits);
    }
  }

  bool near_uniform(const Anchor& a, const Anchor& b, double m, RampLimits lowest) const {
    if (r_.uniform()) return true;
    const RampLimits at_a = r_.ramp_from(a, m, b).limits;
    const RampLimits at_b = r_.ramp_to(b, m, a).limits;
    return std::max(at_a.accel_u_s2, at_b.accel_u_s2) <= kUniformEnough * lowest.accel_u_s2 &&
           std::max(at_a.jerk_u_s3, at_b.jerk_u_s3) <= kUniformEnough * lowest.jerk_u_s3;
  }

  bool use_shadows(const Anchor& a, const Anchor& b, double m) {
    const std::size_t first = a.first_inside();
    const std::size_t last = b.last_inside();
    const double third = (b.s - a.s) / 3.0;
    const std::size_t left_third = std::clamp(r_.locate_after(a.s + third, a.place, b.place), first, last);
    const std::size_t right_third =
        std::clamp(r_.locate_before(b.s - third, b.place, a.place), left_third, last);
    ShadowLevel level;
    if (find_level(r_, a, b, m, r_.caps.min(left_third, right_third), {true, true}, level)) {
      const bool left = keeps_below_caps(r_, a, level.up_end, level.up.limits, b);
      const bool right = keeps_below_caps(r_, level.down_begin, b, level.down.limits, b);
      if (left && right) {
        push_ramp(level.down_begin, b, level.down);
        push_region(level.up_end, level.down_begin, {});
        emit_ramp(a, level.up_end, level.up.limits);
        return true;
      }
    }
    if (find_level(r_, a, b, m, r_.caps.min(first, right_third), {false, true}, level) &&
        keeps_below_caps(r_, level.down_begin, b, level.down.limits, b)) {
      push_ramp(level.down_begin, b, level.down);
      push_region(a, level.down_begin, level.up);
      return true;
    }
    if (find_level(r_, a, b, m, r_.caps.min(left_third, last), {true, false}, level) &&
        keeps_below_caps(r_, a, level.up_end, level.up.limits, b)) {
      push_region(level.up_end, b, level.down);
      emit_ramp(a, level.up_end, level.up.limits);
      return true;
    }
    return false;
  }

  const ValleyRamps r_;
  std::vector<Element>* out_ = nullptr;
  std::vector<Task> stack_;
};

ValleyPlanner::ValleyPlanner(const Path& path, const PathLimitTable& table)
    : impl_(std::make_unique<Impl>(path, table)) {}
ValleyPlanner::~ValleyPlanner() = default;
void ValleyPlanner::plan(const Run& run, std::vector<Element>& out) { impl_->plan(run, out); }

}  // namespace kadr::planner
