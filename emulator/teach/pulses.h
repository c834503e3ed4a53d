#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "emulator/teach/step_table.h"
#include "machine/base/count.h"

namespace kadr::emulator {

/// When the pulses of a step table fire.
enum class PulseTiming : std::uint8_t {
  uniform,   ///< a clock slot after the other, whatever the direction
  crossing,  ///< where the ideal path, at a constant feed, crosses the middle between two nodes
};

struct TeachPulse {
  Ticks at;
  int sign = 1;
};

/// The pulses of a case by axis, in ticks of the base clock.
struct PulseTrain {
  std::vector<std::vector<TeachPulse>> axis;  ///< [axes], ascending
  Ticks duration;
  std::int64_t clock_hz = 0;
};

/// Smallest and largest time between pulses of one axis in one direction.
struct Spacing {
  std::int64_t least_ticks = 0;
  std::int64_t most_ticks = 0;  ///< 0: fewer than two pulses
};
Spacing spacing_of(const std::vector<TeachPulse>& pulses);

/// @param feed_steps_s  uniform: slots a second; crossing: speed along the ideal path, steps a second
/// @return the pulses, or why there are none
tl::expected<PulseTrain, std::string> pulse_train(const StepTable& table, PulseTiming timing,
                                                  double feed_steps_s, std::int64_t clock_hz);

/// Names of the axes of a case: X Y Z A B C U V W.
char axis_letter(std::size_t axis);

/// STEP and DIR of every axis as a value change dump (IEEE 1364): a pulse is the rising edge of STEP, DIR
/// changes before it. STEP stays high for `high_ticks`, or half of the smallest spacing if that is less.
std::string render_vcd(const PulseTrain& train, std::int64_t high_ticks);

}  // namespace kadr::emulator
