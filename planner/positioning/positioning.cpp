#include "planner/positioning/positioning.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/path.h"
#include "planner/point_to_point/builders.h"
#include "planner/point_to_point/minimise.h"
#include "planner/point_to_point/residual.h"
#include "planner/positioning/damped_zero.h"
#include "planner/positioning/link_modes.h"

namespace kadr::planner {
namespace {

using machine::RapidShape;

constexpr double kSameMode = 1e-6;    ///< relative
constexpr double kMostPeriods = 1e4;  ///< in a motion: faster vibrations are negligible, and not tuned for
constexpr double kTShare = 0.01;  ///< of the distance between zeros of a T law: frequency known well enough
constexpr double kZvUncertainty = 0.01;
constexpr double kRampSearch = 0.03;  ///< of a period, either way
/// of the residual of a single jump of acceleration: a law without residual
constexpr double kSilent = 1e-3;
constexpr double kMostShifts = 50;
constexpr double kWhole = 1e-12;  ///< relative: a time that is whole up to rounding

/// A law before the impulses: constant acceleration, cruise and deceleration, averaged over a window.
struct Ramps {
  double ramp_s = 0, down_s = 0;  ///< of acceleration and deceleration
  double shift_s = 0;             ///< between the beginnings of both ramps
  double window_s = 0;            ///< 0: not averaged
  bool free_shift = true;         ///< a longer shift rings no more than this one
  double duration_s() const { return shift_s + down_s + window_s; }
};

PointLaw ramps_of(double distance_u, const Ramps& b) {
  return ramp_law(distance_u, b.ramp_s, std::max(b.shift_s - b.ramp_s, 0.0), b.down_s);
}

double whole_up(double x) { return std::max(1.0, std::ceil(x * (1.0 - kWhole))); }

bool same_mode(const Mode& a, const Mode& b) {
  return std::fabs(a.omega_rad_s - b.omega_rad_s) <= kSameMode * a.omega_rad_s &&
         std::fabs(a.zeta - b.zeta) <= kSameMode;
}

class Maker {
 public:
  explicit Maker(const PositioningTask& task) : task_(task), fastest_(fastest()) {
    for (const ExcitedMode& m : task.modes) {
      const Mode& mode = m.driven.mode;
      if (fastest_.duration_s() > kMostPeriods * mode.period_s()) continue;
      if (tuned_ == kMostTuned) break;
      if (tuned_ == 1 && same_mode(mode, mode_[0].driven.mode)) continue;
      mode_[tuned_++] = m;
    }
  }

  Positioning make() {
    Positioning out;
    out.shape = task_.shape;
    out.tuned = tuned_;
    if (tuned_ == 0)
      out.shape = RapidShape::scurve;
    else if (out.shape == RapidShape::automatic)
      choose(out);
    out.law = finished(out.shape == RapidShape::t_zero ? zero() : fastest_, out.shape);
    out.loss_s = out.law.duration_s() - fastest_.duration_s();
    return out;
  }

 private:
  double top_u_s(const Ramps& b) const {
    return task_.distance_u / (b.shift_s + 0.5 * (b.down_s - b.ramp_s));
  }
  double accel_u_s2(const Ramps& b) const { return top_u_s(b) / std::min(b.ramp_s, b.down_s); }

  /// The S-curve of least time; a jerk without limit makes it the T law of least time.
  Ramps fastest() const {
    const double d = task_.distance_u, v = task_.speed_u_s, j = task_.jerk_u_s3;
    const bool limited = j < machine::kInfinity;
    double a = limited ? std::min(task_.accel_u_s2, std::sqrt(v * j)) : task_.accel_u_s2;
    double window = limited ? a / j : 0.0;
    // to the speed limit and back: the cruise is as long as the window at least
    if (d / v >= v / a + window) return {v / a, v / a, d / v, window};
    a = task_.accel_u_s2;
    window = limited ? a / j : 0.0;
    const double ramp = 0.5 * (std::sqrt(window * window + 4.0 * d / a) - window);
    if (ramp >= window) return {ramp, ramp, ramp + window, window};
    const double third = exact_pow(d / (2.0 * j), 1.0 / 3.0);
    return {third, third, 2.0 * third, third};
  }

