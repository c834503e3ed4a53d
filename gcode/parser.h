#pragma once
#include <cstdint>

#include "gcode/report.h"
#include "gcode/scanner.h"
#include "gcode/tree.h"

namespace kadr::gcode {

/// Text of one line -> items and expression nodes. The first syntax error of a line is told and the rest of
/// that line becomes one `unread` item, so the next line is read as if nothing had happened.
class Parser {
 public:
  explicit Parser(Report& report) : report_(report) {}

  /// Fills line.items and line.nodes from line.text, from byte `begin` on.
  void parse(Line& line, std::size_t begin = 0);

 private:
  bool parse_item(char c);
  bool parse_word(char letter);
  bool parse_setting();
  bool parse_comment();
  bool parse_line_comment();
  bool parse_percent();
  void check_encoding(Bytes bytes);

  bool bad_character();
  bool fail(Code code, Bytes bytes, std::string label, std::string help = {});

  Report& report_;
  Line* line_ = nullptr;
  Cursor cursor_{{}};
  bool encoding_told_ = false;
};

/// Reads the value of a word or setting: [expression], #parameter, function, signed number.
class ExpressionParser {
 public:
  /// Brackets, signs and # within each other; more is a mistake or an attack on the stack.
  static constexpr int kMaxDepth = 100;

  ExpressionParser(Line& line, Cursor& cursor, Report& report)
      : line_(line), cursor_(cursor), report_(report) {}

  /// @return index of the root node, -1 after an error was told
  std::int32_t value();

 private:
  std::int32_t number();
  std::int32_t signed_value(NodeKind kind);
  std::int32_t parameter();
  std::int32_t group();
  std::int32_t function();
  std::int32_t chain(int lowest_precedence);
  bool read_operator(Operation& operation, Bytes& bytes);
  std::int32_t unknown_name(const char* expected);
  std::int32_t add(const Node& node);
  std::int32_t fail(Code code, Bytes bytes, std::string label, std::string help = {});

  Line& line_;
  Cursor& cursor_;
  Report& report_;
  int depth_ = 0;
};

/// Tells what is wrong with a number that could not be read.
Diagnostic number_problem(const Line& line, NumberResult result, Bytes bytes, char letter);

}  // namespace kadr::gcode
