#include "gcode/read/sub_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace kadr::gcode {
namespace {

namespace fs = std::filesystem;

/// True if `path` is below `folder`, both without symbolic links.
bool lies_below(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

}  // namespace

SubFile find_sub_file(std::string_view name, const std::vector<std::string>& folders) {
  SubFile result;
  if (name.find('/') != std::string_view::npos || name.find("..") != std::string_view::npos) {
    result.refusal = "the name holds a path";
    return result;
  }
  for (const std::string& folder : folders) {
    result.looked.push_back(folder);
    std::error_code error;
    const fs::path wanted = fs::path(folder) / (std::string(name) + ".ngc");
    if (!fs::exists(wanted, error)) continue;
    const fs::path root = fs::canonical(folder, error);
    const fs::path real = error ? fs::path() : fs::canonical(wanted, error);
    if (error) {
      result.refusal = wanted.string() + ": " + error.message();
    } else if (!lies_below(real, root)) {
      result.refusal = wanted.string() + " is a link that leads out of its folder";
    } else if (!fs::is_regular_file(real, error)) {
      result.refusal = wanted.string() + " is not a plain file";
    } else {
      result.path = wanted.string();
      result.refusal.clear();
    }
    return result;
  }
  return result;
}

}  // namespace kadr::gcode
