#include <algorithm>
#include <filesystem>
#include <system_error>

#include "emulator/scenario/scenario.h"

namespace kadr::scenario {
namespace fs = std::filesystem;

namespace {

constexpr const char* kFileName = "scenario.toml";

[[noreturn]] void throw_missing(const fs::path& path) {
  throw fs::filesystem_error("no scenario there", path,
                             std::make_error_code(std::errc::no_such_file_or_directory));
}

}  // namespace

std::vector<std::string> find_scenarios(const std::vector<std::string>& paths) {
  std::vector<std::string> found;
  for (const fs::path path : paths.empty() ? std::vector<std::string>{"scenarios"} : paths) {
    if (fs::is_regular_file(path)) {
      found.push_back(path.string());
    } else if (fs::is_regular_file(path / kFileName)) {
      found.push_back((path / kFileName).string());
    } else {
      std::vector<std::string> inside;
      if (fs::is_directory(path))
        for (const auto& entry : fs::directory_iterator(path))
          if (fs::is_regular_file(entry.path() / kFileName))
            inside.push_back((entry.path() / kFileName).string());
      if (inside.empty()) throw_missing(path);
      // the order of directory entries is unspecified
      std::sort(inside.begin(), inside.end());
      found.insert(found.end(), inside.begin(), inside.end());
    }
  }
  return found;
}

}  // namespace kadr::scenario
