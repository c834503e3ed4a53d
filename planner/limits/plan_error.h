#pragma once
#include "machine/base/diagnostic.h"

namespace kadr::planner {

/// A request that can't be planned; carries its position.
struct PlanError {
  Diagnostic diagnostic;
};

}  // namespace kadr::planner
