#include "planner/bezier/joint.h"

#include <cmath>

namespace kadr::planner {
namespace {

constexpr double kSameDirection_rad = 1e-9;

BezierVector sum(const BezierVector& a, const BezierVector& b, double factor) {
  BezierVector out{};
  for (std::size_t k = 0; k < kMostBezierAxes; ++k) out[k] = a[k] + factor * b[k];
  return out;
}

/// Angle between two directions: 2 atan2(|u - v|, |u + v|) of their unit vectors, exact near 0 and pi.
double angle_rad(const BezierVector& a, const BezierVector& b) {
  const double la = norm(a), lb = norm(b);
  if (la == 0 || lb == 0) return 0;
  BezierVector u{}, v{};
  u = sum(u, a, 1 / la);
  v = sum(v, b, 1 / lb);
  return 2 * std::atan2(norm(sum(u, v, -1)), norm(sum(u, v, 1)));
}

}  // namespace

JointReport joint_report(const Bezier& before, const Bezier& after) {
  const BezierVector d1 = before.derivative(1), d2 = after.derivative(0);
  const BezierVector k1 = before.curvature_vector(1), k2 = after.curvature_vector(0);
  JointReport out;
  out.gap_u = norm(sum(after.position(0), before.position(1), -1));
  out.tangent_angle_rad = angle_rad(d1, d2);
  out.speed_ratio = norm(d2) / norm(d1);
  out.normal_angle_rad = angle_rad(k1, k2);
  out.curvature_before_per_u = norm(k1);
  out.curvature_after_per_u = norm(k2);
  out.curvature_jump_per_u = norm(sum(k2, k1, -1));
  out.second_jump = norm(sum(after.second(0), before.second(1), -1));
  return out;
}

std::optional<JointRepair> repair_g2(const Bezier& before, const Bezier& after) {
  if (after.degree() != 3) return {};
  const BezierVector d2 = after.derivative(0);
  if (angle_rad(before.derivative(1), d2) > kSameDirection_rad) return {};
  // B'' = k |B'|^2 = 6 (P2 - 2 P1 + P0)
  const BezierVector second = after.control()[1];
  BezierVector third = sum(sum({}, second, 2), after.control()[0], -1);
  third = sum(third, before.curvature_vector(1), dot(d2, d2) / 6);
  return JointRepair{second, third};
}

std::optional<JointRepair> repair_c2(const Bezier& before, const Bezier& after) {
  if (after.degree() != 3) return {};
  const BezierVector first = after.control()[0];
  const BezierVector second = sum(first, before.derivative(1), 1.0 / 3);
  BezierVector third = sum(sum({}, second, 2), first, -1);
  third = sum(third, before.second(1), 1.0 / 6);
  return JointRepair{second, third};
}

double curvature_speed_u_s(double curvature_per_u, double acceleration_u_s2, double tangential_u_s2) {
  const double across = std::sqrt(acceleration_u_s2 * acceleration_u_s2 - tangential_u_s2 * tangential_u_s2);
  return std::sqrt(across / curvature_per_u);
}

}  // namespace kadr::planner
