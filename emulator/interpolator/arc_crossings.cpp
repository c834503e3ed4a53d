#include "emulator/interpolator/arc_crossings.h"

#include <algorithm>
#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::interpolator {

namespace {

// pi in two parts; the first has 31 bits, so that its product with a count of half turns below 2^22 is exact
constexpr double kPiHead = 0x1.921fb54400000p+1;
constexpr double kPiTail = 0x1.0b4611a626331p-33;
// guards of two searches: Newton with a slope in [1, 2], and Newton in a bracket, where halving alone needs 54
constexpr int kTurningSteps = 16;
constexpr int kBracketSteps = 100;
// an extreme this near to a segment's end is the end itself; it moves the axis by radius * 5e-17
constexpr double kSameAngle_rad = 1e-8;

// allowed error of a crossing, in steps
constexpr double kSettled_steps = 1e-12;

/// Arc cosine within 7e-5 rad (Abramowitz and Stegun 4.4.45): good enough to know the radius of a spiral there.
double rough_acos(double c) {
  const double a = std::min(std::fabs(c), 1.0);
  const double angle = std::sqrt(1.0 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a)));
  return c < 0.0 ? kPi - angle : angle;
}

}  // namespace

void ArcCrossings::start(const planner::ArcShape& shape, bool second, double step_u, const Ends& ends) {
  center_ = (second ? shape.center_second_u : shape.center_first_u) / step_u;
  radius_ = shape.radius_begin_u / step_u;
  growth_ = (shape.radius_end_u - shape.radius_begin_u) / step_u;
  sweep_rad_ = std::fabs(shape.sweep_rad);
  psi_rad_ = second ? shape.angle_begin_rad - 0.5 * kPi : shape.angle_begin_rad;
  if (shape.sweep_rad < 0.0) psi_rad_ = -psi_rad_;
  length_u_ = ends.length_u;
  u_per_rad_ = 1.0 / sweep_rad_;
  s_per_rad_u_ = length_u_ / sweep_rad_;
  radius_per_rad_ = growth_ / sweep_rad_;
  node_last_ = ends.node_end;

  const double theta_begin = psi_rad_ - lag_rad(0.0);
  const double theta_end = psi_rad_ + sweep_rad_ - lag_rad(1.0);
  piece_ = static_cast<std::int64_t>(std::floor((theta_begin + kSameAngle_rad) / kPi));
  last_extreme_ = static_cast<std::int64_t>(std::ceil((theta_end - kSameAngle_rad) / kPi)) - 1;
  u_end_ = 0.0;
  s_end_u_ = 0.0;
  node_end_ = ends.node_begin;
  count = next = 0;
  begin_piece();
}

/// delta(u): lag of the extremes of a spiral behind those of a circle, in (-pi/2, pi/2].
double ArcCrossings::lag_rad(double u) const {
  if (growth_ == 0.0) return 0.0;
  return exact_atan2(growth_, (radius_ + growth_ * u) * sweep_rad_);
}

/// m pi - psi without losing digits over many turns.
double ArcCrossings::half_turns_rad(std::int64_t m) const {
  const auto turns = static_cast<double>(m);
  return (turns * kPiHead - psi_rad_) + turns * kPiTail;
}

/// The u of extreme m, not before u_from: root of u - (m pi - psi + delta(u))/sweep, whose slope lies in [1, 2].
double ArcCrossings::turning_share(std::int64_t m, double u_from) const {
  const double base = half_turns_rad(m);
  double u = std::clamp((base + lag_rad(u_from)) * u_per_rad_, u_from, 1.0);
  if (growth_ == 0.0) return u;
  for (int i = 0; i < kTurningSteps; ++i) {
    const double along = (radius_ + growth_ * u) * sweep_rad_;
    const double slope = 1.0 + growth_ * growth_ / (growth_ * growth_ + along * along);
    const double better = u - (u - (base + lag_rad(u)) * u_per_rad_) / slope;
    const double moved = std::fabs(better - u);
    u = better;
    if (moved <= 1e-15) break;
  }
  return std::clamp(u, u_from, 1.0);
}

double ArcCrossings::turning_position(std::int64_t m, double u) const {
  const double r = radius_ + growth_ * u;
  double height = r;
  if (growth_ != 0.0) {
    const double along = r * sweep_rad_;
    height = r * (along / std::sqrt(growth_ * growth_ + along * along));
  }
  return (m & 1) == 0 ? center_ + height : center_ - height;
}

/// Sets up piece piece_, which begins where the last one ended.
void ArcCrossings::begin_piece() {
  u_begin_ = u_end_;
  s_begin_u_ = s_end_u_;
  node_begin_ = node_end_;
  found_ = 0;
  last_piece_ = piece_ >= last_extreme_;
  if (last_piece_) {
    u_end_ = 1.0;
    s_end_u_ = length_u_;
    node_end_ = node_last_;
  } else {
    u_end_ = turning_share(piece_ + 1, u_begin_);
    s_end_u_ = u_end_ * length_u_;
    node_end_ = static_cast<std::int64_t>(std::floor(turning_position(piece_ + 1, u_end_) + 0.5));
  }
  const double base = half_turns_rad(piece_);
  parity_ = (piece_ & 1) == 0 ? 1.0 : -1.0;
  piece_s_u_ = base * s_per_rad_u_;
  piece_radius_ = radius_ + growth_ * (base * u_per_rad_);
  chi_begin_ = u_begin_ * sweep_rad_ - base;
  chi_end_ = u_end_ * sweep_rad_ - base;
}

