#pragma once
#include <optional>
#include <string_view>

#include "gcode/gcode.h"

namespace kadr::gcode {

/// Words that are written for one kind of controller alone.
struct DialectSign {
  Dialect dialect;
  std::string_view what;  ///< "macro B (IF .. GOTO)"
  Span place;
};

/// The first sign of another dialect than LinuxCNC in the first 2000 lines of a text.
std::optional<DialectSign> dialect_sign(std::uint32_t file, std::string_view text);

}  // namespace kadr::gcode
