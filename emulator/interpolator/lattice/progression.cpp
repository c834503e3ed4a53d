#include <algorithm>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

/// Half-step rule on y^2 = 2px by additions alone. N = F' - 1/4 = F + sy y - p sx; an X step lowers F by the
/// constant 2p sx, a Y step raises it by the next odd number.
class ProgressionParabola : public Stepper {
 public:
  explicit ProgressionParabola(const ParabolaCurve& parabola)
      : p_(parabola.p),
        sy_(parabola.y_end < parabola.y_begin ? -1 : 1),
        y_(parabola.y_begin),
        end_(implicit_of(parabola).end) {
    x_ = implicit_of(parabola).begin.x;
    f_ = y_ * y_ - 2 * p_ * x_;
    odd_ = 2 * y_ * sy_ + 1;
    sx_ = way();
  }
  bool next(Slot& slot) override {
    if (y_ == end_.y && x_ == end_.x) return false;
    slot = {};
    slot.value = f_;
    slot.tested = f_ + sy_ * y_ - p_ * sx_;
    if ((slot.tested >= 0) == (p_ * sx_ > 0)) {
      slot.step[0] = static_cast<std::int8_t>(sx_);
      x_ += sx_;
      f_ -= 2 * p_ * sx_;
    } else {
      slot.step[1] = static_cast<std::int8_t>(sy_);
      y_ += sy_;
      f_ += odd_;
      odd_ += 2;
      sx_ = way();
    }
    return true;
  }

 private:
  /// Towards the vertex on the arm that is come in by, away from it on the other; y = 0 belongs to that one.
  int way() const {
    const int outward = p_ > 0 ? 1 : -1;
    return y_ * sy_ < 0 ? -outward : outward;
  }

  std::int64_t p_;
  int sy_, sx_ = 1;
  std::int64_t x_ = 0, y_;
  PlaneNode end_;
  std::int64_t f_ = 0, odd_ = 0;
};

/// x = y^2 / 2p marched over y: two additions per point. The nodes are met, the path between them is not the
/// curve's (paper 002's PTP): Y steps once, then X as often as x has moved.
class NewtonParabola : public Stepper {
 public:
  NewtonParabola(const ParabolaCurve& parabola, int bits)
      : sx_(parabola.p > 0 ? 1 : -1),
        sy_(parabola.y_end < parabola.y_begin ? -1 : 1),
        left_y_(magnitude(parabola.y_end - parabola.y_begin)),
        bits_(bits) {
    const std::int64_t p = magnitude(parabola.p), y = parabola.y_begin, next_y = y + sy_;
    const auto fixed = [&](Wide numerator) {
      const Wide scaled = numerator * (Wide{1} << bits_) * 2 + 2 * p;  // half a unit up
      return scaled >= 0 ? scaled / (4 * p) : -((-scaled + 4 * p - 1) / (4 * p));
    };
    d0_ = fixed(Wide{y} * y);
    d1_ = fixed(Wide{next_y} * next_y - Wide{y} * y);
    d2_ = fixed(2);  // (y + 2s)^2 - 2 (y + s)^2 + y^2
    x_ = rounded();
  }
  bool next(Slot& slot) override {
    const std::int64_t to = rounded();
    if (to == x_ && left_y_ == 0) return false;
    slot = {};
    slot.value = x_;
    slot.tested = shown(d0_);
    slot.tested_y = shown(d1_);
    if (to != x_) {
      const int step = to > x_ ? 1 : -1;
      x_ += step;
      slot.step[0] = static_cast<std::int8_t>(sx_ * step);
      return true;
    }
    --left_y_;
    d0_ += d1_;
    d1_ += d2_;
    slot.step[1] = static_cast<std::int8_t>(sy_);
    return true;
  }

 private:
  std::int64_t rounded() const {
    const Wide one = Wide{1} << bits_, sum = d0_ + one / 2;
    return static_cast<std::int64_t>(sum >= 0 ? sum / one : -((-sum + one - 1) / one));
  }

  int sx_, sy_;
  std::int64_t left_y_;
  int bits_;
  Wide d0_ = 0, d1_ = 0, d2_ = 0;
  std::int64_t x_ = 0;  // |x| of the node
};

