#pragma once
#include <vector>

#include "emulator/studies/teach/follow.h"
#include "machine/base/count.h"
#include "machine/base/vocabulary.h"

namespace kadr::studies {

/// When the pulses of a step table fire.
enum class PulseTiming : std::uint8_t {
  uniform,   ///< a clock slot after the other, whatever the direction
  crossing,  ///< where the ideal path, at a constant feed, crosses the middle between two nodes
};
inline constexpr Vocabulary<PulseTiming, 2> kPulseTimings{{
    {PulseTiming::uniform, "uniform", "slot after slot"},
    {PulseTiming::crossing, "crossing", "where the path crosses the middle between two nodes"},
}};
static_assert(kPulseTimings.complete());

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

/// Smallest time between two pulses of one axis; INT64_MAX: no axis has two.
std::int64_t least_spacing_ticks(const PulseTrain& train);

/// @param feed_steps_s  uniform: slots per second; crossing: speed along the ideal path, steps per second
/// @pre crossing: the table has crossings
PulseTrain timed(const StepTable& table, PulseTiming timing, double feed_steps_s, std::int64_t clock_hz);

/// Names of the axes of a case: X Y Z A B C U V W.
char axis_letter(std::size_t axis);

}  // namespace kadr::studies
