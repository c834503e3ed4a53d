#include "planner/verify/verify_curve.h"

#include <cstddef>

#include "planner/bezier/path_curve.h"

namespace kadr::planner {

bool turns_back(const PathCurve& curve) {
  constexpr int kPlaces = 32;
  for (int k = 1; k <= kPlaces; ++k) {
    double along = 0;
    for (std::size_t j = 0; j < curve.axes(); ++j)
      along += curve.coefficient(j, 1) * curve.derivative(j, static_cast<double>(k) / kPlaces);
    if (along < 0) return true;
  }
  return false;
}

}  // namespace kadr::planner
