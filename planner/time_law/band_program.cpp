#include "planner/time_law/band_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kadr::planner {
namespace {

constexpr double kToBoundary = 0.99;  ///< share of the distance to a bound that a step may take
constexpr double kFall = 0.5;         ///< part of itself that an x may lose in a step
constexpr double kFalls = 0.9;        ///< a gap that falls less is at its rounding
constexpr std::uint32_t kStill = 4;   ///< after so many steps of that kind
constexpr double kRoundedGap = 1e-6;  ///< and below this it is taken
constexpr double kShort = 0.1;        ///< of a predictor's step
constexpr double kRecentre = 0.5;     ///< of the mean product, instead of a corrector
constexpr double kLeastSlack = 1e-2;
constexpr double kRowUlps = 16.0;  ///< of a row's largest term, by which its value may be off

/// Symmetric matrix of bandwidth 2, factored in place into L D L^T.
struct Band {
  std::vector<double> diagonal, first, second;  // [nodes]; first[i] couples i-1 and i, second[i] i-2 and i

  explicit Band(std::size_t n) : diagonal(n), first(n), second(n) {}
  void clear() {
    for (auto* v : {&diagonal, &first, &second}) std::fill(v->begin(), v->end(), 0.0);
  }
  /// Unknowns 1..n-2.
  void factor() {
    const std::size_t n = diagonal.size() - 2;
    for (std::size_t i = 1; i <= n; ++i) {
      const double l2 = i > 2 ? second[i] / diagonal[i - 2] : 0.0;
      const double l1 = i > 1 ? (first[i] - (i > 2 ? second[i] * first[i - 1] : 0.0)) / diagonal[i - 1] : 0.0;
      diagonal[i] -= (i > 2 ? l2 * l2 * diagonal[i - 2] : 0.0) + (i > 1 ? l1 * l1 * diagonal[i - 1] : 0.0);
      first[i] = l1;
      second[i] = l2;
    }
  }
  void solve(std::vector<double>& b) const {
    const std::size_t n = diagonal.size() - 2;
    for (std::size_t i = 1; i <= n; ++i)
      b[i] -= (i > 1 ? first[i] * b[i - 1] : 0.0) + (i > 2 ? second[i] * b[i - 2] : 0.0);
    for (std::size_t i = 1; i <= n; ++i) b[i] /= diagonal[i];
    for (std::size_t i = n; i >= 1; --i)
      b[i] -= (i < n ? first[i + 1] * b[i + 1] : 0.0) + (i + 1 < n ? second[i + 2] * b[i + 2] : 0.0);
    b.front() = b.back() = 0.0;
  }
};

class InteriorPoint {
 public:
  InteriorPoint(const BandProgram& program, std::vector<double> x)
      : p_(program),
        n_(program.cap.size()),
        x_(std::move(x)),
        slack_(program.rows.size()),
        multiplier_(slack_),
        residual_(slack_),
        row_step_(slack_),
        slack_step_(slack_),
        multiplier_step_(slack_),
        gradient_(n_),
        dual_(n_),
        step_(n_),
        hessian_(n_) {}

  BandOptimum run(const BandOptions& options);

 private:
  double row(std::size_t k, const std::vector<double>& z) const {
    const BandRow& r = p_.rows[k];
    return r.a[0] * z[r.node] + r.a[1] * z[r.node + 1] + r.a[2] * z[r.node + 2];
  }
  /// A row's residual beyond what its terms are rounded by: near short intervals they are large and cancel.
  double broken(std::size_t k) const {
    const BandRow& r = p_.rows[k];
    const double terms = std::fabs(r.a[0]) * x_[r.node] + std::fabs(r.a[1]) * x_[r.node + 1] +
                         std::fabs(r.a[2]) * x_[r.node + 2];
    return std::fabs(residual_[k]) - kRowUlps * std::numeric_limits<double>::epsilon() * terms;
  }
  void add_to(std::vector<double>& out, std::size_t k, double factor) const {
    const BandRow& r = p_.rows[k];
    out[r.node] += factor * r.a[0];
    out[r.node + 1] += factor * r.a[1];
    out[r.node + 2] += factor * r.a[2];
  }
  double cost_and_derivatives();
  double bound_s(double cost);
  void factor();
  void direction(double centre, bool corrected);
  double step_length() const;
  void advance(double product);
  double row_count() const { return static_cast<double>(std::max<std::size_t>(p_.rows.size(), 1)); }

