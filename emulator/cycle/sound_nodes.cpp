#include "emulator/cycle/sound_nodes.h"

#include <algorithm>

#include <fmt/format.h>

#include "machine/base/require.h"

namespace kadr::cycle {

void require_sound_nodes(ControlTicks control_tick, const interpolator::CrossingInterpolator& interpolator,
                         const Job& job) {
  // half a step, plus the rounding of the moment of a slow crossing
  constexpr double kMost_steps = 0.5 + 1e-6;
  const std::vector<double>& worst = interpolator.worst_node_error_steps();
  const auto axis = std::max_element(worst.begin(), worst.end());
  // written so that NaN breaks the promise
  if (axis == worst.end() || *axis <= kMost_steps) return;
  const machine::MachineModel& machine = job.given.machine.model;
  const Span& span = job.read.path.segments[interpolator.worst_node_segment()].span;
  throw BrokenPromise(fmt::format(
      "at every pulse the node is within half a step of the path: {}:{}: axis {} is {:.9g} steps from it, "
      "allowed {:.9g}, in the control tick that begins at {:.6f} s",
      job.sources[span.file].name(), span.line,
      machine.axis[static_cast<std::size_t>(axis - worst.begin())].letter, *axis, kMost_steps,
      static_cast<double>(control_tick.value) * machine.clock.tau_s()));
}

}  // namespace kadr::cycle
