#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "emulator/emulator.h"
#include "machine/base/confinement.h"

namespace kadr::cli {

/// The first message of a log: the run's inputs in full and their hash, so that the log alone can be run again.
/// @param options     plant and until_s are inputs of a run and belong to the settings; threads are not
/// @param scenario_toml  as read, empty if none
/// @param files  that were read before the program's run; those that it calls are added
/// The header points into the job's machine.
log::RunHeader run_header(const cycle::Job& job, const cycle::RunOptions& options,
                          const std::string& scenario_toml, std::vector<log::ReadFile> files);
/// What the log says of a file that was read.
log::ReadFile read_file(std::string role, const InputFile& file, std::string_view text);

}  // namespace kadr::cli
