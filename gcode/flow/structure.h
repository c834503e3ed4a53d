#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "gcode/flow/sequence_numbers.h"
#include "gcode/read/program.h"

namespace kadr::gcode {

/// A `sub`, or an O number alone: behind the end of the program a subroutine begins here.
bool begins_subroutine(const Line& line);
/// M2 or M30 stands on the line.
bool ends_program(const Line& line);

/// An O word with the words that belong to it, as indices in Structure.
struct Statement {
  FlowWord word = FlowWord::label;
  std::int32_t name = -1;  ///< of macro B n of GOTO, DO and END, -1 where it is computed
  Span span;
  Program::Position at;     ///< its own line
  Program::Position after;  ///< the line after it
  int begin = -1;  ///< the sub, if, while, do or repeat that it belongs to; -1: it is a beginning itself
  int next = -1;   ///< if, elseif, else: the next branch or the end
  const NumberedLine* target = nullptr;  ///< of GOTO n
  int end = -1;         ///< of a beginning: endsub, endif, endwhile, endrepeat, or the while of a do
  int last_break = -1;  ///< of a loop: the last break that leaves it
};

/// All O words of a file, bound together before anything runs.
class Structure {
 public:
  /// Reads the whole program once, so that every mistake of its text is reported, and rewinds it.
  /// @param macros  the dialect has macro B: GOTO may lead behind the program's end
  /// @return false if O words don't fit together (reported): nothing of the file may be run
  bool read(Program& program, bool block_delete, bool macros, Names& names, Report& report);

  /// The statement on a line with an O word, -1 if it is after the end of the program.
  int at_line(std::uint32_t line) const;
  std::size_t size() const { return statements_.size(); }
  const Statement& operator[](int index) const { return statements_[static_cast<std::size_t>(index)]; }
  /// Statements of all subs by name, and of the O numbers that head subroutines for M98.
  const std::unordered_map<std::int32_t, int>& subs() const { return subs_; }
  const std::unordered_map<std::int32_t, int>& labels() const { return labels_; }
  /// The `sub` of that name, -1 if there is none.
  int sub(std::int32_t name) const { return find(subs_, name); }
  /// The O number alone that heads a subroutine for M98, -1 if there is none.
  int label(std::int32_t name) const { return find(labels_, name); }
  /// Finds the line of macro B that GOTO, M99 P or M97 P names.
  /// @param line  of the program that the number belongs to, outside or inside a loop
  /// @param place  of what names it
  /// @return why it can't be gone to: there is none, there are two, or it stands in a loop
  std::optional<Diagnostic> find_line(std::int32_t number, std::uint32_t line, Span place,
                                      const NumberedLine*& target) const;
  /// The line of the O number that names the main program; 0: there is none.
  std::uint32_t head_line() const { return head_line_; }

 private:
  struct Reader;
  static int find(const std::unordered_map<std::int32_t, int>& map, std::int32_t name) {
    const auto it = map.find(name);
    return it == map.end() ? -1 : it->second;
  }

  std::vector<Statement> statements_;  ///< in the order of lines
  std::unordered_map<std::int32_t, int> subs_, labels_;
  SequenceNumbers numbers_;
  std::uint32_t head_line_ = 0;
};

}  // namespace kadr::gcode
