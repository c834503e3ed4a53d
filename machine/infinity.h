#pragma once
#include <limits>

namespace kadr::machine {

/// The value of a limit that is not set.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace kadr::machine
