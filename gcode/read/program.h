#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gcode/gcode.h"
#include "gcode/read/parser.h"
#include "gcode/read/tree.h"

namespace kadr::gcode {

/// A control program as a stream of parsed lines. One line is held at a time, so memory does not grow with
/// the text; loops and calls can save a position and return to it.
class Program {
 public:
  /// Where the next line begins.
  struct Position {
    std::size_t offset = 0;
    std::uint32_t line = 1;
  };

  Program(const SourceSet& sources, std::uint32_t file, const ReadingBounds& bounds, Names& names,
          Report& report, Dialect dialect = Dialect::linuxcnc);

  /// Parses the next line; it holds until the next call. Null at the end of the text.
  const Line* next();
  /// Whether mistakes of the lines that follow are suppressed.
  void mute(bool muted) { parser_.mute(muted); }
  Position position() const { return at_; }
  void go_to(Position position) { at_ = position; }
  std::uint32_t file() const { return file_; }
  /// Back to the beginning of the text, after all of it was read and its mistakes reported. From here on nothing is
  /// reported twice, and the lines of a short text stay parsed.
  void rewind();
  /// True if some line begins with an O word other than a program number at the very beginning.
  bool has_o_words() const;

 private:
  bool read(Line& line);

  std::string_view text_;
  std::uint32_t file_;
  std::uint32_t line_bytes_;
  Position at_;
  Parser parser_;
  Report& report_;
  Line line_;
  std::vector<Line> kept_;  ///< [lines], after rewind() of a short text
};

}  // namespace kadr::gcode
