#include <cmath>
#include <string>

#include "checks.h"
#include "machine/base/require.h"
#include "machine/machine.h"
#include "machine/machine_file.h"

/// Machine files: whatever the text, there is a machine whose numbers can be used, or diagnostics that can be printed.
namespace {

using namespace kadr;

constexpr std::size_t kMaxText_bytes = 16384;
constexpr std::size_t kMaxAxes = 9;

void check_model(const machine::MachineModel& model) {
  require(!model.axis.empty() && model.axis.size() <= kMaxAxes, "a machine has one to nine axes");
  require(model.clock.control_tick.value > 0, "a control tick has a length");
  for (const machine::AxisModel& axis : model.axis) {
    require(std::isfinite(axis.step_u) && axis.step_u > 0, "a step has a length");
    require(std::isfinite(axis.max_feed_u_s) && axis.max_feed_u_s > 0, "an axis moves");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxText_bytes) return 0;
  SourceSet sources;
  const auto read = machine::read_machine(
      SourceText("/nowhere/fuzz.toml", {reinterpret_cast<const char*>(data), size}), sources);
  if (read) {
    check_model(read->model);
    return 0;
  }
  require(read.error().has_errors(), "a file that is no machine has an error");
  fuzz::check_diagnostics(read.error(), sources);
  return 0;
}
