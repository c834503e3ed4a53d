#pragma once
#include <cstdint>
#include <string_view>

#include "gcode/dialect/dialect.h"
#include "gcode/read/names.h"
#include "gcode/read/report.h"
#include "gcode/read/scanner.h"
#include "gcode/read/tree.h"

namespace kadr::gcode {

class ExpressionParser;

/// Text of one line -> items and expression nodes. The first syntax error of a line is reported and the rest of
/// that line becomes one `unread` item, so the next line is read as if nothing had happened.
class Parser {
 public:
  Parser(Names& names, Report& report, Dialect dialect = Dialect::linuxcnc)
      : names_(names), report_(report), rules_(rules_of(dialect)), looks_at_lines_(rules_.text.of_lines()) {}
  /// Takes the whole line as one item that was not read, without a message.
  void leave_unread(Line& line);
  /// Mistakes are not reported: for a line reported before, or one that is never reached.
  void mute(bool muted) { muted_ = muted; }

  /// Fills line.items and line.nodes from line.text, from byte `begin` on.
  void parse(Line& line, std::size_t begin = 0);

 private:
  bool parse_item(char c);
  bool parse_word(char letter);
  bool parse_setting();
  bool parse_o_word();
  bool parse_label(FlowStatement& flow);
  bool parse_arguments(FlowStatement& flow);
  // parse_macro.cpp
  bool begins_control(std::uint32_t begin) const;
  bool parse_control(std::uint32_t begin);
  bool control_place(std::uint32_t begin);
  bool parse_condition(FlowStatement& flow);
  bool parse_behind_condition(FlowStatement& flow);
  bool parse_target(FlowStatement& flow);
  bool parse_loop_number(FlowStatement& flow);
  void note_macro_line();
  bool parse_comment();
  bool parse_line_comment();
  bool parse_percent();
  // dialect_lines.cpp
  bool take_dialect_line(Line& line, std::size_t& end);
  bool controller_line(Line& line);
  bool percent_remark(Line& line);
  bool take_checksum(Line& line, std::size_t& end);
  bool too_many_characters(Line& line);
  void remark(Line& line);
  bool take_text_code(std::uint32_t begin);
  bool bare_letter();
  bool expression_refused(std::uint32_t begin);

  void check_encoding(Bytes bytes);
  bool carriage_return_inside(Line& line);

  bool bad_character();
  bool corner_or_comma(std::uint32_t at);
  bool parse_corner(std::uint32_t at, char letter, std::uint32_t behind);
  bool fail(Code code, Bytes bytes, std::string label, std::string help = {});

  ExpressionParser expression();

  Names& names_;
  Report& report_;
  const DialectRules& rules_;
  bool looks_at_lines_;  ///< of the dialect
  Line* line_ = nullptr;
  Cursor cursor_{{}};
  bool encoding_told_ = false;
  bool muted_ = false;
};

/// Reads the value of a word or setting: [expression], #parameter, function, signed number.
class ExpressionParser {
 public:
  /// Depth of nested brackets, signs and #; more is a mistake or an attack on the stack.
  static constexpr int kMaxDepth = 100;

  /// @param report  null: mistakes are not reported
  /// @param macros  operators and functions are those of macro B
  ExpressionParser(Line& line, Cursor& cursor, Names& names, Report* report, bool macros = false)
      : line_(line), cursor_(cursor), names_(names), report_(report), macros_(macros) {}

  /// @return index of the root node, -1 after an error was reported
  std::int32_t value();
  /// A value in [ ].
  std::int32_t group();
  /// The right side of a setting of macro B: operators without brackets around them.
  std::int32_t right_side() { return chain(1, Within::line); }
  /// Reads <name>. @return its number, -1 after an error was reported
  std::int32_t name(std::uint32_t sign);
  /// Reports the < of a name where a dialect has none. @return -1
  std::int32_t refuse_name(std::uint32_t sign);

 private:
  std::int32_t number();
  std::int32_t missing();
  bool foreign_here();
  std::int32_t signed_value(NodeKind kind);
  std::int32_t parameter();
  std::int32_t function();
  std::int32_t exists(ExpressionNode node);
  /// What ends a chain of operators: the bracket around it, or the first thing that is no operator.
  enum class Within : std::uint8_t { bracket, line };
  std::int32_t chain(int lowest_precedence, Within within);
  bool read_operator(Operation& operation, Bytes& bytes, int& precedence);
  std::int32_t pair(ExpressionNode node);
  bool refuse_macro_function(ExpressionNode& node);
  std::int32_t unknown_name(const char* expected);
  std::int32_t add(const ExpressionNode& node);
  std::int32_t fail(Code code, Bytes bytes, std::string label, std::string help = {});

  Line& line_;
  Cursor& cursor_;
  Names& names_;
  Report* report_;
  bool macros_;
  bool in_pair_ = false;  ///< a comma separates arguments
  int depth_ = 0;
};

/// Reads `name` (capital letters) if it is here, blanks between its letters allowed.
bool match(Cursor& cursor, std::string_view name, Bytes& bytes);

/// What is wrong with a byte that begins nothing: a letter of another alphabet, a dash for a minus, a control character.
Diagnostic character_problem(const Line& line, std::uint32_t at);

/// Reports why a number could not be read.
Diagnostic number_problem(const Line& line, NumberResult result, Bytes bytes, char letter);

}  // namespace kadr::gcode
