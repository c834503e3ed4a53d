#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace kadr::gcode {

/// Result of looking for a called file.
struct SubFile {
  std::string path;                 ///< the file; empty: there is none, or it may not be read
  std::string refusal;              ///< why it may not be read
  std::vector<std::string> looked;  ///< folders, in order
};

/// Looks for name.ngc in folders, in their order. A file counts only if it is a plain file that is below
/// its folder once all symbolic links are followed; names that contain a path are refused.
SubFile find_sub_file(std::string_view name, const std::vector<std::string>& folders);

}  // namespace kadr::gcode
