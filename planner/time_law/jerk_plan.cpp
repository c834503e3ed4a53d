#include "planner/time_law/jerk_plan.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/jerk_motion.h"

namespace kadr::planner {
namespace {

constexpr int kRounds = 24;
constexpr double kSettledTime = 1e-5;  ///< relative fall of the time at which the rounds end
constexpr double kStartShare = 0.9;    ///< of the start's speeds by acceleration and jerk alone
constexpr double kJerkStep = 4.0;      ///< of the jerk limit from an interval to the next
constexpr double kLeastShare = 0.1;    ///< of the jerk limit, below which a node is not lowered
constexpr double kStartPart = 4.5;     ///< v^3 = 4.5 j s^2 with constant jerk from rest
constexpr double kRestEnd = 2.25;      ///< of the jerk limit, at the law's ends: there v^3 = 2 (2.25 j) ds^2
constexpr double kRounding = 1e-12;    ///< of speeds and times that follow from k

/// How far a motion is above its limits: factors, 1 and below is kept.
struct Excess {
  double speed = 0, accel = 0, first_jerk = 0, second_jerk = 0;
  /// Least k of v/k, a/k^2, j/k^3.
  double stretch() const {
    const double jerk = std::max(first_jerk, second_jerk);
    return std::max({1.0, speed, std::sqrt(accel), jerk > 1.0 ? exact_pow(jerk, 1.0 / 3.0) : 0.0});
  }
};

Excess excess(const IntervalMotion& m, const IntervalLimits& limits) {
  const double a = std::max({std::fabs(m.a0_u_s2), std::fabs(m.am_u_s2), std::fabs(m.a1_u_s2)});
  return {m.highest_u_s() / limits.speed_u_s, a / limits.accel_u_s2,
          std::fabs(m.first_jerk_u_s3()) / limits.jerk_u_s3,
          std::fabs(m.second_jerk_u_s3()) / limits.jerk_u_s3};
}

IntervalMotion stretched(const IntervalMotion& m, double k) {
  return {m.time_s * k,        m.v0_u_s / k,        m.v1_u_s / k,
          m.a0_u_s2 / (k * k), m.am_u_s2 / (k * k), m.a1_u_s2 / (k * k)};
}

class JerkPlanner {
 public:
  JerkPlanner(RunProblem& stated, const PathLimitTable& table)
      : p_(stated.problem), n_(p_.nodes()), limits_(n_), part_(n_, 1.0) {
    std::vector<double> jerk(n_);
    for (std::size_t i = 1; i < n_; ++i) {
      const std::size_t segment = stated.segment[i];
      limits_[i] = {table.cap_u_s[2 * segment + 1], table.accel_u_s2[segment], table.jerk_u_s3[segment]};
      jerk[i] = limits_[i].jerk_u_s3;
      if (i > 1) jerk[i] = std::min(jerk[i], kJerkStep * jerk[i - 1]);
    }
    for (std::size_t i = n_ - 1; i > 1; --i) jerk[i - 1] = std::min(jerk[i - 1], kJerkStep * jerk[i]);
    jerk_ = {jerk, jerk};
    std::rotate(jerk_.behind.begin(), jerk_.behind.begin() + 1, jerk_.behind.end());
    jerk_.behind.front() *= kRestEnd;
    jerk_.before.back() *= kRestEnd;
  }

  tl::expected<void, LawFailure> run() {
    const LawResult fastest = GreedyOptimum().solve(p_);
    if (!fastest) return tl::unexpected(fastest.error());
    // no law is above it: x stays in reach of its scale
    p_.cap_u_s = fastest->speed_u_s;
    std::vector<double> v = start(fastest->speed_u_s);
    double before = machine::kInfinity;
    for (int round = 0; round < kRounds; ++round) {
      LawResult law = jerk_tangent_law(p_, jerk_, v);
      if (!law) return round > 0 ? tl::expected<void, LawFailure>() : tl::unexpected(law.error());
      v = std::move(law->speed_u_s);
      const double k = look(v);
      if (before - time_s_ < kSettledTime * time_s_ && k - 1.0 < kSettledTime) break;
      before = time_s_;
    }
    return {};
  }

