#pragma once
#include "machine/file/table_reader.h"
#include "machine/owner_codes.h"
#include "machine/settings.h"

namespace kadr::machine {

/// Reads a list of code names, each of them once; mistakes go to `diagnostics`.
/// @param known  codes that may not be named again
std::vector<CodeName> read_code_names(const std::vector<Reading<std::string>>& texts,
                                      const std::vector<CodeName>& known, Diagnostics& diagnostics);

/// Reads the table [codes]: the keys `ignore`, and a table for each code.
/// @param tool_change_given  planner.tool_change_s is in the file; otherwise it takes the time of M6
OwnerCodes read_owner_codes(const Node* table, const Span& place, bool tool_change_given,
                            PlannerSettings& planner, ReadContext& context);

}  // namespace kadr::machine
