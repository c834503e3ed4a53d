#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "machine/base/axes.h"
#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// One tool of a table: LinuxCNC's `.tbl` line `T1 P1 X0 Z12.5 D6 I.. J.. Q.. ;remark`.
struct Tool {
  int number = 0;
  int pocket = 0;
  AxisValues offset{};  ///< mm, deg
  double diameter_mm = 0;
  double front_angle_deg = 0;
  double back_angle_deg = 0;
  int orientation = 0;  ///< 0 to 9
};

/// Rows of a table by tool number, brought up to date by each search. A number that is in several rows is in the first.
class ToolIndex {
 public:
  /// @pre rows are only added, and keep their numbers
  std::optional<std::size_t> find(const std::vector<Tool>& tools, int number);

 private:
  std::unordered_map<int, std::size_t> rows_;
  std::size_t indexed_ = 0;  ///< rows taken so far
};

/// The tools of a machine, in the order of the table.
struct ToolTable {
  std::vector<Tool> tools;  ///< rows are only added, and keep their numbers
  /// The tool of a number, null if there is none. Not for two threads at once.
  const Tool* find(int number) const;
  Tool* find(int number);

  mutable ToolIndex index = {};
};

/// Reads a tool table: one tool per line, words in any order, separated by blanks or tabs; `;` begins a remark.
/// Mistakes go to `diagnostics`, all of the file at once; a line with a mistake gives no tool.
ToolTable read_tool_table(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics);

/// The table as text, without remarks and words that are 0. It reads back as the same table.
std::string render_tool_table(const ToolTable& table);

}  // namespace kadr::gcode
