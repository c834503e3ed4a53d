#pragma once
#include "machine/base/diagnostic.h"

namespace kadr::planner {

/// A wish that can't be planned; carries the place.
struct PlanError {
  Diagnostic diagnostic;
};

}  // namespace kadr::planner
