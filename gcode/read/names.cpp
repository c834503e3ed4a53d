#include "gcode/read/names.h"

#include "gcode/interpret/predefined.h"
#include "gcode/read/scanner.h"

namespace kadr::gcode {

Names::Names() {
  // the predefined ones first, so that their numbers are their positions in the list
  for (const std::string_view name : predefined_names()) number(name);
}

std::int32_t Names::number(std::string_view written) {
  std::string name;
  for (const char c : written) {
    if (is_blank(c)) continue;
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  const auto [it, is_new] = numbers_.try_emplace(name, size());
  if (is_new) names_.push_back(name);
  return it->second;
}

}  // namespace kadr::gcode
