#pragma once
#include <cstddef>
#include <vector>

#include "emulator/interpolator/lattice/slot.h"

namespace kadr::interpolator::lattice {

/// Newton's polynomial through equally spaced values (paper 002, eq. 1):
///   P(q) = sum_k D^k f0 / k! q (q-1) ... (q-k+1),   q = (x - x0)/h
class ForwardDifferences {
 public:
  /// @param values  f(x0 + i h), i = 0..degree, [degree + 1]
  explicit ForwardDifferences(std::vector<double> values);
  std::size_t degree() const { return d_.size() - 1; }
  double difference(std::size_t k) const { return d_[k]; }  ///< D^k f0
  double value(double q) const;

 private:
  std::vector<double> d_;
};

/// A polynomial marched point by point by as many additions as its degree, in fixed point.
/// After N points the error is N^degree/degree! 2^-(bits + 1) at most.
class FixedMarch {
 public:
  static constexpr std::size_t kMostDegree = 8;
  /// @param differences  D^k of neighbouring points; each is rounded once
  /// @pre degree <= 8, bits <= 100
  FixedMarch(const ForwardDifferences& differences, int fraction_bits);
  double value() const;
  void next();

 private:
  std::array<Wide, kMostDegree + 1> d_{};
  std::size_t degree_;
  double one_;
};

/// Least number of fraction bits for an error of `tolerance` after that many points: log2(N^n/n!/tolerance) - 1.
int march_bits(std::size_t degree, double points, double tolerance);

}  // namespace kadr::interpolator::lattice
