#pragma once
#include <optional>
#include <string>

#include "machine/base/confinement.h"
#include "machine/file/table_reader.h"

namespace kadr::studies {

/// Reads the machine that a problem names: one that ships with kadr, or a file below the problem's folders.
/// @return nothing if there is none or it has mistakes (in the context's diagnostics)
std::optional<machine::MachineFile> open_problem_machine(SourceSet& sources, const InputFolders& folders,
                                                         const machine::Reading<std::string>& name,
                                                         machine::ReadContext& context);

/// The axis of a machine that an [[axis]] of a problem names; nullptr if there is none (K3306).
machine::AxisModel* find_problem_axis(machine::MachineModel& machine,
                                      const machine::Reading<std::string>& name,
                                      machine::ReadContext& context);

}  // namespace kadr::studies
