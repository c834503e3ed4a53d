#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

/// Compares F at the two neighbours of a node, a + b slots long. Text at Fig. 2 of paper 002.
class NeighbourLine : public Stepper {
 public:
  NeighbourLine(const LineCurve& line, bool magnitudes)
      : magnitudes_(magnitudes),
        sx_(sign_of(line.delta[0])),
        sy_(sign_of(line.delta[1])),
        a_(magnitude(line.delta[0])),
        b_(magnitude(line.delta[1])),
        left_(a_ + b_) {}
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    slot.value = f_;
    slot.tested = magnitudes_ ? magnitude(f_ + a_) - magnitude(f_ - b_) : (f_ + a_) - (f_ - b_);
    const bool x = slot.tested >= 0;
    slot.step[x ? 0 : 1] = static_cast<std::int8_t>(x ? sx_ : sy_);
    f_ += x ? -b_ : a_;
    return true;
  }

 private:
  bool magnitudes_;
  int sx_, sy_;
  std::int64_t a_, b_, left_, f_ = 0;
};

class PrintedHalfStepArc : public Stepper {
 public:
  explicit PrintedHalfStepArc(const ArcCurve& arc)
      : node_(arc.begin),
        s_(signs_of(quadrant_of(arc.begin, arc.turn), arc.turn)),
        left_(magnitude(arc.end.x - arc.begin.x) + magnitude(arc.end.y - arc.begin.y)) {
    x_inward_ = node_.x != 0 && (node_.y == 0 || sign_of(node_.x) * s_.x < 0);
  }
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    slot.value = f_;
    slot.tested = 2 * s_.x * node_.x + 2 * s_.y * node_.y;
    const bool x = (slot.tested > 0) == x_inward_;
    if (x) {
      f_ += 2 * s_.x * node_.x + 1;
      node_.x += s_.x;
    } else {
      f_ += 2 * s_.y * node_.y + 1;
      node_.y += s_.y;
    }
    slot.step[x ? 0 : 1] = static_cast<std::int8_t>(x ? s_.x : s_.y);
    return true;
  }

 private:
  PlaneNode node_;
  Signs s_;
  std::int64_t left_, f_ = 0;
  bool x_inward_ = true;
};

}  // namespace

MadeStepper printed_difference_line(const LineCurve& line) {
  return std::make_unique<NeighbourLine>(line, false);
}
MadeStepper magnitude_line(const LineCurve& line) { return std::make_unique<NeighbourLine>(line, true); }
MadeStepper printed_half_step_arc(const ArcCurve& arc) { return std::make_unique<PrintedHalfStepArc>(arc); }

}  // namespace kadr::interpolator::lattice
