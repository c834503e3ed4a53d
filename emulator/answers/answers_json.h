#pragma once
#include <vector>

#include "emulator/answers/check_report.h"
#include "emulator/answers/plan_table.h"
#include "emulator/answers/summary.h"
#include "emulator/text/json.h"

/// The tables of a check, a plan and a run, for programs. `_u` is the unit that the field "unit" next to it
/// names (mm or deg).
namespace kadr::answers {

text::Json json_of(const std::vector<log::LimitShare>& shares);
text::Json json_of(const log::RunSummary& summary, const SummaryContext& context);
text::Json json_of(const CheckResult& result, const machine::MachineModel& model);
text::Json json_of(const PlanRow& row);
text::Json json_of(const ApproachRow& row);

}  // namespace kadr::answers
