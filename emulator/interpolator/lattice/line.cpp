#include "emulator/interpolator/lattice/line_kernels.h"
#include "emulator/interpolator/lattice/steppers.h"

namespace kadr::interpolator::lattice {
namespace {

/// A line's lengths and directions by axis.
struct Lengths {
  int axes;
  Point length{};
  std::array<std::int8_t, kMostAxes> sign{};
  std::int64_t sum = 0, longest = 0;
  int lead = 0;

  explicit Lengths(const LineCurve& line) : axes(line.axes) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) {
      length[k] = magnitude(line.delta[k]);
      sign[k] = static_cast<std::int8_t>(sign_of(line.delta[k]));
      sum += length[k];
      if (length[k] > longest) {
        longest = length[k];
        lead = static_cast<int>(k);
      }
    }
  }
};

/// One axis of the plane in each slot, chosen by a kernel of line_kernels.h.
template <class Kernel>
class PlaneLine : public Stepper {
 public:
  PlaneLine(const LineCurve& line, Kernel kernel) : at_(line), kernel_(kernel), left_(at_.sum) {}
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    slot.value = kernel_.value();
    slot.tested = kernel_.tested();
    const std::size_t axis = kernel_.next() ? 0 : 1;
    slot.step[axis] = at_.sign[axis];
    return true;
  }

 private:
  Lengths at_;
  Kernel kernel_;
  std::int64_t left_;
};

/// One axis per slot in n axes: the one with the smallest (2 i + offset)/d, ties to the lowest number.
class AxisByAxis : public Stepper {
 public:
  AxisByAxis(const LineCurve& line, int offset) : at_(line), offset_(offset), left_(at_.sum) {}
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    std::size_t chosen = 0;
    bool any = false;
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k) {
      if (done_[k] == at_.length[k]) continue;
      if (!any || Wide{2 * done_[k] + offset_} * at_.length[chosen] <
                      Wide{2 * done_[chosen] + offset_} * at_.length[k])
        chosen = k;
      any = true;
    }
    slot = {};
    slot.value = done_[chosen];
    slot.tested = 2 * done_[chosen] + offset_;
    slot.step[chosen] = at_.sign[chosen];
    ++done_[chosen];
    return true;
  }

 private:
  Lengths at_;
  int offset_;
  std::int64_t left_;
  Point done_{};
};

/// V_i in n axes (specification of paper 002, eq. 2, for each axis against the longest one).
class Diagonal : public Stepper {
 public:
  explicit Diagonal(const LineCurve& line) : at_(line), left_(at_.longest) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k)
      v_[k] = 2 * at_.length[k] - at_.longest;
  }
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    const auto lead = static_cast<std::size_t>(at_.lead);
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k) {
      if (k != lead && at_.axes == 2) slot.tested = v_[k];
      if (v_[k] >= 0) {
        slot.step[k] = at_.sign[k];
        v_[k] -= 2 * at_.longest;
      }
      v_[k] += 2 * at_.length[k];
    }
    // F = a y - b x at the node before
    if (at_.axes == 2) slot.value = shown(Wide{at_.length[0]} * done_.y - Wide{at_.length[1]} * done_.x);
    done_.x += slot.step[0] != 0;
    done_.y += slot.step[1] != 0;
    return true;
  }

 private:
  Lengths at_;
  std::int64_t left_;
  Point v_{};
  PlaneNode done_;
};

/// The signs of F at (x + 1, y + 1/2) and (x + 1/2, y + 1), twice: the diagonal where the line passes between.
class ExtraPoints : public Stepper {
 public:
  explicit ExtraPoints(const LineCurve& line) : at_(line) {}
  bool next(Slot& slot) override {
    const std::int64_t a = at_.length[0], b = at_.length[1];
    if (done_.x == a && done_.y == b) return false;
    slot = {};
    slot.value = f_;
    slot.tested = 2 * f_ - 2 * b + a;
    slot.tested_y = 2 * f_ - b + 2 * a;
    const bool x = slot.tested > 0 || done_.y == b;
    const bool y = !x && (slot.tested_y < 0 || done_.x == a);
    if (!y) {
      slot.step[0] = at_.sign[0];
      ++done_.x;
      f_ -= b;
    }
    if (!x) {
      slot.step[1] = at_.sign[1];
      ++done_.y;
      f_ += a;
    }
    return true;
  }

