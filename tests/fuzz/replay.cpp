#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "checks.h"

/// Runs the body of a fuzz target over files, and over all files of folders.
namespace {

namespace fs = std::filesystem;

int files = 0;
int failures = 0;

void replay(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  ++files;
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  } catch (const std::exception& e) {
    ++failures;
    std::printf("%s: %s\n", path.c_str(), e.what());
  }
}

}  // namespace

int main(int count, char** arguments) {
  for (int i = 1; i < count; ++i) {
    const fs::path path = arguments[i];
    if (!fs::is_directory(path)) {
      replay(path);
      continue;
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) replay(entry.path());
    }
  }
  std::printf("%d files, %d failures\n", files, failures);
  // a folder that is empty or gone tests nothing
  return files > 0 && failures == 0 ? 0 : 1;
}
