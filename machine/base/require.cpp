#include "machine/base/require.h"

#include <fmt/format.h>

#include <string_view>

namespace kadr {

void break_promise(const char* promise, const char* path, int line) {
  // only the part of the path inside the project, so that the message is the same wherever it was built
  std::string_view file = path;
  for (std::string_view root : {"machine/", "gcode/", "planner/", "plant/", "emulator/", "tests/"}) {
    if (auto at = file.rfind(root); at != std::string_view::npos) {
      file.remove_prefix(at);
      break;
    }
  }
  throw BrokenPromise(fmt::format("{} ({}:{})", promise, file, line));
}

}  // namespace kadr
