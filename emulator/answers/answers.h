#pragma once
#include "emulator/answers/answers_json.h"
#include "emulator/answers/check_report.h"
#include "emulator/answers/plan_table.h"
#include "emulator/answers/summary.h"
#include "emulator/answers/travel.h"

/// The answers of `kadr check` and `kadr plan`, and the summary of a run: as data, as text for people and as JSON.
