#pragma once
#include <cstdint>

namespace kadr::plant {

/// How often pow() of this program was called. The program's pow() replaces libm's (deterministic_pow.cpp);
/// CVODE calls it for every step size. Referring to this function is what links the replacement in.
std::int64_t pow_calls();

}  // namespace kadr::plant
