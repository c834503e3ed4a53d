#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "planner/bezier/arc_length.h"
#include "planner/bezier/bezier_curve.h"
#include "planner/bezier/joint.h"
#include "planner/bezier/paper_table.h"

/// Bezier trajectories (paper 004): curve, length and radius; t(S) by a table that keeps the feed, and as the
/// paper makes it; what a curve and a joint ask of a machine.
