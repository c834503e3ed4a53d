#include "planner/time_law/jerk_limited.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "machine/base/numbers.h"
#include "planner/time_law/band_program.h"

namespace kadr::planner {
namespace {

constexpr double kSettled = 1e-5;  ///< relative fall of the cost at which the tangents end
constexpr std::uint32_t kMostTangents = 60;
constexpr double kStartSlack = 0.98;  ///< of a limit, that the first law may use
constexpr double kStartShrink = 0.6;
constexpr std::uint32_t kStartTrials = 60;
constexpr double kEndPart = 0.14;  ///< of the length, over which the first law rises and falls

/// Differences and durations at a node as linear forms of x = squared speeds in the program's unit.
struct NodeForm {
  std::size_t node;                  ///< of the first of three unknowns
  std::array<double, 3> change{};    // of u
  std::array<double, 3> duration{};  // tangent of j_before dt_i + j_behind dt_(i+1)
  double duration_rest = 0;          // its part that does not depend on x
};

class Tangents {
 public:
  Tangents(const BandProgram& program, const std::vector<double>& x) : p_(program), x_(x) {}

  NodeForm at(std::size_t i, double before, double behind) const {
    const std::size_t n = x_.size();
    NodeForm f{std::min(i > 0 ? i - 1 : 0, n - 3)};
    if (i > 0) add(f, i, 1.0, before);
    if (i + 1 < n) add(f, i + 1, -1.0, behind);
    return f;
  }

 private:
  /// Interval i with its u taken away (or, negative, added: u_(i+1) - u_i).
  void add(NodeForm& f, std::size_t i, double sign, double jerk) const {
    const double ds = p_.ds_u[i], h = 0.5 * p_.unit_u2_s2 / ds;
    const double v0 = std::sqrt(x_[i - 1] * p_.unit_u2_s2), v1 = std::sqrt(x_[i] * p_.unit_u2_s2),
                 sum = v0 + v1;
    f.change[i - f.node] -= sign * h;
    f.change[i - 1 - f.node] += sign * h;
    const double slope = ds * p_.unit_u2_s2 / (sum * sum);
    const double d0 = v0 > 0.0 ? -slope / v0 : 0.0, d1 = v1 > 0.0 ? -slope / v1 : 0.0;
    f.duration[i - 1 - f.node] += jerk * d0;
    f.duration[i - f.node] += jerk * d1;
    f.duration_rest += jerk * (2.0 * ds / sum - d0 * x_[i - 1] - d1 * x_[i]);
  }

  const BandProgram& p_;
  const std::vector<double>& x_;
};

void add_jerk_rows(BandProgram& program, const std::vector<double>& x, const NodeJerk& jerk) {
  const Tangents tangents(program, x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double before = i > 0 ? jerk.before[i] : 0.0, behind = i + 1 < x.size() ? jerk.behind[i] : 0.0;
    if (!(before + behind < machine::kInfinity)) continue;
    const NodeForm f = tangents.at(i, before, behind);
    const double bound = 0.5 * f.duration_rest;
    for (const double side : {1.0, -1.0}) {
      BandRow row{static_cast<std::uint32_t>(f.node)};
      for (std::size_t q = 0; q < 3; ++q) row.a[q] = (side * f.change[q] - 0.5 * f.duration[q]) / bound;
      program.rows.push_back(row);
    }
  }
}

double used(const BandProgram& program, const std::vector<double>& x) {
  double most = 0;
  for (const BandRow& r : program.rows)
    most = std::max(most, (r.a[0] * x[r.node] + r.a[1] * x[r.node + 1] + r.a[2] * x[r.node + 2]) / r.bound);
  return most;
}

/// A slow law from rest to rest that keeps every limit: s ~ t^3 at the ends, so that jerk is finite there.
std::vector<double> slow_law(const LawProblem& p, const BandProgram& base, const NodeJerk& jerk) {
  const std::size_t n = p.nodes();
  double least = base.cap[1];
  for (std::size_t i = 1; i + 1 < n; ++i) least = std::min(least, base.cap[i]);
  std::vector<double> shape(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double from_end =
        std::min(p.s_u[i] - p.s_u.front(), p.s_u.back() - p.s_u[i]) / (kEndPart * p.length_u());
    shape[i] = 0.5 * least * (from_end < 1.0 ? exact_pow(from_end, 4.0 / 3.0) : 1.0);
  }
  double factor = 1.0;
  for (std::uint32_t trial = 0; trial < kStartTrials; ++trial, factor *= kStartShrink) {
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = factor * shape[i];
    BandProgram program = base;
    add_jerk_rows(program, x, jerk);
    if (used(program, x) <= kStartSlack) return x;
  }
  return {};
}

BandProgram base_program(const LawProblem& problem) {
  BandProgram base = cost_program(problem, node_caps(problem));
  add_accel_rows(base, accel_rows(problem));
  add_caps(base);
  return base;
}

std::vector<double> speeds(const BandProgram& program, const std::vector<double>& x) {
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) out[i] = std::sqrt(x[i] * program.unit_u2_s2);
  return out;
}

}  // namespace

