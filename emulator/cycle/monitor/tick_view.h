#pragma once
#include <cstddef>
#include <vector>

#include "machine/axis_state.h"
#include "machine/step_batch.h"
#include "machine/tick_motion.h"
#include "plant/plant.h"

namespace kadr::cycle {

/// One control tick after it was advanced, for the monitors.
struct TickView {
  const TickMotion& motion;
  const StepBatch& batch;
  std::size_t segment = 0;                                    ///< of the path, at the tick's end
  Ticks begin, end;                                           ///< of the tick
  const std::vector<AxisState>* plant = nullptr;              ///< [axes]; null without plant
  const std::vector<plant::EnergyBalance>* energy = nullptr;  ///< [axes]; null unless log.energy

  bool moved() const { return motion.s_end_u > motion.s_begin_u; }
};

/// Where the tool is on its axis, less where it was commanded to be; mm or deg.
inline double tool_error_u(const AxisState& state, const AxisPulses& pulses) {
  return state.base_u + state.link_u - pulses.command.position_end_u;
}

/// Work of the motor while driving minus its total work: the work that the load gave back, J.
inline double recuperated_J(const plant::EnergyBalance& e) { return e.positive_work_J - e.motor_work_J; }

}  // namespace kadr::cycle
