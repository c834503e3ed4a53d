#pragma once
#include <string>

#include "emulator/emulator.h"

namespace kadr::cli {

/// The first message of a log: the run's inputs in full and their hash, so that the log alone can be run again.
/// @param options     plant and until_s are inputs of a run and belong to the settings; threads are not
/// @param scenario_toml  as read, empty if none
/// The header points into the job's machine.
log::RunHeader run_header(const cycle::Job& job, const cycle::RunOptions& options,
                          const std::string& scenario_toml);

}  // namespace kadr::cli
