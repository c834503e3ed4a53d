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

std::vector<InputFile> find_scenarios(const std::vector<std::string>& paths,
                                      const std::vector<std::string>& allowed) {
  std::vector<InputFile> found;
  for (const fs::path path : paths.empty() ? std::vector<std::string>{"scenarios"} : paths) {
    if (fs::is_regular_file(path)) {
      found.emplace_back(path.string());
    } else if (fs::is_regular_file(path / kFileName)) {
      found.emplace_back(kFileName, InputFolders{path.string(), allowed});
    } else {
      std::vector<std::string> inside;
      if (fs::is_directory(path))
        for (const auto& entry : fs::directory_iterator(path))
          if (fs::is_regular_file(entry.path() / kFileName))
            inside.push_back((entry.path().filename() / kFileName).string());
      if (inside.empty()) throw_missing(path);
      // the order of directory entries is unspecified
      std::sort(inside.begin(), inside.end());
      for (const std::string& file : inside) found.emplace_back(file, InputFolders{path.string(), allowed});
    }
  }
  return found;
}

}  // namespace kadr::scenario
