#include "planner/positioning/damped_zero.h"

#include <cmath>

#include "machine/base/numbers.h"

namespace kadr::planner {
namespace {

constexpr int kScan = 24;  ///< points sampled per period
constexpr int kBisections = 60;

/// F of a ramp: the vibration it leaves, with its phase.
struct Swing {
  double size, angle_rad;
};

class Search {
 public:
  Search(const Mode& mode, double down_s)
      : decay_per_s_(mode.zeta * mode.omega_rad_s),
        damped_rad_s_(mode.damped_rad_s()),
        period_s_(mode.damped_period_s()),
        down_s_(down_s),
        down_(left_by(down_s)) {}

  /// The longest acceleration leaves enough, however late the deceleration begins.
  bool possible(double from_s) const { return !(left_by(longest_s()).size < wanted(from_s + period_s_)); }

  std::optional<DampedZero> find(double from_s) const {
    double low = from_s, at_low = late_turns(low);
    for (int i = 1; i <= kScan; ++i) {
      const double high = from_s + period_s_ * i / kScan;
      const double at_high = late_turns(high);
      if (at_low <= 0.0 && at_high > 0.0 && at_high - at_low < 0.5) {
        const double shift = crossing(low, high);
        return DampedZero{ramp_for(shift), shift};
      }
      low = high;
      at_low = at_high;
    }
    return std::nullopt;
  }

 private:
  Swing left_by(double ramp_s) const {
    const SinCos turn = exact_sincos(damped_rad_s_ * ramp_s);
    const double grown = exact_exp(decay_per_s_ * ramp_s);
    const double re = grown * turn.cos - 1.0, im = grown * turn.sin;
    return {std::sqrt(re * re + im * im) / ramp_s, exact_atan2(im, re)};
  }
  double longest_s() const { return down_s_ + 0.5 * period_s_; }
  double wanted(double shift_s) const { return exact_exp(decay_per_s_ * shift_s) * down_.size; }

  /// The acceleration that leaves as much as has to be left.
  double ramp_for(double shift_s) const {
    const double size = wanted(shift_s);
    double low = down_s_, high = longest_s();
    for (int i = 0; i < kBisections; ++i) {
      const double mid = 0.5 * (low + high);
      (left_by(mid).size < size ? low : high) = mid;
    }
    return low;
  }
  /// Phase difference of the two vibrations in turns, -1/2 to 1/2.
  double late_turns(double shift_s) const {
    const double turns =
        (damped_rad_s_ * shift_s + down_.angle_rad - left_by(ramp_for(shift_s)).angle_rad) / (2.0 * kPi);
    return turns - std::floor(turns + 0.5);
  }
  double crossing(double low_s, double high_s) const {
    for (int i = 0; i < kBisections; ++i) {
      const double mid = 0.5 * (low_s + high_s);
      (late_turns(mid) <= 0.0 ? low_s : high_s) = mid;
    }
    return low_s;
  }

  double decay_per_s_, damped_rad_s_, period_s_, down_s_;
  Swing down_;
};

}  // namespace

std::optional<DampedZero> damped_zero(const Mode& mode, double down_s, double from_s) {
  const Search search(mode, down_s);
  return search.possible(from_s) ? search.find(from_s) : std::nullopt;
}

}  // namespace kadr::planner