  const BandProgram& p_;
  std::size_t n_;
  std::vector<double> x_, slack_, multiplier_, residual_, row_step_, slack_step_, multiplier_step_;
  std::vector<double> gradient_, dual_, step_;
  Band hessian_;
};

double InteriorPoint::cost_and_derivatives() {
  double cost = 0;
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  hessian_.clear();
  const double unit = 1.0 / std::sqrt(p_.unit_u2_s2);
  double v0 = std::sqrt(x_[0]);
  for (std::size_t i = 1; i < n_; ++i) {
    const double v1 = std::sqrt(x_[i]), sum = v0 + v1, d = p_.ds_u[i] * unit;
    const double w = p_.weight[i], dx = x_[i] - x_[i - 1];
    cost += 2.0 * d / sum + w * dx * dx;
    const double slope = d / (sum * sum);
    if (i > 1) {
      gradient_[i - 1] -= slope / v0 + 2.0 * w * dx;
      hessian_.diagonal[i - 1] += slope / (v0 * v0) * (1.0 / sum + 0.5 / v0) + 2.0 * w;
    }
    if (i + 1 < n_) {
      gradient_[i] -= slope / v1 - 2.0 * w * dx;
      hessian_.diagonal[i] += slope / (v1 * v1) * (1.0 / sum + 0.5 / v1) + 2.0 * w;
      if (i > 1) hessian_.first[i] += slope / (sum * v0 * v1) - 2.0 * w;
    }
    v0 = v1;
  }
  return cost;
}

/// Lower bound by the present multipliers (certificate.h), and r in dual_.
double InteriorPoint::bound_s(double cost) {
  dual_ = gradient_;
  double bound = cost;
  for (std::size_t k = 0; k < p_.rows.size(); ++k) {
    add_to(dual_, k, multiplier_[k]);
    const double value = row(k, x_);
    residual_[k] = value + slack_[k] - p_.rows[k].bound;
    bound += multiplier_[k] * (value - p_.rows[k].bound);
  }
  dual_.front() = dual_.back() = 0.0;
  for (std::size_t i = 1; i + 1 < n_; ++i)
    bound += std::min(-dual_[i] * x_[i], dual_[i] * (p_.cap[i] - x_[i]));
  return bound;
}

void InteriorPoint::factor() {
  for (std::size_t k = 0; k < p_.rows.size(); ++k) {
    const BandRow& r = p_.rows[k];
    const double w = multiplier_[k] / slack_[k];
    const std::size_t i = r.node;
    hessian_.diagonal[i] += w * r.a[0] * r.a[0];
    hessian_.diagonal[i + 1] += w * r.a[1] * r.a[1];
    hessian_.diagonal[i + 2] += w * r.a[2] * r.a[2];
    hessian_.first[i + 1] += w * r.a[0] * r.a[1];
    hessian_.first[i + 2] += w * r.a[1] * r.a[2];
    hessian_.second[i + 2] += w * r.a[0] * r.a[2];
  }
  hessian_.factor();
}

/// Newton's step towards slack * multiplier = centre; the corrector takes the last step's product into account.
void InteriorPoint::direction(double centre, bool corrected) {
  for (std::size_t i = 0; i < n_; ++i) step_[i] = -dual_[i];
  for (std::size_t k = 0; k < p_.rows.size(); ++k) {
    double product = slack_[k] * multiplier_[k] - centre;
    if (corrected) product += slack_step_[k] * multiplier_step_[k];
    row_step_[k] = product;
    add_to(step_, k, -(multiplier_[k] * residual_[k] - product) / slack_[k]);
  }
  step_.front() = 0.0;
  hessian_.solve(step_);
  for (std::size_t k = 0; k < p_.rows.size(); ++k) {
    const double product = row_step_[k];
    slack_step_[k] = -residual_[k] - row(k, step_);
    multiplier_step_[k] = -(product + multiplier_[k] * slack_step_[k]) / slack_[k];
  }
}

double InteriorPoint::step_length() const {
  double length = 1.0;
  const auto shorten = [&](double value, double change, double part) {
    if (change < 0.0 && -length * change > part * value) length = part * value / -change;
  };
  for (std::size_t k = 0; k < p_.rows.size(); ++k) {
    shorten(slack_[k], slack_step_[k], kToBoundary);
    shorten(multiplier_[k], multiplier_step_[k], kToBoundary);
  }
  for (std::size_t i = 1; i + 1 < n_; ++i) shorten(x_[i], step_[i], kFall);
  return length;
}

/// One step of predictor and corrector.
/// @param product  sum of slack * multiplier
void InteriorPoint::advance(double product) {
  const std::size_t rows = p_.rows.size();
  factor();
  const double mean = product / row_count();
  direction(0.0, false);
  const double foreseen = step_length();
  double left = 0;
  for (std::size_t k = 0; k < rows; ++k)
    left += (slack_[k] + foreseen * slack_step_[k]) * (multiplier_[k] + foreseen * multiplier_step_[k]);
  const double ratio = left / product;
  // a predictor that comes nowhere says nothing about the second order
  if (foreseen < kShort)
    direction(kRecentre * mean, false);
  else
    direction(ratio * ratio * ratio * mean, true);
  const double length = step_length();
  for (std::size_t i = 1; i + 1 < n_; ++i) x_[i] += length * step_[i];
  for (std::size_t k = 0; k < rows; ++k) {
    slack_[k] += length * slack_step_[k];
    multiplier_[k] += length * multiplier_step_[k];
  }
}

BandOptimum InteriorPoint::run(const BandOptions& options) {
  const std::size_t rows = p_.rows.size();
  BandOptimum out;
  out.bound_s = 0;
  double cost = cost_and_derivatives();
  for (std::size_t k = 0; k < rows; ++k) {
    slack_[k] = std::max(p_.rows[k].bound - row(k, x_), kLeastSlack);
    multiplier_[k] = cost / row_count() / slack_[k];
  }
  double least_gap = machine::kInfinity;
  std::uint32_t still = 0;  // steps without progress
  for (;; ++out.steps) {
    if (options.each_step) options.each_step(out.steps);
    if (const double bound = bound_s(cost); bound > out.bound_s) {
      out.bound_s = bound;
      out.x = x_;
      out.multipliers = multiplier_;
    }
    double worst = 0, product = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      worst = std::max(worst, broken(k));
      product += slack_[k] * multiplier_[k];
    }
    const double gap = cost - out.bound_s;
    still = gap < least_gap * kFalls ? 0 : still + 1;
    least_gap = std::min(least_gap, gap);
    const bool rounded = still >= kStill && gap <= kRoundedGap * cost;
    out.converged = worst <= options.broken && (gap <= options.relative_gap * cost || rounded);
    if (out.converged || out.steps == options.most_steps) break;
    advance(product);
    cost = cost_and_derivatives();
  }
  out.cost_s = cost;
  if (out.converged || out.x.empty()) {
    out.x = std::move(x_);
    out.multipliers = std::move(multiplier_);
  }
  return out;
}

}  // namespace

