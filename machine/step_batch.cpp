#include "machine/step_batch.h"

#include <cmath>

#include "machine/base/require.h"

namespace kadr {
namespace {

constexpr double kMostSteps = 4503599627370496.0;  // 2^52

}  // namespace

Steps lattice_node(double position_u, double step_u) {
  const double node = std::floor(position_u / step_u + 0.5);
  require(std::fabs(node) < kMostSteps, "an axis position is below 2^52 steps");
  return {static_cast<std::int64_t>(node)};
}

}  // namespace kadr