bool ArcCrossings::find_run() {
  std::int64_t left = std::llabs(node_end_ - node_begin_) - found_;
  while (left == 0) {
    if (last_piece_) return false;
    ++piece_;
    begin_piece();
    left = std::llabs(node_end_ - node_begin_);
  }
  sign = node_end_ > node_begin_ ? 1 : -1;
  count = static_cast<int>(std::min<std::int64_t>(left, kRun));
  next = 0;

  Run height, chi;
  const double level = static_cast<double>(node_begin_ + sign * found_) + 0.5 * sign;
  for (int i = 0; i < count; ++i) height[i] = parity_ * ((level + sign * static_cast<double>(i)) - center_);
  if (growth_ == 0.0)
    circle_angles(height, chi);
  else
    spiral_angles(height, chi);
  double floor_u = s_begin_u_;
  for (int i = 0; i < count; ++i) {
    // inside the piece and in order, whatever rounding did
    floor_u = std::min(std::max(piece_s_u_ + chi[i] * s_per_rad_u_, floor_u), s_end_u_);
    s_u[static_cast<std::size_t>(i)] = floor_u;
  }
  found_ += count;
  return true;
}

/// chi with radius cos(chi) = height.
void ArcCrossings::circle_angles(const Run& height, Run& chi) const {
  Run width;
  const double r = piece_radius_;
  for (int i = 0; i < count; ++i) {
    const double square = (r - height[i]) * (r + height[i]);
    width[i] = std::sqrt(square > 0.0 ? square : 0.0);
  }
  for (int i = 0; i < count; ++i) chi[i] = exact_atan2(width[i], height[i]);
}

/// chi with (piece_radius + radius_per_rad chi) cos(chi) = height, in [chi_begin, chi_end]; loops without
/// calls and branches, so that they run in vector registers.
void ArcCrossings::spiral_angles(const Run& height, Run& chi) const {
  const double r0 = piece_radius_, per_rad = radius_per_rad_;
  const double middle = r0 + per_rad * (0.5 * kPi);
  const double per_middle = middle > 0.0 ? 1.0 / middle : 0.0;
  Run radius, width;
  for (int i = 0; i < count; ++i) {
    // the radius there, from a rough angle
    radius[i] = r0 + per_rad * rough_acos(height[i] * per_middle);
    const double square = (radius[i] - height[i]) * (radius[i] + height[i]);
    width[i] = std::sqrt(square > 0.0 ? square : 0.0);
  }
  for (int i = 0; i < count; ++i) chi[i] = exact_atan2(width[i], height[i]);

  // one Newton step with the sine and cosine already known; the rest is second order
  unsigned settled[kRun];
  unsigned all = 1;
  const double low = chi_begin_, high = chi_end_, bend = 2.0 * std::fabs(per_rad);
  for (int i = 0; i < count; ++i) {
    const double there = r0 + per_rad * chi[i];
    const double slope = there * width[i] - per_rad * height[i];
    const double step = (there - radius[i]) * height[i] / slope;
    const double rest = step * step * (std::fabs(height[i]) + bend);
    const double better = chi[i] + step;
    settled[i] = static_cast<unsigned>(width[i] > 0.0) & static_cast<unsigned>(slope > 0.0) &
                 static_cast<unsigned>(rest <= kSettled_steps) & static_cast<unsigned>(better >= low) &
                 static_cast<unsigned>(better <= high);
    all &= settled[i];
    chi[i] = better;
  }
  if (all != 0) return;
  for (int i = 0; i < count; ++i)
    if (settled[i] == 0) chi[i] = bracketed_angle(height[i]);
}

/// The same near an extreme and for a strongly growing radius: Newton, halving the bracket where it
/// would leave it. The function falls over the piece.
double ArcCrossings::bracketed_angle(double height) const {
  double low = chi_begin_, high = chi_end_;
  double chi = 0.5 * (low + high);
  for (int i = 0; i < kBracketSteps; ++i) {
    const SinCos t = exact_sincos(chi);
    const double r = piece_radius_ + radius_per_rad_ * chi;
    const double value = r * t.cos - height;
    const double slope = radius_per_rad_ * t.cos - r * t.sin;
    const double better = chi - value / slope;
    // test convergence before the bracket, otherwise rounding would force needless bisection
    if (std::fabs(better - chi) <= 4e-16 * (1.0 + std::fabs(chi)))
      return std::clamp(better, chi_begin_, chi_end_);
    if (value > 0.0)
      low = chi;
    else
      high = chi;
    chi = better > low && better < high ? better : 0.5 * (low + high);
    if (high - low <= 4e-16 * (1.0 + std::fabs(chi))) break;
  }
  return chi;
}

}  // namespace kadr::interpolator
