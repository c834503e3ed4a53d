#include "emulator/studies/teach/pulse_timing.h"

#include <algorithm>
#include <cmath>

namespace kadr::studies {

char axis_letter(std::size_t axis) { return "XYZABCUVW"[axis]; }

Spacing spacing_of(const std::vector<TeachPulse>& pulses) {
  Spacing out;
  for (std::size_t i = 1; i < pulses.size(); ++i) {
    if (pulses[i].sign != pulses[i - 1].sign) continue;
    const std::int64_t apart = (pulses[i].at - pulses[i - 1].at).value;
    out.least_ticks = out.most_ticks == 0 ? apart : std::min(out.least_ticks, apart);
    out.most_ticks = std::max(out.most_ticks, apart);
  }
  return out;
}

std::int64_t least_spacing_ticks(const PulseTrain& train) {
  std::int64_t least = INT64_MAX;
  for (const auto& pulses : train.axis)
    for (std::size_t i = 1; i < pulses.size(); ++i)
      least = std::min(least, (pulses[i].at - pulses[i - 1].at).value);
  return least;
}

PulseTrain timed(const StepTable& table, PulseTiming timing, double feed_steps_s, std::int64_t clock_hz) {
  PulseTrain train;
  train.clock_hz = clock_hz;
  train.axis.resize(static_cast<std::size_t>(table.axes));
  const double step_ticks = static_cast<double>(clock_hz) / feed_steps_s;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double place =
        timing == PulseTiming::uniform ? static_cast<double>(i + 1) : table.crossings_steps[i];
    const Ticks at{std::llround(place * step_ticks)};
    for (std::size_t k = 0; k < train.axis.size(); ++k)
      if (table.rows[i].slot.step[k] != 0) train.axis[k].push_back({at, table.rows[i].slot.step[k]});
  }
  const double places =
      timing == PulseTiming::uniform ? static_cast<double>(table.rows.size() + 1) : table.length_steps;
  train.duration = Ticks{std::llround(places * step_ticks)};
  return train;
}

}  // namespace kadr::studies
