#pragma once
#include <string>
#include <vector>

#include "emulator/log/log_reader.h"

namespace kadr::log_tools {

/// One input of a run, as both logs hold it.
struct InputDifference {
  std::string name;  ///< "program", "machine", "settings", "scenario", "kadr", "clock", "axes", "channels"
  bool same = true;
  std::string detail;  ///< the difference, one line; empty if there is none
};

/// The inputs in the order above.
std::vector<InputDifference> compare_inputs(const log::LogHeader& a, const log::LogHeader& b);

/// A control tick of one log is as long as one of the other: ticks can be put side by side.
bool same_clock(const log::LogHeader& a, const log::LogHeader& b);

/// A line of the program.
struct ProgramPlace {
  std::string file;        ///< empty: a called file, whose name the log does not hold
  std::uint32_t line = 0;  ///< from 1; 0: no position
  std::string text;
  /// "part.ngc:42", "line 3 of a called file", or ""
  std::string name() const;
  bool operator==(const ProgramPlace&) const = default;
};
/// Place of a block.
ProgramPlace place_of(const log::LogHeader& header, const log::BlockRecord& block);
/// Position of a line of the main program.
ProgramPlace place_of(const log::LogHeader& header, std::uint32_t line);

}  // namespace kadr::log_tools