double node_jerk_u_s3(const LawProblem& p, const std::vector<double>& v) {
  double most = 0, u = 0, dt = 0;
  for (std::size_t i = 1; i <= p.nodes(); ++i) {
    const bool inside = i < p.nodes();
    const double next_dt = inside ? 2.0 * p.ds_u(i) / (v[i - 1] + v[i]) : 0.0;
    const double next_u = inside ? (v[i] - v[i - 1]) / next_dt : 0.0;
    most = std::max(most, std::fabs(next_u - u) / (0.5 * (dt + next_dt)));
    u = next_u;
    dt = next_dt;
  }
  return most;
}

LawResult JerkLimitedLaw::solve(const LawProblem& problem) {
  const std::size_t n = problem.nodes();
  if (problem.begin_u_s != 0.0 || problem.end_u_s != 0.0) {
    const std::size_t node = problem.begin_u_s != 0.0 ? 0 : n - 1;
    return tl::unexpected(LawFailure{
        node, problem.s_u[node],
        fmt::format("the jerk-limited law runs from rest to rest, but the speed here must be {:.6g} mm/s",
                    node == 0 ? problem.begin_u_s : problem.end_u_s)});
  }
  const NodeJerk jerk{std::vector<double>(n, jerk_u_s3_), std::vector<double>(n, jerk_u_s3_)};
  const BandProgram base = base_program(problem);
  const std::vector<double> x = slow_law(problem, base, jerk);
  if (x.empty())
    return tl::unexpected(LawFailure{
        0, problem.s_u[0], fmt::format("no law was found whose jerk stays within {:.6g} mm/s3", jerk_u_s3_)});
  std::vector<double> speed = speeds(base, x);
  std::uint32_t steps = 0;
  double before = machine::kInfinity;
  for (tangents_ = 1;; ++tangents_) {
    if (progress_) progress_(fmt::format("tangent {}", tangents_), -1.0);
    LawResult law = jerk_tangent_law(problem, jerk, speed);
    if (!law) return law;
    steps += law->iterations;
    law->iterations = steps;
    if (before - law->cost_s < kSettled * law->cost_s || tangents_ == kMostTangents) return law;
    before = law->cost_s;
    speed = std::move(law->speed_u_s);
  }
}

LawResult jerk_tangent_law(const LawProblem& problem, const NodeJerk& jerk,
                           const std::vector<double>& at_u_s) {
  BandProgram program = base_program(problem);
  std::vector<double> x(at_u_s.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = at_u_s[i] * at_u_s[i] / program.unit_u2_s2;
  add_jerk_rows(program, x, jerk);
  BandOptions options;
  options.relative_gap = kSettled;
  const BandOptimum optimum = planner::solve(program, std::move(x), options);
  if (!optimum.converged)
    return tl::unexpected(LawFailure{
        0, problem.s_u[0], fmt::format("the interior point method stopped after {} steps", optimum.steps)});
  LawSolution out = summed(problem, speeds(program, optimum.x));
  out.iterations = optimum.steps;
  return out;
}

}  // namespace kadr::planner
