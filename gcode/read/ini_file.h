#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// NAME = VALUE of a section, as written, without blanks around it.
struct IniValue {
  std::string section;
  std::string name;
  std::string text;
};

/// LinuxCNC's INI file of a machine.
struct IniFile {
  std::string name;              ///< of the file, as given
  std::vector<IniValue> values;  ///< in the order of the file; of two with one name the first counts
};

/// Reads an INI file: sections [NAME], lines NAME = VALUE, remarks behind # or ; at the head of a line; a line that
/// ends with a backslash goes on with the next one. Mistakes go to `diagnostics`, all of the file at once.
IniFile read_ini_file(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics);

/// The number of a value; what follows it behind a blank does not count. Nothing if it is none.
std::optional<double> ini_number(std::string_view text);

/// Value of a HAL pin or signal: --hal NAME=VALUE.
struct HalValue {
  std::string name;
  double value = 0;
};

/// True for what may stand between the brackets of #<_hal[NAME]>.
bool is_hal_name(std::string_view name);
/// True for the name of a parameter whose value the machine gives, small letters: "_ini[probe]feed", "_hal[pin]".
bool is_machine_value(std::string_view name);

}  // namespace kadr::gcode
