#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace kadr::gcode {

/// Which controller's reading of codes that differ.
enum class Dialect : std::uint8_t { linuxcnc, grbl, marlin, fanuc };

/// "linuxcnc"
std::string_view dialect_name(Dialect dialect);
/// The dialect of a name, nothing if there is none.
std::optional<Dialect> dialect_of(std::string_view name);

}  // namespace kadr::gcode
