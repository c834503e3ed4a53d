#pragma once
#include <string>
#include <tl/expected.hpp>

#include "emulator/studies/teach/follow.h"
#include "emulator/studies/teach/teach_case.h"

namespace kadr::studies {

/// The step table of a case by a method.
/// @return the table, or why the method can't follow the case, with measured and allowed values
tl::expected<StepTable, std::string> step_table(const TeachCase& subject,
                                                interpolator::lattice::Method method,
                                                const TeachOptions& options);

}  // namespace kadr::studies
