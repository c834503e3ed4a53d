#include <string>

#include "checks.h"
#include "emulator/studies/time_law/problem.h"
#include "machine/base/require.h"

/// Problem files of `kadr tube`: whatever the text, there is a problem, or diagnostics that can be printed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kadr;
  constexpr std::size_t kMaxText_bytes = 16384;
  if (size > kMaxText_bytes) return 0;
  SourceSet sources;
  // a folder that is not there: no table and no program is found
  const auto file =
      sources.add(SourceText("/nowhere/problem.toml", {reinterpret_cast<const char*>(data), size}));
  const auto read = studies::read_time_law_problem(sources, file);
  if (read) {
    require(!read->axes.empty(), "a problem has axes");
    return 0;
  }
  require(read.error().has_errors(), "a file that is no problem has an error");
  fuzz::check_diagnostics(read.error(), sources);
  return 0;
}
