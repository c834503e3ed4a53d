#pragma once
#include <cstdint>

#include "emulator/emulator.h"

namespace kadr::test {

/// A step of an operator's timeline at a control tick.
inline cycle::OperatorStep operator_step(std::int64_t tick, cycle::OperatorAction action, double value = 1) {
  cycle::OperatorStep step;
  step.action = action;
  step.value = value;
  step.tick = ControlTicks{tick};
  return step;
}

}  // namespace kadr::test
