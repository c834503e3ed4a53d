#pragma once
#include <string>

#include "tests/storm/draw.h"

namespace kadr::storm {

/// What moves on a machine are measured by: a usual move lasts some ten control ticks and some ten to thousand steps, over
/// decades of speeds, so that a run is short on every machine.
struct Scale {
  double tau_s = 1e-3;
  double speed_u_s = 100;
  double move_u = 5;
  double step_u = 0.001;
};

struct RandomMachine {
  std::string text;     ///< of the machine file
  std::string letters;  ///< of its axes, in its order
  std::string turning;  ///< those that are rotary
  Scale scale;
  bool has(char letter) const { return letters.find(letter) != std::string::npos; }
  bool rotary(char letter) const { return turning.find(letter) != std::string::npos; }
};

RandomMachine random_machine(Draw& draw);

}  // namespace kadr::storm
