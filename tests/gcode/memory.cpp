#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "support.h"

#if defined(__SANITIZE_ADDRESS__)
#define KADR_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KADR_ADDRESS_SANITIZER
#endif
#endif
#ifdef KADR_ADDRESS_SANITIZER
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();  // GCC's packages have no header with it
#endif

using namespace kadr;
using namespace kadr::gcode;

namespace {

/// Memory of this process that is in use now: pages; under the address sanitizer, which keeps pages of its
/// own and what was freed, the bytes that are allocated.
std::int64_t used_bytes() {
#ifdef KADR_ADDRESS_SANITIZER
  return static_cast<std::int64_t>(__sanitizer_get_current_allocated_bytes());
#else
  std::ifstream statm("/proc/self/statm");
  std::int64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * ::sysconf(_SC_PAGESIZE);
#endif
}

}  // namespace

TEST_CASE(
    "a program file of 16 MB is interpreted in 4 MB of memory beside its text, a warning in its last line "
    "included") {
  const std::string path =
      (std::filesystem::temp_directory_path() / fmt::format("kadr_memory_{}.ngc", ::getpid())).string();
  {
    std::ofstream file(path, std::ios::binary);
    const std::string line = "G1 X1.2500 Y-3.7500 Z0.5000\n";
    std::string piece;
    while (piece.size() + line.size() <= (std::size_t{1} << 20)) piece += line;
    file << "F600\n";
    for (int i = 0; i < 16; ++i) file << piece;
    file << "(LOG,x)\n";
  }
  SourceSet sources;
  const auto program = sources.add(SourceText::open(path, 0));
  std::remove(path.c_str());
  Diagnostics diagnostics;
  const std::int64_t before = used_bytes();
  std::int64_t most = before;
  std::uint64_t blocks = 0;
  interpret(
      sources, program, {},
      [&](const Block&) {
        if (++blocks % 5000 == 0) most = std::max(most, used_bytes());
      },
      diagnostics);
  for (const Diagnostic& d : diagnostics.list())
    CHECK(render_human(d, sources).find("(LOG,x)") != std::string::npos);
  most = std::max(most, used_bytes());
  CHECK(diagnostics.list().size() == 1);
  CHECK(blocks > 590'000);
  constexpr std::int64_t kAllowed_bytes = std::int64_t{4} << 20;
  CHECK(most - before < kAllowed_bytes);
}
