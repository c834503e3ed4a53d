#include "planner/time_law/path_law.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/joints.h"
#include "planner/path/path.h"

namespace kadr::planner {
namespace {

constexpr double kArcStep_rad = 2.0 * kPi / 180.0;
constexpr double kLeastIntervals = 100.0;  ///< of a run
constexpr double kPaperLength_u = 2846.9;
constexpr double kRampIntervals = 8.0;
constexpr double kWiden = 0.3;            ///< an interval's length by its distance from a slow joint
constexpr double kSlower = 0.9;           ///< of a segment's cap: a joint that is slow
constexpr double kAtCap = 1e-9;           ///< relative: a speed that its cap holds
constexpr double kAtCapRounding = 1e-12;  ///< relative: a speed that rounding alone keeps off its cap

/// Part of a limit that an interval of so many radians may use.
double arc_share(double step_rad) { return 1.0 / (1.0 + 6.0 * step_rad * step_rad / 8.0); }

class ProblemMaker {
 public:
  ProblemMaker(const Joints& joints, const PathLimitTable& table, const Run& run,
               const machine::MachineModel& machine, RunLimits limits)
      : joints_(joints),
        path_(joints.path()),
        table_(table),
        run_(run),
        machine_(machine),
        axes_(machine.axis.size()),
        even_(limits == RunLimits::path) {}

  RunProblem make() {
    LawProblem& p = out_.problem;
    p.axes = axes_;
    for (const machine::AxisModel& axis : machine_.axis) {
      p.max_feed_u_s.push_back(axis.max_feed_u_s);
      p.max_accel_u_s2.push_back(axis.max_accel_u_s2);
    }
    const double length = path_.start_s_u[run_.last + 1] - path_.start_s_u[run_.first];
    p.penalty = run_penalty(length);
    longest_u_ = std::min(machine_.planner.node_mm, length / kLeastIntervals);
    measure_joints();
    node(run_.first, 0.0);
    for (std::size_t i = run_.first; i <= run_.last; ++i) segment(i);
    // rest at both ends
    p.cap_u_s.front() = p.cap_u_s.back() = 0.0;
    return std::move(out_);
  }

 private:
  void segment(std::size_t i) {
    place_nodes(i);
    const double length = path_.segments[i].length_u;
    double longest = 0.0, from = 0.0;
    for (const double local : places_) {
      longest = std::max(longest, local - from);
      from = local;
    }
    const double share = arc_share(joints_.turn_rad(i) / (length / longest));
    behind(i, 0.0, share);
    for (const double local : places_) {
      node(i, local);
      LawProblem& p = out_.problem;
      p.interval_accel_u_s2.back() = table_.accel_u_s2[i] * share;
      at(i, local, share, p.slope, p.curvature);
      if (local < length) behind(i, local, share);
    }
  }

  /// Longest interval of a segment where nothing is slow.
  double widest_u(std::size_t i) const {
    const double turn_rad = joints_.turn_rad(i);
    if (!(turn_rad > 0.0)) return longest_u_;
    return std::min(longest_u_, path_.segments[i].length_u * kArcStep_rad / turn_rad);
  }

  /// Longest interval of a segment at one of its joints. Where that is slower than the segment, the way of
  /// the ramp between them is kRampIntervals intervals.
  double finest_u(std::size_t i, std::size_t joint) const {
    const double fast = table_.cap_u_s[2 * i + 1], slow = table_.cap_u_s[2 * joint];
    if (!(slow < fast * kSlower)) return widest_u(i);
    const double a = table_.accel_u_s2[i], ramp = (fast - slow) * (fast + slow) / (2.0 * a);
    if (!even_) return ramp / kRampIntervals;
    // and so is the way while acceleration rises, on a segment that may be too short for a ramp
    const double j = table_.jerk_u_s3[i], rise_s = std::min(a / j, std::sqrt((fast - slow) / j));
    const double rise = rise_s > 0.0 ? rise_s * (slow + j * rise_s * rise_s / 6.0) : ramp;
    return std::min({ramp, rise, path_.segments[i].length_u}) / kRampIntervals;
  }

  /// Longest intervals at all joints of the run, from both sides; even ones do not differ much from their
  /// neighbours, across joints and short segments too.
  void measure_joints() {
    const std::size_t n = run_.last - run_.first + 1;
    const auto length = [&](std::size_t k) { return path_.segments[run_.first + k].length_u; };
    before_u_.resize(n);
    behind_u_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      behind_u_[k] = finest_u(run_.first + k, run_.first + k);
      before_u_[k] = finest_u(run_.first + k, run_.first + k + 1);
    }
    if (!even_) return;
    for (std::size_t k = 0; k < n; ++k) {
      if (k > 0) behind_u_[k] = std::min(behind_u_[k], before_u_[k - 1]);
      behind_u_[k] = std::min(behind_u_[k], length(k));
      before_u_[k] = std::min({before_u_[k], length(k), behind_u_[k] + kWiden * length(k)});
    }
    for (std::size_t k = n; k-- > 0;) {
      if (k + 1 < n) before_u_[k] = std::min(before_u_[k], behind_u_[k + 1]);
      behind_u_[k] = std::min(behind_u_[k], before_u_[k] + kWiden * length(k));
    }
    for (std::size_t k = 1; k < n; ++k) behind_u_[k] = std::min(behind_u_[k], before_u_[k - 1]);
  }

