#include "gcode/dialect.h"

#include <array>

namespace kadr::gcode {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"linuxcnc", "grbl", "marlin", "fanuc"};

}  // namespace

std::string_view dialect_name(Dialect dialect) { return kNames[static_cast<std::size_t>(dialect)]; }

std::optional<Dialect> dialect_of(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Dialect>(i);
  }
  return std::nullopt;
}

}  // namespace kadr::gcode
