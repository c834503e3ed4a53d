#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "machine/base/diagnostic.h"

/// One line of a control program as written: items in source order, expressions as a flat tree.
/// Nothing is copied: offsets point into the text of the line.
namespace kadr::gcode {

/// Bytes [begin, end) of a line.
struct Bytes {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

enum class NodeKind : std::uint8_t {
  number,        ///< 1.5
  parameter,     ///< #left
  negate,        ///< -left, where left is not a plain number
  plus,          ///< +left
  group,         ///< [left]
  binary,        ///< left operation right
  function,      ///< name[left]
  atan,          ///< ATAN[left]/[right], of macro B ATAN[left,right], too
  power,         ///< POW[left,right]
  comma,         ///< between two arguments
  named,         ///< #<name>; left: number of the name
  exists,        ///< EXISTS[#left] of a numbered parameter
  exists_named,  ///< EXISTS[#<name>]; left: number of the name
};

enum class Operation : std::uint8_t {
  none,
  add,
  subtract,
  multiply,
  divide,
  modulo,
  power,
  equal,
  not_equal,
  greater,
  greater_equal,
  less,
  less_equal,
  logical_and,
  logical_or,
  logical_xor,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,  ///< of one argument
  sqrt,
  exp,
  ln,
  abs,
  round,
  fix,
  fup,
};

/// Part of an expression. Operands come before their node in Line::nodes, so one pass in order evaluates it.
struct ExpressionNode {
  NodeKind kind = NodeKind::number;
  Operation operation = Operation::none;
  std::int32_t left = -1;  ///< index in Line::nodes, or the number of a name in Names
  std::int32_t right = -1;
  double value = 0;  ///< number
  Bytes own;         ///< the number, `#`, `#<name>`, `-`, operator, `[` or function name itself
  Bytes closing;     ///< `]` of a group or of EXISTS, `/` of ATAN
};

enum class ItemKind : std::uint8_t {
  word,             ///< letter and value
  o_word,           ///< O with its label, keyword and arguments: Line::flow
  control,          ///< IF, WHILE, GOTO, DO or END of macro B: Line::flow
  setting,          ///< #index = value
  comment,          ///< ( ... )
  line_comment,     ///< ; ...
  percent,          ///< %
  block_delete,     ///< /
  byte_order_mark,  ///< of UTF-8, at the head of the file
  unread,           ///< the rest of a line after a syntax error
};

/// Letters of the words ,R and ,C.
inline constexpr char kCornerRadius = ',', kCornerChamfer = '&';

/// One thing on a line.
struct Item {
  ItemKind kind = ItemKind::word;
  char letter = 0;           ///< word: upper case
  Bytes bytes;               ///< all of it
  double number = 0;         ///< word with a plain number
  std::int32_t value = -1;   ///< root node of the value; -1: a plain number
  std::int32_t first = -1;   ///< first node of this item
  std::int32_t target = -1;  ///< setting: root node of the parameter's index; -1: a named parameter
  std::int32_t name = -1;    ///< setting of a named parameter: number of the name
  std::uint32_t equals = 0;  ///< setting: position of `=`
};

/// True for ,R and ,C.
constexpr bool is_corner(const Item& item) {
  return item.kind == ItemKind::word && (item.letter == kCornerRadius || item.letter == kCornerChamfer);
}

/// Keywords of O words and of macro B.
enum class FlowWord : std::uint8_t {
  label,  ///< O and a number alone: a program's number, or the head of a subroutine that M98 calls
  sub,
  end_sub,
  call,
  return_from,
  if_true,
  else_if,
  otherwise,
  end_if,
  while_true,  ///< head of a while loop, or foot of a do loop
  end_while,
  do_once,
  repeat,
  end_repeat,
  break_loop,
  continue_loop,
  // macro B
  go_to,     ///< GOTO n
  if_go_to,  ///< IF [condition] GOTO n
  if_then,   ///< IF [condition] THEN, and the rest of the line
  while_do,  ///< WHILE [condition] DO n
  do_loop,   ///< DO n
  end_do,    ///< END n
};
constexpr bool is_macro_word(FlowWord word) { return word >= FlowWord::go_to; }

/// The O word of a line, or its statement of macro B.
struct FlowStatement {
  FlowWord word = FlowWord::label;
  std::int32_t name = -1;         ///< number of the label in Names; -1: computed
  std::int32_t label_first = -1;  ///< computed label: its nodes
  std::int32_t label_root = -1;
  Bytes label;                          ///< O and its label; n of GOTO, DO and END, empty if computed
  Bytes keyword;                        ///< empty for a label alone
  Bytes second;                         ///< GOTO, THEN or DO behind a condition
  std::int32_t number = -1;             ///< n of GOTO, DO and END; -1: computed, or none
  std::vector<std::int32_t> arguments;  ///< root nodes; the nodes of one end where those of the next begin
  std::int32_t first = -1;              ///< first node of the first argument
};

/// True for #1000 to #1031, the inputs of macro B, of a node of that number.
constexpr bool is_input_variable(double number) { return number >= 1000 && number <= 1031; }

/// The macro call on a line, whose words are arguments.
enum class MacroCall : std::uint8_t { none, once /* G65 */, modal /* G66 */, cancel /* G67 */ };

/// A line as written. Storage is kept from line to line.
struct Line {
  std::uint32_t file = 0;
  std::uint32_t number = 0;  ///< 1-based
  std::string_view text;     ///< without line end
  std::string_view ending;   ///< "\n" or "\r\n"; "\r" or "" at the end of the file
  std::vector<Item> items;
  std::vector<ExpressionNode> nodes;
  FlowStatement flow;          ///< if has_flow
  bool has_flow = false;       ///< there is an O word or a statement of macro B on the line
  bool failed = false;         ///< a syntax error was reported; items before it are valid
  bool only_settings = false;  ///< of macro B: settings and nothing else that acts, statements apart
  bool reads_inputs = false;   ///< of macro B: #1000 to #1031 stand on the line
  MacroCall macro_call = MacroCall::none;

  Span span(Bytes bytes) const {
    return {file, number, bytes.begin + 1, bytes.end > bytes.begin ? bytes.end - bytes.begin : 1};
  }
  std::string_view slice(Bytes bytes) const { return text.substr(bytes.begin, bytes.end - bytes.begin); }
};

/// Where the nodes of an item end, which begin at Item::first: those of the next item follow.
std::int32_t node_end(const Line& line, std::size_t item);

/// Writes the line back from its tree, line end included: every lexeme of every item and the blanks between
/// them. Equals the source byte for byte; bytes that belong to no item and are not blanks break a promise.
void append_source(std::string& out, const Line& line);

}  // namespace kadr::gcode
