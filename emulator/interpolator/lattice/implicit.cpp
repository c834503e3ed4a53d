#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

/// F(x, y) = 0 by the signs of F and its gradient, in any quadrant; everything in doubled coordinates.
class RuleCurve : public Stepper {
 public:
  RuleCurve(const ImplicitCurve& curve, CurveRule rule, std::int64_t reach)
      : rule_(rule),
        curve_(curve),
        fx_(curve.f.derivative_x()),
        fy_(curve.f.derivative_y()),
        node_(curve.begin),
        reach_(reach) {}

  bool next(Slot& slot) override {
    if (begun_ && node_ == curve_.end) return false;
    if (magnitude(node_.x) > reach_ || magnitude(node_.y) > reach_) return false;
    begun_ = true;
    slot = {};
    const Ahead a = ahead_of(fx_, fy_, curve_.side, node_);
    const std::int64_t x2 = 2 * node_.x, y2 = 2 * node_.y;
    const Wide at_node = curve_.f.doubled(x2, y2);
    slot.value = unscaled(at_node);
    bool x = false, y = false;
    if (rule_ == CurveRule::extra_points) {
      const int sign = a.x_lowers ? 1 : -1;
      const Wide beside_x = curve_.f.doubled(x2 + 2 * a.sx, y2 + a.sy);
      const Wide beside_y = curve_.f.doubled(x2 + a.sx, y2 + 2 * a.sy);
      slot.tested = shown(beside_x);
      slot.tested_y = shown(beside_y);
      x = sign * sign_of(beside_x) > 0 || sign * sign_of(beside_y) >= 0;
      y = sign * sign_of(beside_x) <= 0;
      to_end(a, slot, x, y);
    } else {
      const Wide v = rule_ == CurveRule::classic ? at_node : curve_.f.doubled(x2 + a.sx, y2 + a.sy);
      slot.tested = rule_ == CurveRule::classic ? slot.value : shown(v);
      x = (v >= 0) == a.x_lowers;
      y = !x;
    }
    if (x) slot.step[0] = static_cast<std::int8_t>(a.sx);
    if (y) slot.step[1] = static_cast<std::int8_t>(a.sy);
    node_.x += slot.step[0];
    node_.y += slot.step[1];
    return true;
  }

 private:
  /// A diagonal step may pass the end by: the end one step ahead is taken.
  void to_end(const Ahead& a, Slot& slot, bool& x, bool& y) const {
    const std::int64_t left_x = (curve_.end.x - node_.x) * a.sx, left_y = (curve_.end.y - node_.y) * a.sy;
    if (left_x < 0 || left_y < 0 || left_x > 1 || left_y > 1 || left_x + left_y == 0) return;
    slot.forced = x != (left_x == 1) || y != (left_y == 1);
    x = left_x == 1;
    y = left_y == 1;
  }

  /// F itself: 2^degree F at a node is a multiple of 2^degree.
  std::int64_t unscaled(Wide value) const { return shown(value / (Wide{1} << curve_.f.degree())); }

  CurveRule rule_;
  ImplicitCurve curve_;
  Polynomial fx_, fy_;
  PlaneNode node_;
  std::int64_t reach_;
  bool begun_ = false;
};

}  // namespace

Ahead ahead_of(const Polynomial& fx, const Polynomial& fy, int side, PlaneNode node) {
  const std::int64_t x2 = 2 * node.x, y2 = 2 * node.y;
  int gx = sign_of(fx.doubled(x2, y2));
  const int gy = sign_of(fy.doubled(x2, y2));
  int sx = -side * gy, sy = side * gx;
  if (gy == 0) sx = -side * sign_of(fy.doubled(x2, y2 + sy));
  if (gx == 0) sy = side * sign_of(fx.doubled(x2 + sx, y2));
  if (sx == 0) sx = 1;
  if (sy == 0) sy = 1;
  if (gx == 0) gx = sign_of(fx.doubled(x2 + sx, y2));
  return {sx, sy, gx * sx < 0};
}

MadeStepper rule_curve(const ImplicitCurve& curve, CurveRule rule, std::int64_t reach) {
  return std::make_unique<RuleCurve>(curve, rule, reach);
}

}  // namespace kadr::interpolator::lattice
