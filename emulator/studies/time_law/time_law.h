#pragma once
#include "emulator/studies/time_law/law_report.h"
#include "emulator/studies/time_law/law_study.h"
#include "emulator/studies/time_law/level_sweep.h"
#include "emulator/studies/time_law/sweep_report.h"
#include "emulator/studies/time_law/tube_page.h"

/// `kadr tube`: the time laws of paper 000 over a problem file or a stretch of a program, compared (docs/time_law.md).
