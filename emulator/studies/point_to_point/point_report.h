#pragma once
#include <string>

#include "emulator/studies/point_to_point/point_study.h"
#include "emulator/studies/point_to_point/table2.h"
#include "emulator/text/json.h"

/// The output of `kadr law` about laws from rest to rest.
namespace kadr::studies {

/// "time of 3.7 s is too short: the shortest within these limits is 3.741657 s"
std::string fault_text(const planner::PointFault& fault);

/// The question, in four lines: motion, load, vibration, how energy is counted.
std::string render_point_question(const PointQuestion& question, const PointStudy& study);
/// One row per law: times, peaks, work, residual vibration, and its maximum over bands of omega.
std::string render_point_table(const PointStudy& study);
/// The optimum, the advice for a rapid, and the laws that do not fit.
std::string render_point_answer(const PointStudy& study);
/// Table 2 of paper 001, one row per cell: printed, computed as the paper did, and by physics; why they differ.
std::string render_table2(const std::vector<Table2Row>& rows);

/// The table with full precision: a line of names with units, one row per law.
std::string point_csv(const PointStudy& study);
/// The same and the pieces of every law.
text::Json json_of(const PointQuestion& question, const PointStudy& study);
text::Json json_of(const std::vector<Table2Row>& rows);
text::Json json_of(const planner::PointFault& fault);

}  // namespace kadr::studies