/// v = -P(u)/c marched over u by as many additions a point as P has degrees. Differences are taken of whole
/// P(u) and rounded once each, so that the error after N points is N^n/n! 2^-(bits + 1) at most.
class NewtonExplicit : public Stepper {
 public:
  NewtonExplicit(const ImplicitCurve& curve, int bits)
      : v_axis_(static_cast<std::size_t>(explicit_axis(curve.f))), bits_(bits) {
    const bool y_of_x = v_axis_ == 1;
    const std::int64_t u = y_of_x ? curve.begin.x : curve.begin.y, end = y_of_x ? curve.end.x : curve.end.y;
    su_ = end < u ? -1 : 1;
    left_u_ = magnitude(end - u);
    v_ = y_of_x ? curve.begin.y : curve.begin.x;
    Wide c = 0;
    for (const Term& t : curve.f.terms()) {
      const int power = y_of_x ? t.px : t.py;
      if ((y_of_x ? t.py : t.px) == 1)
        c += t.c;
      else
        degree_ = std::max(degree_, power);
    }
    std::array<Wide, kMostOrder + 1> p{};
    for (int i = 0; i <= degree_; ++i) p[static_cast<std::size_t>(i)] = value(curve.f, y_of_x, u + su_ * i);
    for (int k = 1; k <= degree_; ++k)
      for (int i = degree_; i >= k; --i) p[static_cast<std::size_t>(i)] -= p[static_cast<std::size_t>(i) - 1];
    for (std::size_t k = 0; k < p.size(); ++k) d_[k] = fixed(-p[k], c);
  }
  bool next(Slot& slot) override {
    const std::int64_t to = rounded();
    if (to == v_ && left_u_ == 0) return false;
    slot = {};
    slot.value = v_;
    slot.tested = shown(d_[0]);
    slot.tested_y = shown(d_[1]);
    if (to != v_) {
      const int step = to > v_ ? 1 : -1;
      v_ += step;
      slot.step[v_axis_] = static_cast<std::int8_t>(step);
      return true;
    }
    --left_u_;
    for (std::size_t k = 0; k + 1 < d_.size(); ++k) d_[k] += d_[k + 1];
    slot.step[1 - v_axis_] = static_cast<std::int8_t>(su_);
    return true;
  }

 private:
  static constexpr std::size_t kMostOrder = kMostExplicitDegree;

  /// P(u): the terms without v.
  static Wide value(const Polynomial& f, bool y_of_x, std::int64_t u) {
    Wide sum = 0;
    for (const Term& t : f.terms()) {
      if ((y_of_x ? t.py : t.px) != 0) continue;
      Wide term = t.c;
      for (int i = y_of_x ? t.px : t.py; i > 0; --i) term *= u;
      sum += term;
    }
    return sum;
  }
  /// numerator/c to the nearest of 2^-bits, from a half upwards; whole steps and the rest apart, so that
  /// nothing leaves 128 bits.
  Wide fixed(Wide numerator, Wide c) const {
    if (c < 0) {
      c = -c;
      numerator = -numerator;
    }
    Wide steps = numerator / c, rest = numerator % c;
    if (rest < 0) {
      rest += c;
      --steps;
    }
    return steps * (Wide{1} << bits_) + (rest * (Wide{1} << bits_) * 2 + c) / (2 * c);
  }
  std::int64_t rounded() const {
    const Wide one = Wide{1} << bits_, sum = d_[0] + one / 2;
    return static_cast<std::int64_t>(sum >= 0 ? sum / one : -((-sum + one - 1) / one));
  }

  std::size_t v_axis_;
  int bits_, su_ = 1, degree_ = 0;
  std::int64_t left_u_ = 0, v_ = 0;
  std::array<Wide, kMostOrder + 1> d_{};
};

}  // namespace

MadeStepper newton_explicit(const ImplicitCurve& curve, int fraction_bits) {
  return std::make_unique<NewtonExplicit>(curve, fraction_bits);
}
MadeStepper progression_parabola(const ParabolaCurve& parabola) {
  return std::make_unique<ProgressionParabola>(parabola);
}
MadeStepper newton_parabola(const ParabolaCurve& parabola, int fraction_bits) {
  return std::make_unique<NewtonParabola>(parabola, fraction_bits);
}

}  // namespace kadr::interpolator::lattice