  double stretch() const { return best_stretch_; }
  const std::vector<IntervalMotion>& motion() const { return best_; }

 private:
  /// A law from rest to rest with which the tangents begin.
  std::vector<double> start(const std::vector<double>& fastest) const {
    double jerk = 0;
    for (std::size_t i = 1; i < n_; ++i) jerk = std::max(jerk, limits_[i].jerk_u_s3);
    std::vector<double> v(n_, 0.0);
    for (std::size_t i = 1; i + 1 < n_; ++i) {
      const double way = std::min(p_.s_u[i] - p_.s_u.front(), p_.s_u.back() - p_.s_u[i]);
      const double by_jerk = exact_pow(kStartPart * jerk * way * way, 1.0 / 3.0);
      v[i] = kStartShare * std::min(fastest[i], by_jerk);
    }
    return v;
  }

  /// Makes the motion, keeps it if it is the fastest so far, and lowers what it is above. @return k
  double look(const std::vector<double>& v) {
    std::vector<IntervalMotion> motion = jerk_motion(p_.s_u, v, limits_, jerk_);
    time_s_ = 0;
    double k = 1.0;
    for (std::size_t i = 1; i < n_; ++i) {
      const Excess e = excess(motion[i], limits_[i]);
      k = std::max(k, e.stretch());
      time_s_ += motion[i].time_s;
      lower(i, e);
    }
    if (k * time_s_ < best_time_s_) {
      best_time_s_ = k * time_s_;
      best_stretch_ = k;
      best_ = std::move(motion);
    }
    return k;
  }

  /// Lowers both sides by the same ratio; neighbours take over what a nearly exhausted
  /// node cannot.
  void lower_jerk(std::size_t node, double factor) {
    if (!(factor > 1.0)) return;
    std::size_t first = node, last = node;
    while (part_[first] < kLeastShare && first > 0) --first;
    while (part_[last] < kLeastShare && last + 1 < n_) ++last;
    for (const std::size_t i : {first, last}) {
      const double by = first == last ? std::sqrt(factor) : factor;
      jerk_.before[i] /= by;
      jerk_.behind[i] /= by;
      part_[i] /= by;
    }
  }

  void lower(std::size_t i, const Excess& e) {
    lower_jerk(i - 1, e.first_jerk);
    lower_jerk(i, e.second_jerk);
    if (e.accel > 1.0) p_.interval_accel_u_s2[i] /= e.accel;
    if (e.speed > 1.0) {
      if (i > 1) p_.cap_u_s[i - 1] /= e.speed;
      if (i + 1 < n_) p_.cap_u_s[i] /= e.speed;
    }
  }

  LawProblem& p_;
  std::size_t n_;
  std::vector<IntervalLimits> limits_;
  std::vector<double> part_;  // [nodes], of the jerk limit, that is left
  NodeJerk jerk_;             ///< limits of the law
  double time_s_ = 0;
  double best_time_s_ = machine::kInfinity, best_stretch_ = 1;
  std::vector<IntervalMotion> best_;
};

}  // namespace

tl::expected<double, PlanError> plan_jerk_law(const RunTask& task, const Run& run,
                                              std::vector<JerkPiece>& out) {
  const auto& [joints, table, machine] = task;
  RunProblem stated = run_problem(joints, table, run, machine, RunLimits::path);
  if (const auto wrong = check_problem(stated.problem))
    return tl::unexpected(law_not_found(task.path(), stated, *wrong));
  const std::vector<double> caps = stated.problem.cap_u_s;
  JerkPlanner planner(stated, table);
  if (const auto done = planner.run(); !done)
    return tl::unexpected(law_not_found(task.path(), stated, done.error()));
  const double k = planner.stretch() > 1.0 ? planner.stretch() * (1.0 + kRounding) : 1.0;
  for (std::size_t i = 1; i < stated.problem.nodes(); ++i) {
    const IntervalMotion m = stretched(planner.motion()[i], k);
    const Signature why = law_signature(table, stated.segment[i], caps[i], std::max(m.v0_u_s, m.v1_u_s));
    add_pieces(m, stated.problem.s_u[i - 1], why.reason, why.axis, out);
  }
  return k;
}

}  // namespace kadr::planner
