#include "emulator/interpolator/lattice/newton.h"

#include <cmath>
#include <utility>

namespace kadr::interpolator::lattice {

ForwardDifferences::ForwardDifferences(std::vector<double> values) : d_(std::move(values)) {
  for (std::size_t k = 1; k < d_.size(); ++k)
    for (std::size_t i = d_.size() - 1; i >= k; --i) d_[i] -= d_[i - 1];
}

double ForwardDifferences::value(double q) const {
  double r = 0;
  for (std::size_t k = d_.size() - 1; k > 0; --k) {
    const auto order = static_cast<double>(k);
    r = (r + d_[k]) * (q - order + 1) / order;
  }
  return r + d_[0];
}

FixedMarch::FixedMarch(const ForwardDifferences& differences, int fraction_bits)
    : degree_(differences.degree()), one_(std::ldexp(1.0, fraction_bits)) {
  for (std::size_t k = 0; k <= degree_; ++k) {
    const double scaled = differences.difference(k) * one_;
    // beyond 2^53 a double is whole already
    d_[k] = static_cast<Wide>(std::fabs(scaled) < 9007199254740992.0 ? std::nearbyint(scaled) : scaled);
  }
}

double FixedMarch::value() const { return static_cast<double>(d_[0]) / one_; }

void FixedMarch::next() {
  for (std::size_t k = 0; k < degree_; ++k) d_[k] += d_[k + 1];
}

int march_bits(std::size_t degree, double points, double tolerance) {
  double most = 1;
  for (std::size_t k = 1; k <= degree; ++k) most *= points / static_cast<double>(k);
  int bits = 0;
  for (double error = 0.5 * most; error > tolerance && bits < 100; error /= 2) ++bits;
  return bits;
}

}  // namespace kadr::interpolator::lattice
