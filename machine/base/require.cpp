#include "machine/base/require.h"

#include <fmt/format.h>

#include <string_view>

namespace kadr {

void break_promise(const char* promise, std::source_location where) {
  // only the part of the path inside the project, so that the message is the same wherever it was built
  std::string_view file = where.file_name();
  for (std::string_view root : {"machine/", "gcode/", "planner/", "plant/", "emulator/", "tests/"}) {
    if (auto at = file.rfind(root); at != std::string_view::npos) {
      file.remove_prefix(at);
      break;
    }
  }
  throw BrokenPromise(fmt::format("{} ({}:{})", promise, file, where.line()));
}

}  // namespace kadr