BandProgram cost_program(const LawProblem& problem, const std::vector<NodeCap>& caps) {
  const std::size_t n = problem.nodes();
  double fastest = 0;
  for (const NodeCap& c : caps) fastest = std::max(fastest, c.speed_u_s);
  BandProgram out;
  out.unit_u2_s2 = fastest * fastest;
  out.ds_u.assign(n, 0.0);
  out.weight.assign(n, 0.0);
  out.cap.resize(n);
  for (std::size_t i = 0; i < n; ++i) out.cap[i] = caps[i].speed_u_s * caps[i].speed_u_s / out.unit_u2_s2;
  for (std::size_t i = 1; i < n; ++i) {
    out.ds_u[i] = problem.ds_u(i);
    const double per_unit = out.unit_u2_s2 / (2.0 * out.ds_u[i]);  // a of a difference of 1
    out.weight[i] = problem.penalty_weight(i) * per_unit * per_unit;
  }
  return out;
}

bool add_row(BandProgram& program, const BandRow& row) {
  double most = 0;
  for (std::size_t q = 0; q < 3; ++q) most += std::max(row.a[q], 0.0) * program.cap[row.node + q];
  if (most < row.bound) return false;
  program.rows.push_back(row);
  return true;
}

std::vector<RowOrigin> add_accel_rows(BandProgram& program, const AccelRows& rows) {
  const std::size_t n = program.cap.size();
  std::vector<RowOrigin> origins;
  for (std::size_t i = 1; i < n; ++i) {
    const std::size_t node = std::min(i - 1, n - 3), shift = i - 1 - node;  // three unknowns, also at the end
    for (std::size_t r = i * rows.per_interval; r < (i + 1) * rows.per_interval; ++r)
      for (const double side : {1.0, -1.0}) {
        BandRow row{static_cast<std::uint32_t>(node)};
        row.a[shift] = side * rows.before[r] * program.unit_u2_s2;
        row.a[shift + 1] = side * rows.after[r] * program.unit_u2_s2;
        if (add_row(program, row)) origins.push_back({r, side > 0.0});
      }
  }
  return origins;
}

void add_caps(BandProgram& program) {
  const std::size_t n = program.cap.size();
  for (std::size_t i = 1; i + 1 < n; ++i)
    program.rows.push_back({static_cast<std::uint32_t>(i - 1), {0.0, 1.0 / program.cap[i], 0.0}, 1.0});
}

BandOptimum solve(const BandProgram& program, std::vector<double> x, const BandOptions& options) {
  return InteriorPoint(program, std::move(x)).run(options);
}

}  // namespace kadr::planner