  void choose(Positioning& out) const {
    const double half_s = 0.5 * mode_[0].driven.mode.damped_period_s();
    const Ramps zero_law = zero();
    const PointLaw law = ramps_of(task_.distance_u, zero_law);
    const bool quick = zero_law.duration_s() - fastest_.duration_s() < half_s;
    // the zero of an interval of n periods is 1/n wide
    double periods = 0, left = 0;
    for (std::size_t i = 0; i < tuned_; ++i) {
      const DrivenMode& driven = mode_[i].driven;
      const double w = driven.mode.omega_rad_s;
      periods = std::max(periods, std::max(zero_law.ramp_s, zero_law.shift_s) / driven.mode.period_s());
      left =
          std::max(left, residual_amplitude_u(law, driven) * w * w / (driven.gain * law.peak_accel_u_s2()));
    }
    const bool silent = left <= kSilent, sharp = task_.uncertainty * periods <= kTShare;
    const bool zv = task_.uncertainty <= kZvUncertainty;
    if (silent && quick && sharp) {
      out.shape = RapidShape::t_zero;
      out.reason = "a T law is silent, loses less than half a period, and the frequency is known well enough";
      return;
    }
    out.shape = zv ? RapidShape::zv : RapidShape::zvd;
    out.reason = !zv ? "the frequency is not known to 1 %"
                 : tuned_ > 1
                     ? "two vibrations: shaping is silent at both, their frequencies are known to 1 %"
                 : !silent ? "with damping only shaping is silent, the frequency is known to 1 %"
                 : !quick  ? "a T law loses more than the half period of ZV"
                           : "the frequency is not known well enough for a T law of so many periods";
  }

  /// Fills whole ticks, then the impulses.
  PointLaw finished(Ramps b, RapidShape shape) const {
    double late = 0;
    for (std::size_t i = 0; i < tuned_; ++i) late += delay_s(shape, mode_[i].driven.mode);
    if (b.free_shift) {
      b.shift_s += missing_s(b.duration_s() + late);
    } else {
      // an average keeps the zeros too; two edges within one window add up
      const double more = missing_s(b.duration_s() + late);
      if (b.window_s + more > b.shift_s - b.ramp_s && task_.jerk_u_s3 < machine::kInfinity)
        b.window_s = 2.0 * accel_u_s2(b) / task_.jerk_u_s3;
      b.window_s += missing_s(b.duration_s() + late);
    }
    PointLaw law = ramps_of(task_.distance_u, b);
    if (b.window_s > 0) law = averaged(law, b.window_s);
    for (std::size_t i = 0; i < tuned_; ++i) {
      if (shape == RapidShape::zv) law = zv_shaped(law, mode_[i].driven.mode);
      if (shape == RapidShape::zvd) law = zvd_shaped(law, mode_[i].driven.mode);
    }
    return law;
  }

  /// To the next whole number of ticks.
  double missing_s(double time_s) const {
    if (!(task_.tick_s > 0)) return 0;
    const double more = whole_up(time_s / task_.tick_s) * task_.tick_s - time_s;
    return more > kWhole * time_s ? more : 0;
  }
  static double delay_s(RapidShape shape, const Mode& mode) {
    return shape == RapidShape::zv    ? 0.5 * mode.damped_period_s()
           : shape == RapidShape::zvd ? mode.damped_period_s()
                                      : 0.0;
  }

  /// Shortest shift for a ramp: limits of speed and acceleration, and a cruise as long as the window
  /// a/j = d/(ramp shift j).
  double shift_for(double ramp_s) const {
    const double d = task_.distance_u;
    const double root = std::sqrt(ramp_s * ramp_s + 4.0 * d / (ramp_s * task_.jerk_u_s3));
    return std::max({0.5 * (ramp_s + root), d / (task_.accel_u_s2 * ramp_s), d / task_.speed_u_s});
  }
  Ramps equal_ramps(double ramp_s, double shift_s, bool free_shift) const {
    return with_window({ramp_s, ramp_s, shift_s, 0, free_shift});
  }
  /// The averaging window that the jerk limit requires.
  Ramps with_window(Ramps b) const {
    if (task_.jerk_u_s3 < machine::kInfinity) b.window_s = accel_u_s2(b) / task_.jerk_u_s3;
    return b;
  }

  Ramps zero() const {
    Ramps best;
    const auto take = [&](const Ramps& b) {
      if (best.ramp_s == 0 || b.duration_s() < best.duration_s()) best = b;
    };
    const auto period = [&](std::size_t i) { return mode_[i].driven.mode.damped_period_s(); };
    if (tuned_ == 2) {
      for (const std::size_t ramp : {0u, 1u}) {
        const double t_ramp = period(ramp), t_shift = period(1 - ramp);
        for (double n = 1; best.ramp_s == 0 || n * t_ramp < best.duration_s(); ++n)
          take(equal_ramps(n * t_ramp, whole_up(shift_for(n * t_ramp) / t_shift) * t_shift, false));
      }
      return best;
    }
    // without a jerk limit the time is convex in the ramp and least at the fastest law's
    const double t = period(0);
    for (double n = 1; best.ramp_s == 0 || n * t < best.duration_s(); ++n)
      take(equal_ramps(n * t, shift_for(n * t), true));
    const double d = task_.distance_u;
    for (double m = whole_up(d / task_.speed_u_s / t); m * t < best.duration_s(); ++m) {
      const double shift = m * t, ramp = d / (task_.accel_u_s2 * shift);
      if (shift_for(ramp) <= shift * (1.0 + kWhole)) take(equal_ramps(ramp, shift, false));
    }
    if (!(mode_[0].driven.mode.zeta > 0)) return best;
    const std::optional<Ramps> silent = silent_damped();
    return silent ? *silent : tuned_to_least(best);
  }

