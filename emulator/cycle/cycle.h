#pragma once
#include "emulator/cycle/lost_time.h"
#include "emulator/cycle/monitor.h"
#include "emulator/cycle/operator_panel.h"
#include "emulator/cycle/program_reader.h"
#include "emulator/cycle/sound_nodes.h"
#include "emulator/emulator.h"

/// How emulator.h does what it promises. job.cpp: lay_out() and prepare(), by ProgramReader from blocks to
/// path and events; sound_plan.cpp: every plan is verified. run.cpp: the loop, a control tick a turn:
/// OperatorPanel says what is asked for, a MotionSource how the path moves, CrossingInterpolator which pulses
/// fire, the plant how the machine answers; Monitor watches it, LostTime counts what it cost, sound_nodes.cpp
/// checks the pulses of some ticks, a RunLog takes the records.
