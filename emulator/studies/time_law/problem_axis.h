#pragma once
#include "emulator/studies/time_law/problem.h"
#include "machine/file/table_reader.h"

namespace kadr::studies {

/// Reads an [[axis]] of a path by formula or table into a problem: name, unit, limits, terms of its formula.
/// @param machine  whose limits count where none are given; nullptr: there is none
void read_problem_axis(const machine::Node& node, bool by_table, machine::MachineModel* machine,
                       TimeLawProblem& out, machine::ReadContext& context);

}  // namespace kadr::studies
