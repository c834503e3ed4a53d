#pragma once
#include "emulator/interpolator/lattice/curve.h"

namespace kadr::interpolator::lattice {

/// Half-crossings of one axis of a Bezier curve: the moments t at which x(t) = i + 1/2, in order.
///
/// [0, 1] is cut at the roots of x'(t); on each monotone piece the crossings of successive levels are single,
/// bracketed by the crossing before and the piece's end, and found by Newton's method that falls back on
/// halving. Doubles in a fixed order of + - * / sqrt: the same bits with every compiler.
class AxisCrossings {
 public:
  static constexpr double kNone = 2.0;  ///< a t after every curve

  void start(const BezierCurve& curve, std::size_t axis);
  double t() const { return t_; }  ///< of the next crossing; kNone: there is none
  int direction() const { return direction_; }
  std::int64_t node() const { return node_; }
  /// The crossing at t() is made: the node moves, and the next crossing is found.
  void pass();

  double position(double t) const { return c_[0] + t * (c_[1] + t * (c_[2] + t * c_[3])); }
  double speed(double t) const { return c_[1] + t * (2 * c_[2] + 3 * t * c_[3]); }

 private:
  void find();
  bool begin_piece();
  double crossing(double level) const;

  std::array<double, 4> c_{};     // x(t) = c0 + c1 t + c2 t^2 + c3 t^3
  std::array<double, 3> turn_{};  // ends of the monotone pieces; the last is 1
  int pieces_ = 0, piece_ = -1;
  std::int64_t node_ = 0;
  double end_ = 0;    // x(1), a node
  double limit_ = 0;  // x at the piece's end
  double t_ = 0;
  int direction_ = 0;
};

/// Pulses of a Bezier curve in n axes in the order of t, ties in the order of axis numbers. Invariant: after
/// each pulse |node - x(t)| <= 1/2 on every axis; the last node is the end point.
class BezierEvents {
 public:
  explicit BezierEvents(const BezierCurve& curve);
  struct Event {
    std::size_t axis = 0;
    int direction = 1;
    double t = 0;
  };
  bool next(Event& event);
  const AxisCrossings& axis(std::size_t k) const { return axis_[k]; }

 private:
  std::size_t axes_;
  std::array<AxisCrossings, kMostAxes> axis_;
};

}  // namespace kadr::interpolator::lattice
