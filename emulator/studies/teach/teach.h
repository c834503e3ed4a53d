#pragma once
#include "emulator/studies/teach/bezier_report.h"
#include "emulator/studies/teach/pulses.h"
#include "emulator/studies/teach/sweep.h"
#include "emulator/studies/teach/teach_page.h"
#include "emulator/studies/teach/teach_report.h"

/// `kadr teach`: interpolators and Bezier curves step by step, for people who
/// learn how they work (docs/interpolators.md).
