#include "emulator/interpolator/curve_crossings.h"

#include <algorithm>
#include <cmath>

namespace kadr::interpolator {
namespace {

// a step of Newton's method below this changes t no more; a bracket below it can't be halved
constexpr double kSameT = 1e-15;
constexpr int kMostIterations = 60;

}  // namespace

void CurveCrossings::start(const planner::PathCurve& curve, std::size_t axis, double step_u,
                           std::int64_t node_begin, std::int64_t node_end) {
  curve_ = &curve;
  for (std::size_t j = 0; j < c_.size(); ++j) c_[j] = curve.coefficient(axis, j) / step_u;
  ends_ = curve.turning_points(axis);
  ends_.push_back(1.0);
  piece_ = 0;
  node_ = piece_node_ = node_begin;
  node_end_ = node_end;
  t_ = s_last_u_ = 0;
  count = next = 0;
}

double CurveCrossings::position(double t) const {
  return c_[0] + t * (c_[1] + t * (c_[2] + t * (c_[3] + t * (c_[4] + t * c_[5]))));
}

double CurveCrossings::speed(double t) const {
  return c_[1] + t * (2 * c_[2] + t * (3 * c_[3] + t * (4 * c_[4] + t * (5 * c_[5]))));
}

bool CurveCrossings::begin_piece() {
  if (piece_ == ends_.size()) return false;
  if (piece_ > 0) t_ = std::max(t_, ends_[piece_ - 1]);
  ++piece_;
  piece_node_ = piece_ == ends_.size()
                    ? node_end_
                    : static_cast<std::int64_t>(std::floor(position(ends_[piece_ - 1]) + 0.5));
  sign = piece_node_ > node_ ? 1 : -1;
  return true;
}

bool CurveCrossings::find_run() {
  count = next = 0;
  while (node_ == piece_node_)
    if (!begin_piece()) return false;
  const double end = ends_[piece_ - 1];
  while (count < kRun && node_ != piece_node_) {
    t_ = crossing(static_cast<double>(node_) + 0.5 * sign, t_, end);
    node_ += sign;
    s_last_u_ = std::max(s_last_u_, curve_->s_u(t_));
    s_u[static_cast<std::size_t>(count++)] = s_last_u_;
  }
  return true;
}

double CurveCrossings::crossing(double level, double low, double high) const {
  double t = 0.5 * (low + high);
  if (const double v = speed(low); v * sign > 0) {
    const double guess = low + (level - position(low)) / v;
    if (guess > low && guess < high) t = guess;
  }
  for (int i = 0; i < kMostIterations; ++i) {
    const double ahead = position(t) - level;
    (ahead * sign > 0 ? high : low) = t;
    const double v = speed(t);
    double step = v != 0 ? t - ahead / v : low - 1;
    // convergence comes before the bracket: at the root rounding may put the next t just outside
    if (std::fabs(step - t) <= kSameT) return t;
    if (!(step > low && step < high)) step = 0.5 * (low + high);
    if (std::fabs(step - t) <= kSameT) return step;
    t = step;
  }
  return t;
}

}  // namespace kadr::interpolator
