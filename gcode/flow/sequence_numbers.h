#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gcode/read/program.h"

namespace kadr::gcode {

/// A line with N, where GOTO, M99 P and M97 P lead.
struct NumberedLine {
  std::uint32_t program = 0;  ///< of the file, by the O numbers that head them
  std::int32_t number = 0;
  Program::Position at;
  int loop = -1;  ///< the innermost DO around it
};

/// N of the line, none if it has none that is a whole number.
std::optional<std::int32_t> sequence_number(const Line& line);

/// The lines of a file that begin with N. A number counts within its program: from one O number to the next.
class SequenceNumbers {
 public:
  /// An O number on that line heads a program.
  void begin_program(std::uint32_t line) { programs_.push_back(line); }
  void add(std::int32_t number, Program::Position at, int loop);
  /// Ends the reading.
  void finish();

  /// The first line of that number in the program that the line belongs to, null if there is none.
  const NumberedLine* find(std::int32_t number, std::uint32_t line) const;
  /// The line of the same number that follows in its program, null if it is the only one.
  const NumberedLine* again(const NumberedLine& first) const;

 private:
  std::vector<std::uint32_t> programs_;
  std::vector<NumberedLine> lines_;  ///< by program and number after finish()
};

}  // namespace kadr::gcode
