#include "emulator/interpolator/line_crossings.h"

#include <algorithm>
#include <cmath>

namespace kadr::interpolator {

LineCrossings LineCrossings::between(double begin, double end, std::int64_t node_begin, std::int64_t node_end,
                                     double length_u) {
  LineCrossings line;
  line.sign = node_end > node_begin ? 1 : -1;
  line.count = node_end > node_begin ? node_end - node_begin : node_begin - node_end;
  const double level = static_cast<double>(node_begin) + 0.5 * line.sign;
  line.first_level = std::fabs(level - begin);
  line.spacing_u = length_u / std::fabs(end - begin);
  return line;
}

std::int64_t LineCrossings::reached(double s_end_u) const {
  const double estimate = std::floor(s_end_u / spacing_u - first_level) + 1.0;
  const double most = static_cast<double>(count);
  auto k = static_cast<std::int64_t>(std::clamp(estimate, static_cast<double>(next), most));
  // the estimate may be off by rounding; the positions of the crossings decide
  while (k < count && s_u(k) <= s_end_u) ++k;
  while (k > next && s_u(k - 1) > s_end_u) --k;
  return k;
}

}  // namespace kadr::interpolator
