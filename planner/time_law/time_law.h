#pragma once
#include "planner/time_law/active_limits.h"
#include "planner/time_law/certified.h"
#include "planner/time_law/formula_path.h"
#include "planner/time_law/greedy.h"
#include "planner/time_law/interior_point.h"
#include "planner/time_law/jerk_limited.h"
#include "planner/time_law/law_methods.h"
#include "planner/time_law/metrics.h"
#include "planner/time_law/spline_fit.h"
#include "planner/time_law/stretch.h"
#include "planner/time_law/table_path.h"
#include "planner/time_law/tube.h"
#include "planner/time_law/verify_law.h"

/// How fast along a given path? State it as a LawProblem (the path by formula, by table, or a stretch of a
/// program), solve it with any LawSolver, look at the answer with verify_law(), law_metrics() and
/// active_limits(). The methods are those of paper 000 and what they are measured against.
