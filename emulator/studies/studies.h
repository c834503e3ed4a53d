#pragma once
#include "emulator/studies/point_to_point/point_to_point.h"
#include "emulator/studies/teach/teach.h"
#include "emulator/studies/time_law/time_law.h"

/// Laboratories over planner and interpolator; no run of a program: time_law/ (`kadr tube`), point_to_point/
/// (`kadr law`) and teach/ (`kadr teach`).
