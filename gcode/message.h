#pragma once
#include <string>
#include <string_view>

#include "gcode/state.h"

namespace kadr::gcode {

/// The text with every byte that is not UTF-8 replaced by U+FFFD: logs and JSON take nothing else.
std::string valid_text(std::string_view text);

/// The text of (DEBUG, ...) or (PRINT, ...): "#5" becomes the parameter's value with six decimals.
std::string expanded_text(std::string_view text, const State& state);

}  // namespace kadr::gcode