 private:
  Lengths at_;
  std::int64_t f_ = 0;
  PlaneNode done_;
};

class Dda : public Stepper {
 public:
  Dda(const LineCurve& line, bool preloaded) : at_(line), left_(dda_modulus(at_.longest)) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k)
      registers_.emplace_back(at_.length[k], left_, preloaded);
  }
  bool next(Slot& slot) override {
    if (left_ == 0) return false;
    --left_;
    slot = {};
    slot.tested = registers_.front().sum;
    slot.tested_y = registers_.size() > 1 ? registers_[1].sum : 0;
    for (std::size_t k = 0; k < registers_.size(); ++k)
      if (registers_[k].next()) slot.step[k] = at_.sign[k];
    return true;
  }

 private:
  Lengths at_;
  std::int64_t left_;
  std::vector<DdaRegister> registers_;
};

class PointToPoint : public Stepper {
 public:
  explicit PointToPoint(const LineCurve& line) : at_(line) {}
  bool next(Slot& slot) override {
    if (slot_ == at_.longest) return false;
    slot = {};
    slot.value = slot.tested = slot_;
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k)
      if (slot_ < at_.length[k]) slot.step[k] = at_.sign[k];
    ++slot_;
    return true;
  }

 private:
  Lengths at_;
  std::int64_t slot_ = 0;
};

class ProgressionLine : public Stepper {
 public:
  ProgressionLine(const LineCurve& line, int bits) : at_(line), one_(Wide{1} << bits), sum_(one_ / 2) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k) {
      // rounded once; the error of each slot is the same, so it grows
      slope_[k] = (Wide{2} * at_.length[k] * one_ + at_.longest) / (2 * Wide{at_.longest});
      sums_[k] = sum_;
    }
  }
  bool next(Slot& slot) override {
    if (slot_ == at_.longest) return false;
    ++slot_;
    slot = {};
    const auto lead = static_cast<std::size_t>(at_.lead);
    for (std::size_t k = 0; k < static_cast<std::size_t>(at_.axes); ++k) {
      sums_[k] += slope_[k];
      if (k != lead && at_.axes == 2) slot.tested = shown(sums_[k] - one_);
      if (sums_[k] >= one_) {
        sums_[k] -= one_;
        slot.step[k] = at_.sign[k];
      }
    }
    return true;
  }

 private:
  Lengths at_;
  Wide one_, sum_;
  std::array<Wide, kMostAxes> slope_{}, sums_{};
  std::int64_t slot_ = 0;
};

}  // namespace

MadeStepper classic_line(const LineCurve& line) {
  if (line.axes != 2) return std::make_unique<AxisByAxis>(line, 0);
  return std::make_unique<PlaneLine<ClassicLine>>(
      line, ClassicLine(magnitude(line.delta[0]), magnitude(line.delta[1])));
}

MadeStepper half_step_line(const LineCurve& line, bool tie_to_y) {
  if (line.axes != 2) return std::make_unique<AxisByAxis>(line, 1);
  return std::make_unique<PlaneLine<HalfStepLine>>(
      line, HalfStepLine(magnitude(line.delta[0]), magnitude(line.delta[1]), tie_to_y));
}

MadeStepper diagonal_line(const LineCurve& line) { return std::make_unique<Diagonal>(line); }
MadeStepper extra_point_line(const LineCurve& line) { return std::make_unique<ExtraPoints>(line); }
MadeStepper dda_line(const LineCurve& line, bool preloaded) { return std::make_unique<Dda>(line, preloaded); }
MadeStepper point_to_point(const LineCurve& line) { return std::make_unique<PointToPoint>(line); }
MadeStepper progression_line(const LineCurve& line, int fraction_bits) {
  return std::make_unique<ProgressionLine>(line, fraction_bits);
}

}  // namespace kadr::interpolator::lattice
