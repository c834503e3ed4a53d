#include <doctest/doctest.h>

#include <cmath>

#include "machine/motor.h"
#include "machine/words.h"
#include "plant/plant.h"
#include "trains.h"

using namespace kadr;
using namespace kadr::plant;
using namespace kadr::plant::testing;

namespace {

/// Largest difference of the base of two plants that get the same motion, one with pulses or commands altered
/// [um].
double largest_difference_um(const machine::MachineModel& machine,
                             const std::function<void(std::size_t, AxisPulses&)>& alter) {
  const Motion motion = ramp_train(5000, 0.1, 0.03);
  const auto batches = pulse_batches(machine, {motion}, 100);
  Plant plain(machine), altered(machine);
  double largest_um = 0;
  for (std::size_t k = 0; k < batches.size(); ++k) {
    StepBatch other = batches[k];
    alter(k, other.axis[0]);
    REQUIRE(plain.advance(batches[k]));
    REQUIRE(altered.advance(other));
    largest_um = std::max(largest_um, std::fabs(plain.state()[0].base_u - altered.state()[0].base_u) * 1e3);
  }
  return largest_um;
}

}  // namespace

TEST_CASE("each motor reads one of a batch's two descriptions: pulses, or the command that rigid follows") {
  for (const auto& motor : machine::kMotorModels) {
    for (const auto& integrator : machine::kIntegrators) {
      AxisRecipe recipe;
      recipe.motor = motor.value;
      machine::MachineModel machine = make_machine({recipe});
      machine.plant.integrator = integrator.value;
      if (integrator.value == machine::IntegratorKind::oracle && !machine::Motor(machine.axis[0]).linear())
        continue;
      CAPTURE(motor.word);
      CAPTURE(integrator.word);
      const bool command = motor.value == machine::MotorModel::rigid;
      // a late command: a hint at most for a motor that is driven by pulses
      const auto late = [&, before = AxisCommand{}](std::size_t, AxisPulses& axis) mutable {
        std::swap(before, axis.command);
      };
      const auto silent = [](std::size_t, AxisPulses& axis) { axis.clear(); };
      if (command) {
        CHECK(largest_difference_um(machine, late) > 1);
        CHECK(largest_difference_um(machine, silent) == 0);
      } else {
        CHECK(largest_difference_um(machine, late) < 1e-6);
        CHECK(largest_difference_um(machine, silent) > 1);
      }
    }
  }
}
