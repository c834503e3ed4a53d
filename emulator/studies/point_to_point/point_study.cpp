#include "emulator/studies/point_to_point/point_study.h"

#include <fmt/format.h>

#include <cmath>

#include "machine/words.h"
#include "planner/planner.h"
#include "planner/positioning/positioning.h"

namespace kadr::studies {
namespace {

constexpr double kMostPeriods = 1e5;  ///< of the vibration in a motion: more angles than sines tell apart

using planner::PointFault;
using planner::PointLaw;

class Study {
 public:
  Study(const PointQuestion& question, const planner::DrivenMode& driven)
      : q_(question), task_(question.task) {
    out_.driven = driven;
    out_.load = q_.load;
    out_.shortest_s = planner::shortest_time_s(task_);
    if (q_.printed_gravity)
      out_.load.gravity_m_s2 =
          planner::printed_gravity_m_s2(task_.distance_u, q_.time_optimal ? out_.shortest_s : q_.time_s);
  }

  planner::PointResult<PointStudy> of_given_time() {
    const auto choice = planner::best_t_law(task_, q_.time_s, out_.driven, out_.load);
    if (!choice) return tl::unexpected(choice.error());
    const auto range = planner::xi_range(task_, q_.time_s);
    const auto zeros = planner::zero_laws(task_, q_.time_s, mode(), out_.load);
    out_.zeros = zeros ? zeros->size() : 0;
    for (std::size_t i = 1; choice->zero && i < out_.zeros; ++i)
      equal_ += std::fabs((*zeros)[i].energy_J - choice->energy_J) <= 1e-12 * choice->energy_J;
    add("T, chosen", planner::t_law(distance(), q_.time_s, choice->xi), choice->xi);
    out_.answer = answer(*choice);
    add("T, steepest ramps", planner::t_law(distance(), q_.time_s, range.low), range.low);
    // int a^2 of a T law is least at 1/3
    const double copper = std::min(std::max(1.0 / 3, range.low), range.high);
    add("T, least copper loss", planner::t_law(distance(), q_.time_s, copper), copper);
    for (const double xi : q_.xi) {
      if (!range.has(xi))
        return tl::unexpected(
            PointFault{PointFault::Kind::bad_share, "xi", xi, xi > range.high ? range.high : range.low, ""});
      add("T, xi given", planner::t_law(distance(), q_.time_s, xi), xi);
    }
    if (const auto twice = planner::double_zero_of(task_, q_.time_s, mode()))
      add(fmt::format("double zero {},{}", twice->ramp, twice->shift),
          planner::double_zero_law(distance(), period_s(), twice->ramp, twice->shift));
    if (const auto pick = planner::robust_asymmetric_law(task_, q_.time_s, out_.driven, kBands[2]))
      add(fmt::format("asymmetric T {},{}", pick->up, pick->down), pick->law);
    shaped([&](const std::string& name, double longer_s, auto shape) {
      const auto base = planner::steepest_t_law(task_, q_.time_s - longer_s);
      if (base)
        add(name, shape(*base));
      else
        out_.left_out.push_back(fmt::format("{} takes at least {:.6f} s", name, out_.shortest_s + longer_s));
    });
    return finished();
  }

  planner::PointResult<PointStudy> of_least_time() {
    const PointLaw fastest =
        planner::bang_bang_law(distance(), task_.speed_limit_u_s, task_.accel_limit_u_s2);
    const planner::FastZero zero = planner::fastest_zero_law(task_, mode());
    add("T, chosen", zero.law(distance()), zero.ramp_s / zero.duration_s());
    const bool ramp = zero.branch == planner::ZeroBranch::ramp;
    out_.answer = fmt::format(
        "T law of {:.6f} s, {} = {}: the fastest one {}, {:.3f} ms more than bang-bang", zero.duration_s(),
        ramp ? "n" : "m", zero.count,
        mode().zeta == 0.0 ? "without residual vibration" : "that would be silent without damping",
        1e3 * (zero.duration_s() - out_.shortest_s));
    add("bang-bang", fastest);
    const planner::DoubleZero twice = planner::fastest_double_zero(task_, mode());
    add(fmt::format("double zero {},{}", twice.ramp, twice.shift),
        planner::double_zero_law(distance(), period_s(), twice.ramp, twice.shift));
    shaped([&](const std::string& name, double, auto shape) { add(name, shape(fastest)); });
    return finished();
  }

 private:
  const planner::Mode& mode() const { return out_.driven.mode; }
  double period_s() const { return mode().period_s(); }
  double distance() const { return task_.distance_u; }

