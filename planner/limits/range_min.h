#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace kadr::planner {

/// Smallest value of any index range of a fixed array: blocks of 16 scanned, a sparse table over the blocks.
/// O(n) to build and n / 16 * log2(n / 16) words of memory; a query touches at most 32 values.
class RangeMin {
 public:
  explicit RangeMin(const std::vector<double>& values) : v_(values) {
    const std::size_t blocks = (v_.size() + kBlock - 1) / kBlock;
    level_.emplace_back(blocks);
    for (std::size_t b = 0; b < blocks; ++b)
      level_[0][b] =
          *std::min_element(v_.begin() + static_cast<std::ptrdiff_t>(b * kBlock),
                            v_.begin() + static_cast<std::ptrdiff_t>(std::min((b + 1) * kBlock, v_.size())));
    for (std::size_t width = 1; 2 * width <= blocks; width *= 2) {
      const std::vector<double>& below = level_.back();
      std::vector<double> next(blocks - 2 * width + 1);
      for (std::size_t b = 0; b < next.size(); ++b) next[b] = std::min(below[b], below[b + width]);
      level_.push_back(std::move(next));
    }
  }

  /// Smallest of values[first..last], both ends included, first <= last.
  double min(std::size_t first, std::size_t last) const {
    const std::size_t b0 = first / kBlock + 1;
    const std::size_t b1 = last / kBlock;
    if (b0 > b1) return scan(first, last);
    double m = std::min(scan(first, b0 * kBlock - 1), scan(b1 * kBlock, last));
    if (b0 < b1) m = std::min(m, blocks_min(b0, b1 - 1));
    return m;
  }

  /// Lowest index in [first, last] whose value is <= level; last + 1 if there is none.
  std::size_t find_at_most(double level, std::size_t first, std::size_t last) const {
    std::size_t i = first;
    for (; i <= last && i % kBlock != 0; ++i)
      if (v_[i] <= level) return i;
    if (i > last) return last + 1;
    // double the step over whole blocks, then halve it again
    std::size_t block = i / kBlock;
    const std::size_t end = last / kBlock;  // scanned one by one, being perhaps cut
    std::size_t k = 0;
    while (block + (std::size_t{1} << k) <= end && level_[k][block] > level) {
      block += std::size_t{1} << k;
      if (k + 1 < level_.size()) ++k;
    }
    for (;; --k) {
      if (block + (std::size_t{1} << k) <= end && level_[k][block] > level) block += std::size_t{1} << k;
      if (k == 0) break;
    }
    for (i = block * kBlock; i <= last; ++i)
      if (v_[i] <= level) return i;
    return last + 1;
  }

 private:
  static constexpr std::size_t kBlock = 16;
  double scan(std::size_t first, std::size_t last) const {
    double m = v_[first];
    for (std::size_t i = first + 1; i <= last; ++i) m = std::min(m, v_[i]);
    return m;
  }
  double blocks_min(std::size_t b0, std::size_t b1) const {
    std::size_t k = 0;
    while ((std::size_t{2} << k) <= b1 - b0 + 1) ++k;
    return std::min(level_[k][b0], level_[k][b1 + 1 - (std::size_t{1} << k)]);
  }

  const std::vector<double>& v_;
  std::vector<std::vector<double>> level_;
};

}  // namespace kadr::planner
