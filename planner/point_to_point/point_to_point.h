#pragma once
#include "planner/point_to_point/builders.h"
#include "planner/point_to_point/law.h"
#include "planner/point_to_point/mode.h"
#include "planner/point_to_point/residual.h"
#include "planner/point_to_point/synthesis.h"
#include "planner/point_to_point/work.h"

/// From rest to rest without residual vibration of the load (paper 001). A PointLaw is a motion of one coordinate
/// in pieces of constant jerk: built by builders.h (T laws, S-curves, shaped ones), found by synthesis.h
/// (least energy at a given time, least time) or picked for a rapid (planner/positioning).
/// residual_amplitude_u() gives the residual vibration, work_of() the energy.
