#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

namespace kadr::gcode {

/// What M66 waits for; the numbers are those of its L word.
enum class WaitMode : std::uint8_t { immediate, rise, fall, high, low };

inline constexpr Vocabulary<WaitMode, 5> kWaitModes{{
    {WaitMode::immediate, "immediate", "reads at once"},
    {WaitMode::rise, "rise", "until the input changes from 0"},
    {WaitMode::fall, "fall", "until the input changes to 0"},
    {WaitMode::high, "high", "until the input is not 0"},
    {WaitMode::low, "low", "until the input is 0"},
}};
static_assert(kWaitModes.complete());

}  // namespace kadr::gcode
