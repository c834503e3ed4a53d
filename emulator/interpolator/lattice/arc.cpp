#include <cmath>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {

int quadrant_of(PlaneNode n, Turn turn) {
  if (turn == Turn::ccw)
    return n.x > 0 && n.y >= 0 ? 0 : n.x <= 0 && n.y > 0 ? 1 : n.x < 0 && n.y <= 0 ? 2 : 3;
  return n.x >= 0 && n.y > 0 ? 0 : n.x < 0 && n.y >= 0 ? 1 : n.x <= 0 && n.y < 0 ? 2 : 3;
}

Signs signs_of(int quadrant, Turn turn) {
  const int way = turn == Turn::ccw ? 1 : -1;
  return {quadrant < 2 ? -way : way, quadrant == 0 || quadrant == 3 ? way : -way};
}

namespace {

/// Circle F = x^2 + y^2 - R^2 by the signs of F at the node, half a step ahead or at extra points.
class RuleArc : public Stepper {
 public:
  RuleArc(const ArcCurve& arc, ArcRule rule)
      : rule_(rule),
        turn_(arc.turn),
        node_(arc.begin),
        end_(arc.end),
        quadrant_(quadrant_of(arc.begin, arc.turn)) {
    const int way = turn_ == Turn::ccw ? 1 : -1;
    // the end's quadrant is the one that is left there
    int last = quadrant_of(end_, turn_);
    if (end_.x == 0 || end_.y == 0) last = (last - way) & 3;
    quadrants_left_ = (way * (last - quadrant_)) & 3;
    const Wide cross = Wide{arc.begin.x} * end_.y - Wide{arc.begin.y} * end_.x;
    if (quadrants_left_ == 0 && way * sign_of(cross) <= 0) quadrants_left_ = 4;
    const std::int64_t reach = magnitude(node_.x) + magnitude(node_.y);
    slots_left_ = 16 * (reach + 4);
  }

  bool next(Slot& slot) override {
    if (slots_left_-- <= 0 || (quadrants_left_ == 0 && node_ == end_)) return false;
    const Signs s = signs_of(quadrant_, turn_);
    const bool last = quadrants_left_ == 0;
    const bool can_x = !last || (end_.x - node_.x) * s.x > 0, can_y = !last || (end_.y - node_.y) * s.y > 0;
    if (!can_x && !can_y) return false;  // the end was missed
    slot = {};
    slot.value = f_;
    bool x = false, y = false;
    decide(s, slot, x, y);
    block(can_x, can_y, slot, x, y);
    if (x) {
      f_ += 2 * s.x * node_.x + 1;
      node_.x += s.x;
      slot.step[0] = static_cast<std::int8_t>(s.x);
    }
    if (y) {
      f_ += 2 * s.y * node_.y + 1;
      node_.y += s.y;
      slot.step[1] = static_cast<std::int8_t>(s.y);
    }
    turn_quadrant();
    return true;
  }

 private:
  /// Whether an X step lowers F: it points to the Y axis.
  bool x_inward(Signs s) const { return node_.x != 0 && (node_.y == 0 || sign_of(node_.x) * s.x < 0); }

  void decide(Signs s, Slot& slot, bool& x, bool& y) const {
    const bool inward_x = x_inward(s);
    // 4F at (x + sx, y + sy/2) and (x + sx/2, y + sy)
    const std::int64_t beside_x = 4 * (f_ + 2 * s.x * node_.x + 1) + 4 * s.y * node_.y + 1;
    const std::int64_t beside_y = 4 * (f_ + 2 * s.y * node_.y + 1) + 4 * s.x * node_.x + 1;
    if (rule_ == ArcRule::classic || rule_ == ArcRule::half_step) {
      slot.tested = rule_ == ArcRule::classic ? f_ : f_ + s.x * node_.x + s.y * node_.y;
      x = (slot.tested >= 0) == inward_x;
      y = !x;
      return;
    }
    slot.tested = beside_x;
    slot.tested_y = beside_y;
    // with F so signed that X lowers it: the curve is beyond the point
    const bool only_x = inward_x ? beside_x > 0 : beside_x < 0;
    const bool only_y = inward_x ? beside_y < 0 : beside_y > 0;
    if (rule_ == ArcRule::extra_points) {
      x = only_x || !only_y;
      y = !only_x;
      return;
    }
    // octants: the axis of the smaller coordinate steps always; on a diagonal that of the octant entered
    const std::int64_t ax = magnitude(node_.x), ay = magnitude(node_.y);
    const bool x_leads = ax < ay || (ax == ay && inward_x);
    x = x_leads || !only_y;
    y = !x_leads || !only_x;
  }

