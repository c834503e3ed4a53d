#pragma once
#include "emulator/cycle/lost_time.h"
#include "emulator/cycle/monitor/monitor.h"
#include "emulator/cycle/operator/operator_panel.h"
#include "emulator/cycle/operator/operator_watch.h"
#include "emulator/cycle/operator/place_on_path.h"
#include "emulator/cycle/program_reader.h"
#include "emulator/cycle/session.h"
#include "emulator/cycle/sound_nodes.h"
#include "emulator/emulator.h"

/// How emulator.h keeps its promises.
///
/// Before the run: job.cpp has lay_out() and prepare(); ProgramReader makes path and events of the blocks;
/// sound_plan.cpp verifies the plan.
///
/// The run: Session advances control tick by control tick; run() is a loop over it. In each tick
/// OperatorPanel gives the requests, a MotionSource the motion along the path, CrossingInterpolator the pulses,
/// fire, the plant the machine's response. BlockStarts and ProgramClock find what begins. monitor/ watches
/// command and plant, OperatorWatch and LostTime the cost of the override, sound_nodes.cpp checks the pulses
/// of some ticks. RecordWriter hands the records to a RunLog.
