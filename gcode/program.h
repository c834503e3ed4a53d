#pragma once
#include <cstddef>
#include <cstdint>

#include "gcode/parser.h"
#include "gcode/tree.h"

namespace kadr::gcode {

/// A control program as a stream of parsed lines. One line is held at a time, so memory does not grow with
/// the file; a place can be kept and gone back to, which is what loops and calls need.
class Program {
 public:
  /// Where the next line begins.
  struct Position {
    std::size_t offset = 0;
    std::uint32_t line = 1;
  };

  Program(const SourceSet& sources, std::uint32_t file, Report& report);

  /// Parses the next line into `line`; false at the end of the text.
  bool next(Line& line);
  Position position() const { return at_; }
  void go_to(Position position) { at_ = position; }

 private:
  void let_go_what_was_read();

  const SourceText& source_;
  std::string_view text_;
  std::uint32_t file_;
  Position at_;
  std::size_t held_from_ = 0;  ///< what stands before it has been let go
  Parser parser_;
};

}  // namespace kadr::gcode
