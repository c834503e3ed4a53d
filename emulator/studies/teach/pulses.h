#pragma once
#include <string>
#include <tl/expected.hpp>

#include "emulator/studies/teach/pulse_timing.h"
#include "emulator/studies/teach/step_table.h"

namespace kadr::studies {

/// The pulses of a case (timed()), if a driver can follow them.
/// @return the pulses, or why there are none
tl::expected<PulseTrain, std::string> pulse_train(const StepTable& table, PulseTiming timing,
                                                  double feed_steps_s, std::int64_t clock_hz);

/// STEP and DIR of every axis as a value change dump (IEEE 1364): a pulse is the rising edge of STEP, DIR
/// changes before it. STEP stays high for `high_ticks`, or half of the smallest spacing if that is less.
std::string render_vcd(const PulseTrain& train, std::int64_t high_ticks);

}  // namespace kadr::studies
