#pragma once
#include <string>
#include <string_view>

#include "gcode/interpret/state.h"

namespace kadr::gcode {

/// The text with every byte that is not UTF-8 replaced by U+FFFD: logs and JSON accept only that.
std::string valid_text(std::string_view text);

/// The text of (DEBUG, ...) or (PRINT, ...): "#5" and "#<name>" become the parameter's value, ###### without
/// one. Values have six decimals; after %d none, after %f four, after %.2f two, up to the next format.
/// @param line  number of the line that holds the comment
std::string expanded_text(std::string_view text, State& state, std::uint32_t line);

}  // namespace kadr::gcode
