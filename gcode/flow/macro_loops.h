#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "gcode/flow/structure.h"

namespace kadr::gcode {

/// DO and END of macro B, bound together while a file is read.
class MacroLoops {
 public:
  /// @param statements  of the file so far; both outlive this
  /// @param problems    no more than are ever told
  MacroLoops(std::vector<Statement>& statements, std::vector<Diagnostic>& problems)
      : statements_(statements), problems_(problems) {}

  /// WHILE .. DO or DO: loops inside each other have different numbers.
  void begin(int index);
  /// END
  void end(int index);
  /// The end of a program of the file: every loop must have ended.
  void end_program();
  /// The loop that a line stands in, -1 if it stands in none.
  int innermost() const { return open_.empty() ? -1 : open_.back(); }

 private:
  Statement& at(int index) { return statements_[static_cast<std::size_t>(index)]; }
  void error(Diagnostic d, std::string note = {});

  std::vector<Statement>& statements_;
  std::vector<Diagnostic>& problems_;
  std::vector<int> open_;                               ///< without an END so far, the innermost last
  std::map<std::int32_t, std::vector<int>> by_number_;  ///< the same by n of DO
};

}  // namespace kadr::gcode
