#include "emulator/studies/teach/pulses.h"

#include <fmt/format.h>

namespace kadr::studies {
namespace {

// two edges of a pulse and one of DIR need separate ticks
constexpr std::int64_t kLeastSpacing_ticks = 4;

}  // namespace

tl::expected<PulseTrain, std::string> pulse_train(const StepTable& table, PulseTiming timing,
                                                  double feed_steps_s, std::int64_t clock_hz) {
  if (timing == PulseTiming::crossing && table.crossings_steps.size() != table.rows.size())
    return tl::unexpected(
        fmt::format("--timing crossing goes with half_step and crossing, whose pulses are crossings; got {}",
                    interpolator::lattice::entry_of(table.method).name()));
  PulseTrain train = timed(table, timing, feed_steps_s, clock_hz);
  if (const std::int64_t least = least_spacing_ticks(train); least < kLeastSpacing_ticks)
    return tl::unexpected(
        fmt::format("pulses of one axis are {} ticks of {} Hz apart, at least {} are needed; a lower --feed "
                    "spreads them",
                    least, clock_hz, kLeastSpacing_ticks));
  return train;
}

}  // namespace kadr::studies
