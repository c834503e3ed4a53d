#pragma once
#include "emulator/answers/answers_json.h"
#include "emulator/answers/check_report.h"
#include "emulator/answers/plan_table.h"
#include "emulator/answers/summary.h"
#include "emulator/answers/travel.h"

/// What `kadr check`, `kadr plan` and the end of a run say, as data, as text for people and as JSON.
