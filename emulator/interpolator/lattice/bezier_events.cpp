#include "emulator/interpolator/lattice/bezier_events.h"

#include <cmath>

#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

// a step of Newton's method below this changes t no more; a bracket below it can't be halved
constexpr double kSameT = 1e-15;
constexpr int kMostIterations = 60;

/// The roots of 3 c3 t^2 + 2 c2 t + c1 inside (0, 1), ascending, followed by 1.
int turning_points(const std::array<double, 4>& c, std::array<double, 3>& turn) {
  const double a = 3 * c[3], b = 2 * c[2];
  double root[2];
  int roots = 0, count = 0;
  if (a == 0) {
    if (b != 0) root[roots++] = -c[1] / b;
  } else if (const double d = b * b - 4 * a * c[1]; d > 0) {
    // without cancellation
    const double q = -0.5 * (b + (b >= 0 ? std::sqrt(d) : -std::sqrt(d)));
    root[roots++] = q / a;
    if (q != 0) root[roots++] = c[1] / q;
  }
  if (roots == 2 && root[0] > root[1]) {
    const double first = root[1];
    root[1] = root[0];
    root[0] = first;
  }
  for (int i = 0; i < roots; ++i)
    if (root[i] > 0 && root[i] < 1) turn[static_cast<std::size_t>(count++)] = root[i];
  turn[static_cast<std::size_t>(count++)] = 1;
  return count;
}

class EventStepper : public Stepper {
 public:
  explicit EventStepper(const BezierCurve& curve) : events_(curve) {}
  bool next(Slot& slot) override {
    BezierEvents::Event event;
    if (!events_.next(event)) return false;
    slot = {};
    slot.parameter = event.t;
    slot.value = slot.tested = events_.axis(event.axis).node();
    slot.step[event.axis] = static_cast<std::int8_t>(event.direction);
    return true;
  }

 private:
  BezierEvents events_;
};

}  // namespace

void AxisCrossings::start(const BezierCurve& curve, std::size_t axis) {
  const auto p = [&](std::size_t i) { return static_cast<double>(curve.control[i][axis]); };
  if (curve.degree == 1)
    c_ = {p(0), p(1) - p(0), 0, 0};
  else if (curve.degree == 2)
    c_ = {p(0), 2 * (p(1) - p(0)), p(2) - 2 * p(1) + p(0), 0};
  else
    c_ = {p(0), 3 * (p(1) - p(0)), 3 * (p(2) - 2 * p(1) + p(0)), p(3) - 3 * p(2) + 3 * p(1) - p(0)};
  end_ = p(static_cast<std::size_t>(curve.degree));
  node_ = curve.control[0][axis];
  pieces_ = turning_points(c_, turn_);
  piece_ = -1;
  t_ = 0;
  if (begin_piece()) find();
}

bool AxisCrossings::begin_piece() {
  if (++piece_ >= pieces_) {
    t_ = kNone;
    return false;
  }
  const auto i = static_cast<std::size_t>(piece_);
  const double begin_t = piece_ > 0 ? turn_[i - 1] : 0.0;
  const double begin = position(begin_t);
  limit_ = piece_ == pieces_ - 1 ? end_ : position(turn_[i]);
  direction_ = limit_ > begin ? 1 : limit_ < begin ? -1 : 0;
  if (t_ < begin_t) t_ = begin_t;
  return true;
}

void AxisCrossings::pass() {
  node_ += direction_;
  find();
}

void AxisCrossings::find() {
  for (;;) {
    const double level = static_cast<double>(node_) + 0.5 * direction_;
    if (direction_ > 0 ? level < limit_ : direction_ < 0 && level > limit_) {
      t_ = crossing(level);
      return;
    }
    if (!begin_piece()) return;
  }
}

double AxisCrossings::crossing(double level) const {
  double low = t_, high = turn_[static_cast<std::size_t>(piece_)];
  double t = 0.5 * (low + high);
  if (const double v = speed(low); v * direction_ > 0) {
    const double guess = low + (level - position(low)) / v;
    if (guess > low && guess < high) t = guess;
  }
  for (int i = 0; i < kMostIterations; ++i) {
    const double ahead = position(t) - level;
    (ahead * direction_ > 0 ? high : low) = t;
    const double v = speed(t);
    double next = v != 0 ? t - ahead / v : low - 1;
    // convergence comes before the bracket: at the root rounding may put the next t just outside
    if (std::fabs(next - t) <= kSameT) return t;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - t) <= kSameT) return next;
    t = next;
  }
  return t;
}

BezierEvents::BezierEvents(const BezierCurve& curve) : axes_(static_cast<std::size_t>(curve.axes)) {
  for (std::size_t k = 0; k < axes_; ++k) axis_[k].start(curve, k);
}

bool BezierEvents::next(Event& event) {
  std::size_t first = 0;
  for (std::size_t k = 1; k < axes_; ++k)
    if (axis_[k].t() < axis_[first].t()) first = k;
  AxisCrossings& axis = axis_[first];
  if (axis.t() > 1) return false;
  event = {first, axis.direction(), axis.t()};
  axis.pass();
  return true;
}

MadeStepper bezier_events(const BezierCurve& curve) { return std::make_unique<EventStepper>(curve); }

}  // namespace kadr::interpolator::lattice
