#pragma once
#include <vector>

#include "emulator/answers/check_report.h"
#include "emulator/answers/plan_table.h"
#include "emulator/answers/summary.h"
#include "emulator/text/json.h"

/// The tables of a check, a plan and a run, for programs. `_u` is the unit that the field "unit" next to it
/// names (mm or deg).
namespace kadr::emulator {

Json json_of(const std::vector<LimitShare>& shares);
Json json_of(const RunSummary& summary, const SummaryContext& context);
Json json_of(const CheckResult& result, const machine::MachineModel& model);
Json json_of(const PlanRow& row);

}  // namespace kadr::emulator