  /// Laws made from a T law plus some extra time.
  template <class Take>
  void shaped(Take&& take) {
    const double half_s = mode().damped_period_s() / 2;
    take("S-curve, 1 period", period_s(),
         [&](const PointLaw& l) { return planner::averaged(l, period_s()); });
    take("S-curve, 2 periods", 2 * period_s(),
         [&](const PointLaw& l) { return planner::averaged(l, 2 * period_s()); });
    take("ZV on T", half_s, [&](const PointLaw& l) { return planner::zv_shaped(l, mode()); });
    take("ZVD on T", 2 * half_s, [&](const PointLaw& l) { return planner::zvd_shaped(l, mode()); });
  }

  void add(std::string name, const PointLaw& law, double xi = 0) {
    PointRow row;
    row.name = std::move(name);
    row.law = law;
    row.xi = xi;
    row.work = planner::work_of(law, out_.load);
    row.amplitude_m = planner::residual_amplitude_u(law, out_.driven);
    row.peaks = planner::residual_peaks(planner::link_at(law, out_.driven, law.duration_s()), mode());
    for (std::size_t i = 0; i < std::size(kBands); ++i)
      row.worst_m[i] = planner::worst_amplitude_u(law, out_.driven, kBands[i]);
    out_.rows.push_back(std::move(row));
  }

  std::string answer(const planner::TChoice& c) const {
    if (c.zero)
      return fmt::format(
          "T law of xi = {:.7f}, {} = {}: least energy of {} T laws without residual vibration, {:.6f} J{}",
          c.xi, c.zero->branch == planner::ZeroBranch::ramp ? "n" : "m", c.zero->count, out_.zeros,
          c.energy_J,
          equal_ > 0 ? fmt::format(" ({} take the same; this one least copper loss)", equal_ + 1) : "");
    return fmt::format(
        "T law of xi = {:.7f}, n near {}: least residual vibration of all T laws, {:.6f} mm at {:.6f} J{}",
        c.xi, c.periods, 1e3 * c.amplitude_u, c.energy_J,
        mode().zeta == 0.0 ? " (none of them is silent at this time)" : "");
  }

  PointStudy finished() {
    const planner::ExcitedMode mode{out_.driven, 0, 1.0};
    const planner::Positioning rapid = planner::plan_positioning({task_.distance_u,
                                                                  task_.speed_limit_u_s,
                                                                  task_.accel_limit_u_s2,
                                                                  machine::kInfinity,
                                                                  {&mode, 1},
                                                                  machine::RapidShape::automatic,
                                                                  q_.omega_uncertainty,
                                                                  0});
    out_.advice = fmt::format("{}, {:.6f} s: {}", machine::kRapidShapes.word(rapid.shape),
                              rapid.law.duration_s(), rapid.reason);
    return std::move(out_);
  }

  const PointQuestion& q_;
  const planner::PointTask& task_;
  PointStudy out_;
  std::size_t equal_ = 0;  // other silent laws of the same energy
};

}  // namespace

planner::PointResult<PointStudy> study_point_laws(const PointQuestion& q) {
  if (auto r = planner::check(q.task); !r) return tl::unexpected(r.error());
  if (auto r = planner::check(q.mode); !r) return tl::unexpected(r.error());
  if (auto r = planner::check(q.load); !r) return tl::unexpected(r.error());
  if (!q.time_optimal && !(q.time_s > 0 && std::isfinite(q.time_s)))
    return tl::unexpected(PointFault{PointFault::Kind::not_positive, "time", q.time_s, 0, "s"});
  const auto driven = planner::DrivenMode::of(q.mode, q.drive, q.load.base_mass_kg(), q.load.mass_kg);
  if (auto r = planner::check(driven.mode); !r) return tl::unexpected(r.error());
  if (!(q.omega_uncertainty >= 0 && q.omega_uncertainty < 1))
    return tl::unexpected(
        PointFault{PointFault::Kind::bad_share, "uncertainty of the frequency", q.omega_uncertainty, 1, ""});
  const double periods = planner::shortest_time_s(q.task) / driven.mode.period_s();
  if (!(periods <= kMostPeriods))
    return tl::unexpected(PointFault{PointFault::Kind::too_fine, "periods of the vibration in the motion",
                                     periods, kMostPeriods, ""});
  Study study(q, driven);
  return q.time_optimal ? study.of_least_time() : study.of_given_time();
}

}  // namespace kadr::studies