  /// An axis that has arrived is blocked.
  static void block(bool can_x, bool can_y, Slot& slot, bool& x, bool& y) {
    if (x && !can_x) {
      x = false;
      y = true;
      slot.forced = true;
    }
    if (y && !can_y) {
      y = false;
      x = true;
      slot.forced = true;
    }
  }

  void turn_quadrant() {
    const int now = quadrant_of(node_, turn_);
    if (now == quadrant_) return;
    const int way = turn_ == Turn::ccw ? 1 : -1;
    if (((way * (now - quadrant_)) & 3) == 1 && quadrants_left_ > 0) --quadrants_left_;
    quadrant_ = now;
  }

  ArcRule rule_;
  Turn turn_;
  PlaneNode node_, end_;
  int quadrant_;
  int quadrants_left_ = 0;
  std::int64_t f_ = 0, slots_left_ = 0;
};

double swept_rad(const ArcCurve& arc) {
  const double cross = static_cast<double>(arc.begin.x) * static_cast<double>(arc.end.y) -
                       static_cast<double>(arc.begin.y) * static_cast<double>(arc.end.x);
  const double dot = static_cast<double>(arc.begin.x) * static_cast<double>(arc.end.x) +
                     static_cast<double>(arc.begin.y) * static_cast<double>(arc.end.y);
  double angle = std::atan2(arc.turn == Turn::ccw ? cross : -cross, dot);
  if (angle <= 0) angle += 2 * M_PI;
  return angle;
}

class DdaArc : public Stepper {
 public:
  DdaArc(const ArcCurve& arc, bool sequential)
      : sequential_(sequential), way_(arc.turn == Turn::ccw ? 1 : -1), node_(arc.begin) {
    const double radius = std::hypot(static_cast<double>(node_.x), static_cast<double>(node_.y));
    while (static_cast<double>(modulus_) <= radius) modulus_ *= 2;
    sum_x_ = sum_y_ = modulus_ / 2;
    left_ = std::llround(swept_rad(arc) * static_cast<double>(modulus_));
  }
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    const std::int64_t x = node_.x;
    sum_x_ -= way_ * node_.y;
    slot.tested = sum_x_;
    slot.step[0] = carry(sum_x_);
    node_.x += slot.step[0];
    sum_y_ += way_ * (sequential_ ? node_.x : x);
    slot.tested_y = sum_y_;
    slot.step[1] = carry(sum_y_);
    node_.y += slot.step[1];
    return true;
  }

 private:
  std::int8_t carry(std::int64_t& sum) const {
    const int step = sum >= modulus_ ? 1 : sum < 0 ? -1 : 0;
    sum -= step * modulus_;
    return static_cast<std::int8_t>(step);
  }

  bool sequential_;
  int way_;
  PlaneNode node_;
  std::int64_t modulus_ = 1, sum_x_ = 0, sum_y_ = 0, left_ = 0;
};

class ChordArc : public Stepper {
 public:
  ChordArc(const ArcCurve& arc, double tolerance) : arc_(arc), node_(arc.begin) {
    const double radius = std::hypot(static_cast<double>(node_.x), static_cast<double>(node_.y));
    sweep_rad_ = swept_rad(arc);
    const double half_rad = tolerance < radius ? std::acos(1 - tolerance / radius) : M_PI / 2;
    chords_ = static_cast<std::int64_t>(std::ceil(sweep_rad_ / (2 * half_rad)));
  }
  bool next(Slot& slot) override {
    while (!line_ || !line_->next(slot)) {
      if (chord_ == chords_) return false;
      begin_chord();
    }
    return true;
  }

 private:
  void begin_chord() {
    ++chord_;
    PlaneNode to = arc_.end;
    if (chord_ < chords_) {
      const double angle = (arc_.turn == Turn::ccw ? 1 : -1) * sweep_rad_ * static_cast<double>(chord_) /
                           static_cast<double>(chords_);
      const double c = std::cos(angle), s = std::sin(angle);
      const auto x = static_cast<double>(arc_.begin.x), y = static_cast<double>(arc_.begin.y);
      to = {std::llround(c * x - s * y), std::llround(s * x + c * y)};
    }
    line_ = diagonal_line({2, {to.x - node_.x, to.y - node_.y}});
    node_ = to;
  }

  ArcCurve arc_;
  PlaneNode node_;  // end of the chord
  double sweep_rad_ = 0;
  std::int64_t chords_ = 0, chord_ = 0;
  MadeStepper line_;
};

}  // namespace

MadeStepper rule_arc(const ArcCurve& arc, ArcRule rule) { return std::make_unique<RuleArc>(arc, rule); }
MadeStepper dda_arc(const ArcCurve& arc, bool sequential) {
  return std::make_unique<DdaArc>(arc, sequential);
}
MadeStepper chord_arc(const ArcCurve& arc, double tolerance) {
  return std::make_unique<ChordArc>(arc, tolerance);
}

}  // namespace kadr::interpolator::lattice