  /// With damping: the fastest law that cancels its own vibration (damped_zero()) within the limits.
  std::optional<Ramps> silent_damped() const {
    const double period = mode_[0].driven.mode.damped_period_s();
    std::optional<Ramps> best;
    const double at = std::max(1.0, std::floor(fastest_.ramp_s / period));
    for (const double n : {at, at + 1})
      for (double from = shift_for(n * period), last = from + kMostShifts * period; from < last;
           from += period) {
        const std::optional<DampedZero> zero = damped_zero(mode_[0].driven.mode, n * period, from);
        if (!zero) break;
        const Ramps b = with_window({zero->ramp_s, n * period, zero->shift_s, 0, false});
        if (!within_limits(b)) continue;
        if (!best || b.duration_s() < best->duration_s()) best = b;
        break;
      }
    return best;
  }

  bool within_limits(const Ramps& b) const {
    constexpr double kRounding = 1.0 + 1e-12;
    return top_u_s(b) <= task_.speed_u_s * kRounding && accel_u_s2(b) <= task_.accel_u_s2 * kRounding &&
           b.shift_s - b.ramp_s >= b.window_s;
  }

  /// With damping, where none is silent: the ramp near a zero of the undamped vibration that leaves least.
  Ramps tuned_to_least(const Ramps& b) const {
    const DrivenMode& driven = mode_[0].driven;
    const double reach = kRampSearch * driven.mode.damped_period_s();
    const auto with = [&](double ramp_s) {
      return equal_ramps(ramp_s, std::max(b.shift_s, shift_for(ramp_s)), b.free_shift);
    };
    const Minimum least = minimise(
        [&](double ramp_s) { return residual_amplitude_u(ramps_of(task_.distance_u, with(ramp_s)), driven); },
        std::max(b.ramp_s - reach, 0.5 * b.ramp_s), b.ramp_s + reach, 1e-9 * b.ramp_s);
    return with(least.at);
  }

  const PositioningTask& task_;
  Ramps fastest_;
  std::array<ExcitedMode, kMostTuned> mode_{};
  std::size_t tuned_ = 0;
};

}  // namespace

void append_pieces(const PointLaw& law, double s_u, const Signature& why, std::vector<JerkPiece>& out) {
  const PointPiece& last = law.pieces().back();
  const double whole = law.distance_u() / last.at(last.duration_s).position_u;
  for (const PointPiece& p : law.pieces()) {
    const bool cruises = p.accel_u_s2 == 0.0 && p.jerk_u_s3 == 0.0;
    const Signature reason = cruises ? why : Signature{LimitedBy::length, -1};
    out.push_back({p.begin_s, p.duration_s, s_u + whole * p.position_u, whole * p.speed_u_s,
                   whole * p.accel_u_s2, whole * p.jerk_u_s3, reason.reason, reason.axis});
  }
}

Positioning plan_positioning(const PositioningTask& task) { return Maker(task).make(); }

double residual_u(const PointLaw& law, const ExcitedMode& mode) {
  return mode.share * residual_amplitude_u(law, mode.driven);
}

PositioningPlanner::PositioningPlanner(const machine::MachineModel& machine) : machine_(machine) {
  std::size_t most = 0;
  for (const machine::AxisModel& axis : machine.axis) {
    modes_.push_back(link_modes(axis));
    most += modes_.back().size();
  }
  excited_.reserve(most);  // the cycle plans rapids too, and allocates nothing
}

std::span<const ExcitedMode> PositioningPlanner::excited(const Path& path, std::size_t segment) {
  excited_.clear();
  const double length = path.segments[segment].length_u;
  for (std::size_t c = 0; c < modes_.size(); ++c) {
    const double share = std::fabs(path.node(segment + 1)[c] - path.node(segment)[c]) / length;
    if (!(share > 0)) continue;
    for (const DrivenMode& driven : modes_[c]) excited_.push_back({driven, static_cast<int>(c), share});
  }
  const auto swing = [](const ExcitedMode& m) {
    const double w = m.driven.mode.omega_rad_s;
    return m.share * m.driven.gain / (w * w);
  };
  std::stable_sort(excited_.begin(), excited_.end(),
                   [&](const ExcitedMode& a, const ExcitedMode& b) { return swing(a) > swing(b); });
  return excited_;
}

Positioning PositioningPlanner::plan(const Path& path, std::size_t segment, double speed_u_s,
                                     double accel_u_s2, double jerk_u_s3) {
  const machine::PlannerSettings& settings = machine_.planner;
  return plan_positioning({path.segments[segment].length_u, speed_u_s, accel_u_s2, jerk_u_s3,
                           excited(path, segment), settings.rapid_law, settings.rapid_frequency_pct / 100,
                           settings.whole_ticks ? machine_.clock.tau_s() : 0.0});
}

}  // namespace kadr::planner
