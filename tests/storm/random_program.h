#pragma once
#include <map>
#include <string>

#include "tests/storm/random_machine.h"

namespace kadr::storm {

struct RandomProgram {
  std::map<std::string, std::string> files;  ///< program.ngc, called files, tools.tbl
  std::string dialect;
  int lines = 0;       ///< of program.ngc
  bool waits = false;  ///< reads inputs (M66)
};

/// A program of all words that a machine of these axes runs; almost all are valid. It follows the modes that decide what may
/// come next; positions are relative, or counted from #5420 and the parameters behind it, whatever offsets are in force.
RandomProgram random_program(Draw& draw, const RandomMachine& machine);

}  // namespace kadr::storm
