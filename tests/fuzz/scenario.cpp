#include <cmath>
#include <string>

#include "checks.h"
#include "emulator/scenario/scenario.h"
#include "machine/base/require.h"

/// Scenario files: whatever the text, there is a scenario, or diagnostics that can be printed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kadr;
  constexpr std::size_t kMaxText_bytes = 16384;
  if (size > kMaxText_bytes) return 0;
  SourceSet sources;
  // a folder that is not there: no file of a scenario is found
  const auto read = scenario::read_scenario(
      SourceText("/nowhere/scenario.toml", {reinterpret_cast<const char*>(data), size}), sources);
  if (read) {
    for (const auto& step : read->steps)
      require(std::isfinite(step.value), "what a step asks for is a number");
    return 0;
  }
  require(read.error().has_errors(), "a file that is no scenario has an error");
  fuzz::check_diagnostics(read.error(), sources);
  return 0;
}
