#pragma once
#include <string>

#include "tests/storm/random_machine.h"
#include "tests/storm/random_program.h"

namespace kadr::storm {

struct StormCase;

/// Adds scenario.toml, and where it has operator's steps mostly a second timeline, other.toml, for the same highest override.
void add_scenario(Draw& draw, const RandomMachine& machine, const RandomProgram& program,
                  StormCase& storm_case);

/// Lets the program of a case be entered at a line of its own, and now and then be left at one.
void enter_within(Draw& draw, StormCase& storm_case);

/// What the world does to a run, as fault.txt has it (world.h).
std::string random_fault(Draw& draw);

}  // namespace kadr::storm
