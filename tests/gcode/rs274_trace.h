#pragma once
#include <string>
#include <vector>

#include "rs274_oracle.h"

/// What both interpreters say, brought to one form.
namespace kadr::gcode::test {

/// Calls that rs274 printed, line by line, in machine coordinates and mm.
/// @param table  of the tools that it was given
std::vector<Call> oracle_calls(const std::vector<std::string>& lines, const ToolTable& table);

/// Comparable calls of kadr's blocks.
std::vector<Call> own_calls(const std::vector<Block>& blocks);

std::vector<std::string> lines_of(const std::string& text);

}  // namespace kadr::gcode::test
