#pragma once
#include <string>
#include <vector>

#include "emulator/studies/teach/pulses.h"
#include "emulator/studies/teach/step_table.h"
#include "emulator/text/json.h"

/// The output of `kadr teach`.
namespace kadr::studies {

/// Title line, one row per slot, and the result.
std::string render_step_table(const TeachCase& subject, const StepTable& table);
/// "i,x,y,F,G=2F',move,deviation_steps": one row per slot and one for the last node.
std::string render_step_csv(const StepTable& table);
text::Json json_of(const TeachCase& subject, const StepTable& table);

/// "+X", "-X+Y"; "-": nothing steps.
std::string move_text(const interpolator::lattice::Slot& slot, int axes);

/// Methods side by side: one row each, and below them the moves if they are few.
std::string render_comparison(const TeachCase& subject, const std::vector<StepTable>& tables);
std::string render_comparison_csv(const std::vector<StepTable>& tables);
text::Json comparison_json(const TeachCase& subject, const std::vector<StepTable>& tables);

/// Time between pulses of each axis, smallest and largest.
std::string render_spacing(const PulseTrain& train);
text::Json json_of(const PulseTrain& train);

}  // namespace kadr::studies
