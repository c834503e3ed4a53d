#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kadr::planner {

/// Arc length S(t) = integral of |B'| over 0 <= t <= 1 (paper 004) of any curve that provides its speed |B'(t)|,
/// and t(S) by Newton's method inside a bracket. [0, 1] is cut into panels of one Gauss-Legendre rule of
/// eight points each, as many as it takes until twice as many change the length by less than 1e-14 of it.
class LengthPanels {
 public:
  /// @param fewest  panels to begin with: 1 where the speed hardly changes
  template <class Speed>
  void measure(const Speed& speed, int fewest) {
    double before = 0;
    for (int panels = fewest;; panels *= 2) {
      sums_u_.assign(1, 0.0);
      for (int i = 0; i < panels; ++i)
        sums_u_.push_back(sums_u_.back() +
                          panel_u(speed, static_cast<double>(i) / panels, (i + 1.0) / panels));
      const bool settled = std::fabs(sums_u_.back() - before) <= kSettled * sums_u_.back();
      if (settled || panels >= kMostPanels) return;
      before = sums_u_.back();
    }
  }

  double length_u() const { return sums_u_.back(); }

  template <class Speed>
  double s_u(const Speed& speed, double t) const {
    const auto panels = static_cast<double>(sums_u_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(t * panels), sums_u_.size() - 2);
    return sums_u_[i] + panel_u(speed, static_cast<double>(i) / panels, t);
  }

  /// Exact to rounding: |S(t) - s| within some ulp of the length.
  template <class Speed>
  double t(const Speed& speed, double s_u) const {
    if (!(s_u > 0)) return 0;
    if (s_u >= length_u()) return 1;
    const auto above = std::upper_bound(sums_u_.begin(), sums_u_.end(), s_u);
    const auto i = static_cast<std::size_t>(above - sums_u_.begin()) - 1;
    const auto panels = static_cast<double>(sums_u_.size() - 1);
    const double begin = static_cast<double>(i) / panels;
    double low = begin, high = static_cast<double>(i + 1) / panels;
    double at = low + (high - low) * (s_u - sums_u_[i]) / (sums_u_[i + 1] - sums_u_[i]);
    for (int n = 0; n < kMostIterations; ++n) {
      const double ahead = sums_u_[i] + panel_u(speed, begin, at) - s_u;
      (ahead > 0 ? high : low) = at;
      double next = at - ahead / speed(at);
      if (std::fabs(next - at) <= 1e-16) return next;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (next == at) return at;
      at = next;
    }
    return at;
  }

 private:
  static constexpr int kMostPanels = 1 << 14;
  static constexpr double kSettled = 1e-14;
  static constexpr int kMostIterations = 100;

  template <class Speed>
  static double panel_u(const Speed& speed, double from, double to) {
    // Gauss-Legendre, eight points on [-1, 1]: the four on one side
    constexpr double kPlace[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                  0.9602898564975363};
    constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                   0.1012285362903763};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0;
    for (int i = 0; i < 4; ++i)
      sum += kWeight[i] * (speed(middle - half * kPlace[i]) + speed(middle + half * kPlace[i]));
    return sum * half;
  }

  std::vector<double> sums_u_;  ///< [panels + 1], S at the panels' ends
};

}  // namespace kadr::planner