  /// Ends of a segment's intervals, which widen from both joints on.
  void place_nodes(std::size_t i) {
    const double length = path_.segments[i].length_u, widest = widest_u(i);
    const double left = behind_u_[i - run_.first], right = before_u_[i - run_.first];
    places_.clear();
    for (double x = 0.0; x < length;) {
      const double y = length - x;
      const double step = std::min({widest, std::max(left, kWiden * x), std::max(right, kWiden * y)});
      // what is left is one interval, or two halves rather than a short one
      x = y <= 1.2 * step ? length : y < 2.0 * step ? x + 0.5 * y : x + step;
      places_.push_back(x);
    }
  }

  /// A new node on a segment; what holds behind it is set by behind().
  void node(std::size_t i, double local) {
    LawProblem& p = out_.problem;
    const bool begins = local == 0.0, ends = local == path_.segments[i].length_u;
    p.s_u.push_back(ends ? path_.start_s_u[i + 1] : path_.start_s_u[i] + local);
    p.cap_u_s.push_back(table_.cap_u_s[2 * i + (begins ? 0 : ends ? 2 : 1)]);
    p.interval_accel_u_s2.push_back(table_.accel_u_s2[i]);
    for (auto* v : {&p.slope, &p.curvature, &p.slope_behind, &p.curvature_behind})
      v->resize(v->size() + axes_, 0.0);
    out_.segment.push_back(i);
  }

  void behind(std::size_t i, double local, double share) {
    at(i, local, share, out_.problem.slope_behind, out_.problem.curvature_behind);
  }

  /// Derivatives of the last node, as if the axes' limits were lower by a share. Where limits are only
  /// reported, or those along the path say it all, the axes do not count.
  void at(std::size_t i, double local, double share, std::vector<double>& slope,
          std::vector<double>& curvature) {
    std::array<double, kProgramAxes> d1{}, d2{};
    joints_.at(i, local, {.d1 = {d1.data(), axes_}, .d2_per_u = {d2.data(), axes_}});
    const bool counts =
        !even_ && path_.segments[i].kind != SegmentKind::curve &&
        (machine_.planner.axis_limits == machine::AxisLimitRule::enforce || path_.segments[i].rapid);
    for (std::size_t c = 0; c < axes_; ++c) {
      slope[slope.size() - axes_ + c] = counts ? d1[c] / share : 0.0;
      curvature[curvature.size() - axes_ + c] = counts ? d2[c] / share : 0.0;
    }
  }

  const Joints& joints_;
  const Path& path_;
  const PathLimitTable& table_;
  const Run& run_;
  const machine::MachineModel& machine_;
  std::size_t axes_;
  bool even_;  ///< a motion of continuous acceleration needs intervals that do not differ much
  double longest_u_ = 1;
  std::vector<double> behind_u_, before_u_;  // [segments of the run], intervals at their begin and end
  std::vector<double> places_;
  RunProblem out_;
};

}  // namespace

PlanError law_not_found(const Path& path, const RunProblem& run, const LawFailure& failure) {
  const PathSegment& seg = path.segments[run.segment[failure.node]];
  Diagnostic d{};
  d.code = Code::law_not_found;
  d.span = seg.span;
  d.message = std::string(code_entry(d.code).title);
  d.label = fmt::format("at {:.3f} mm of the path (node {} of {}): {}", failure.s_u, failure.node + 1,
                        run.problem.nodes(), failure.reason);
  d.help = "use more planner.tube_levels, a larger planner.node_mm, or planner.method = \"certified\"";
  return {std::move(d)};
}

Signature law_signature(const PathLimitTable& table, std::size_t segment, double cap, double speed) {
  if (speed < cap * (1.0 - kAtCap)) return {LimitedBy::length, -1};
  return table.signature[2 * segment + 1];
}

Penalty run_penalty(double length_u) { return {Penalty{}.weight_s5_u2 * (length_u / kPaperLength_u), true}; }

RunProblem run_problem(const Joints& joints, const PathLimitTable& table, const Run& run,
                       const machine::MachineModel& machine, RunLimits limits) {
  return ProblemMaker(joints, table, run, machine, limits).make();
}

tl::expected<void, PlanError> plan_time_law(const RunTask& task, const Run& run, RunSolver& solve,
                                            std::vector<Element>& out) {
  const auto& [joints, table, machine] = task;
  RunProblem stated = run_problem(joints, table, run, machine);
  LawProblem& p = stated.problem;
  if (const auto wrong = check_problem(p)) return tl::unexpected(law_not_found(task.path(), stated, *wrong));
  LawResult law = solve(p, machine);
  if (!law) return tl::unexpected(law_not_found(task.path(), stated, law.error()));
  const std::vector<NodeCap> caps = node_caps(p);
  std::vector<double>& v = law->speed_u_s;
  // speeds that only rounding keeps off their cap are on it, so that holds are holds
  for (std::size_t i = 1; i + 1 < v.size(); ++i)
    if (std::fabs(v[i] - caps[i].speed_u_s) <= kAtCapRounding * v[i]) v[i] = caps[i].speed_u_s;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double length = p.ds_u(i);
    const Signature why = law_signature(table, stated.segment[i], p.cap_u_s[i], std::max(v[i - 1], v[i]));
    if (v[i - 1] == v[i]) {
      if (!out.empty() && out.back().is_hold() && out.back().v0_u_s == v[i] && out.back().signature == why)
        out.back().length_u += length;
      else
        out.push_back({p.s_u[i - 1], length, v[i], v[i], {0, 0}, why});
    } else {
      const double accel = std::fabs(v[i] - v[i - 1]) * (v[i] + v[i - 1]) / (2.0 * length);
      out.push_back({p.s_u[i - 1], length, v[i - 1], v[i], {accel, machine::kInfinity}, why});
    }
  }
  return {};
}

}  // namespace kadr::planner
