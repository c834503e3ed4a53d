#pragma once
#include <string>
#include <string_view>

#include "emulator/studies/time_law/level_sweep.h"
#include "emulator/text/json.h"

/// The output of `kadr tube --sweep-levels`.
namespace kadr::studies {

/// One row per number of levels: T, J, gap to the bound, passes, and what ended the loop.
std::string render_sweep_table(const LevelSweep& sweep);
/// {"lower_bound_s", "sweep": [{"levels", "time_s", "cost_s", "passes", "capped"}, ...]}
text::Json json_of(const LevelSweep& sweep);
/// "levels,time_s,cost_s,gap_pct,passes,capped": one row per number of levels; empty cells where no law was found.
std::string sweep_csv(const LevelSweep& sweep);
/// Time and passes over levels as one HTML file without script.
std::string render_sweep_page(const LevelSweep& sweep, const TimeLawProblem& problem, std::string_view file);

}  // namespace kadr::studies
