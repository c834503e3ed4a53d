#include "gcode/format/format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "gcode/dialect/codes.h"
#include "gcode/flow/structure.h"
#include "gcode/gcode.h"
#include "gcode/read/names.h"
#include "gcode/read/other_kind.h"
#include "gcode/read/program.h"
#include "gcode/read/scanner.h"
#include "machine/base/utf8.h"

namespace kadr::gcode {
namespace {

constexpr std::size_t kIndent = 2;
/// Deeper lines are indented no further: a program must not grow with the square of its length.
constexpr std::size_t kMostIndented = 40;
/// Longer lines don't push the comments of their neighbours to the right.
constexpr std::size_t kAlignedUpTo = 60;
/// Letters whose number is a name, not a length: a point after it means nothing.
constexpr std::string_view kCodeLetters = "GMNT";

// lower ranks are printed first; items of one rank keep their order
constexpr std::int32_t kHeadRank = 0;
constexpr std::int32_t kNumberRank = 1;
constexpr std::int32_t kFirstRank = 2;  // M98 must be the first word; a name exists from its setting on
constexpr std::int32_t kGRank = 100;
constexpr std::int32_t kLetterRank = 200;
constexpr std::int32_t kMRank = 300;
constexpr std::int32_t kSettingRank = 400;
constexpr std::int32_t kMisplacedRank = 401;  // a line number inside a line stays a mistake
constexpr std::int32_t kCommentRank = 500;
constexpr std::int32_t kUnknownCode = 50;  // within G and M: after the known ones

constexpr std::string_view kLetterOrder = "XYZABCUVW@^IJKRPQLDHE,&FS$T";

// groups in the order in which a line's codes act
constexpr std::array<GGroup, kGGroups> kGOrder = {
    GGroup::feed_mode, GGroup::spindle_mode, GGroup::plane,        GGroup::units,
    GGroup::diameter,  GGroup::compensation, GGroup::tool_length,  GGroup::coordinate_system,
    GGroup::path,      GGroup::distance,     GGroup::arc_distance, GGroup::retract,
    GGroup::nonmodal,  GGroup::g92_state,    GGroup::motion};
constexpr std::array<MGroup, kMGroups> kMOrder = {MGroup::inputs,      MGroup::tool_change, MGroup::spindle,
                                                  MGroup::modal_state, MGroup::coolant,     MGroup::overrides,
                                                  MGroup::call,        MGroup::stop};

template <class Group, std::size_t N>
std::int32_t place_in(const std::array<Group, N>& order, Group group) {
  return static_cast<std::int32_t>(std::find(order.begin(), order.end(), group) - order.begin());
}

/// Rank of a G word among the others of its line; the group of a computed or unknown one is not known.
std::int32_t g_rank(const Item& item) {
  constexpr double kLargestCode = 1000;
  if (item.value >= 0 || !(item.number >= 0 && item.number < kLargestCode)) return kUnknownCode;
  const GCode code = g_code(static_cast<int>(std::floor(item.number * 10 + 0.5)));
  return code.standing == Standing::unknown ? kUnknownCode : place_in(kGOrder, code.group);
}

std::int32_t m_rank(const Item& item) {
  constexpr double kLargestCode = 1000;
  if (item.value >= 0 || !(item.number >= 0 && item.number < kLargestCode)) return kUnknownCode;
  const MCode code = m_code(static_cast<int>(std::floor(item.number + 0.5)));
  return code.standing == Standing::unknown ? kUnknownCode : place_in(kMOrder, code.group);
}

std::int32_t rank_of(const Item& item) {
  switch (item.kind) {
    case ItemKind::setting:
      return kSettingRank;
    case ItemKind::comment:
    case ItemKind::line_comment:
      return kCommentRank;
    case ItemKind::word:
      break;
    case ItemKind::o_word:
    case ItemKind::control:
      return kGRank;
    case ItemKind::percent:
    case ItemKind::block_delete:
    case ItemKind::byte_order_mark:
    case ItemKind::unread:
      return kHeadRank;
  }
  if (item.letter == 'N') return kNumberRank;
  if (item.letter == 'G') return kGRank + g_rank(item);
  if (item.letter == 'M') return kMRank + m_rank(item);
  return kLetterRank + static_cast<std::int32_t>(kLetterOrder.find(item.letter));
}

/// The order of the words of a macro call tells I J K of one set from those of the next, and what follows THEN is run
/// if the condition holds: both stay as written.
bool keeps_order(const Line& line) {
  return line.macro_call == MacroCall::once || line.macro_call == MacroCall::modal ||
         (line.has_flow && is_macro_word(line.flow.word));
}

bool is_comment(const Item& item) {
  return item.kind == ItemKind::comment || item.kind == ItemKind::line_comment;
}

/// Capital letters without blanks; a name in < > stays as written.
void append_plain(std::string& out, std::string_view text) {
  const std::size_t name = std::min(text.find('<'), text.size());
  for (const char c : text.substr(0, name))
    if (!is_blank(c)) out += upper(c);
  out += text.substr(name);
}

std::string_view without_blanks_behind(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view keyword_text(FlowWord word) {
  constexpr std::array<std::string_view, 16> kTexts = {
      "",      "sub",   "endsub",   "call", "return", "if",        "elseif", "else",
      "endif", "while", "endwhile", "do",   "repeat", "endrepeat", "break",  "continue"};
  return kTexts[static_cast<std::size_t>(word)];
}

}  // namespace

std::string plain_number(std::string_view written, bool point) {
  std::string whole, fraction;
  bool negative = false;
  bool has_point = false;
  for (const char c : written) {
    if (c == '-') negative = true;
    if (c == '.') has_point = true;
    if (is_digit(c)) (has_point ? fraction : whole) += c;
  }
  const std::size_t first = std::min(whole.find_first_not_of('0'), whole.size());
  whole.erase(0, first);
  fraction.erase(fraction.find_last_not_of('0') + 1);
  std::string out = negative ? "-" : "";
  out += whole.empty() ? "0" : whole;
  if (!fraction.empty() || (has_point && point)) out += '.';
  return out + fraction;
}

void Formatter::add(const Line& line) {
  note_percent(line);
  if (line.failed) {
    keep(line.text);
    return;
  }
  const std::size_t indent = indentation(line);
  sort_items(line);
  Formatted formatted;
  std::string& code = formatted.code;
  bool empty = true;  // no word stands on the line yet
  for (const std::uint32_t at : order_) {
    const Item& item = line.items[at];
    if (is_comment(item)) {
      if (!formatted.comment.empty()) formatted.comment += ' ';
      formatted.comment += without_blanks_behind(line.slice(item.bytes));
      continue;
    }
    const bool head = item.kind == ItemKind::byte_order_mark || item.kind == ItemKind::block_delete;
    if (!head && empty) {
      code.append(indent, ' ');
      empty = false;
    } else if (!head) {
      code += ' ';
    }
    append_item(code, line, at);
  }
  if (!empty && !formatted.comment.empty()) {
    run_.push_back(std::move(formatted));
    return;
  }
  flush();
  if (!formatted.comment.empty()) code += std::string(indent, ' ') + formatted.comment;
  out_ += code + '\n';
}

void Formatter::keep(std::string_view text) {
  flush();
  // a carriage return before the line end would be read as part of it the next time
  while (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  out_ += text;
  out_ += '\n';
}

void Formatter::sort_items(const Line& line) {
  const auto count = static_cast<std::uint32_t>(line.items.size());
  order_.resize(count);
  ranks_.resize(count);
  bool first = true;  // no word but N, and no setting, stands before
  for (std::uint32_t i = 0; i < count; ++i) {
    const Item& item = line.items[i];
    order_[i] = i;
    const bool calls = item.letter == 'M' && item.value < 0 && item.number == code::m98;
    const bool names = item.kind == ItemKind::setting && item.name >= 0;
    const bool stays = keeps_order(line) && rank_of(item) >= kGRank && !is_comment(item);
    ranks_[i] = stays                          ? kGRank
                : item.letter == 'N' && !first ? kMisplacedRank
                : first && (calls || names)    ? kFirstRank
                                               : rank_of(item);
    if ((item.kind == ItemKind::word && item.letter != 'N') || item.kind == ItemKind::setting) first = false;
  }
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return ranks_[a] < ranks_[b]; });
}

void Formatter::append_item(std::string& out, const Line& line, std::uint32_t at) {
  const Item& item = line.items[at];
  switch (item.kind) {
    case ItemKind::word:
      if (is_corner(item)) {
        append_plain(out, line.slice(item.bytes));
        break;
      }
      out += item.letter;
      if (item.value < 0) {
        const bool code = kCodeLetters.find(item.letter) != std::string_view::npos;
        out += plain_number(line.slice({item.bytes.begin + 1, item.bytes.end}), !code);
      } else {
        append_lexemes(out, line, at);
      }
      break;
    case ItemKind::setting:
      append_lexemes(out, line, at);
      break;
    case ItemKind::o_word:
      append_o_word(out, line, at);
      break;
    case ItemKind::control:
      append_control(out, line, at);
      break;
    case ItemKind::comment:
    case ItemKind::line_comment:
    case ItemKind::percent:
    case ItemKind::block_delete:
    case ItemKind::byte_order_mark:
    case ItemKind::unread:
      out += line.slice(item.bytes);
      break;
  }
}

void Formatter::append_o_word(std::string& out, const Line& line, std::uint32_t at) {
  const FlowStatement& flow = line.flow;
  out += 'O';
  if (flow.label_root < 0) {
    const std::string_view label = line.slice({flow.label.begin + 1, flow.label.end});
    const std::size_t name = label.find('<');
    if (name != std::string_view::npos)
      out += label.substr(name);
    else
      out += plain_number(label, false);
  }
  append_lexemes(out, line, at);
}

/// IF [#1 EQ 0] GOTO 20, WHILE [#1 LT 5] DO1, GOTO #1, END1.
void Formatter::append_control(std::string& out, const Line& line, std::uint32_t at) {
  const FlowStatement& flow = line.flow;
  append_plain(out, line.slice(flow.keyword));
  if (!flow.arguments.empty()) {
    out += ' ';
    lexemes_.clear();
    collect_nodes(line, line.items[at].first, flow.arguments.front() + 1);
    append_sorted(out, line, false);
    out += ' ';
    append_plain(out, line.slice(flow.second));
  }
  const bool goes = flow.word == FlowWord::go_to || flow.word == FlowWord::if_go_to;
  if (goes) out += ' ';
  if (flow.number >= 0) out += plain_number(line.slice(flow.label), false);
  if (!goes || flow.number >= 0) return;
  lexemes_.clear();
  collect_nodes(line, flow.label_first, flow.label_root + 1);
  append_sorted(out, line, false);
}

/// The parts of expressions. Not by a walk down the tree: a line of a megabyte may contain an expression as deep.
void Formatter::collect_nodes(const Line& line, std::int32_t first, std::int32_t end) {
  for (std::int32_t i = first; i < end; ++i) {
    const ExpressionNode& node = line.nodes[static_cast<std::size_t>(i)];
    // a sign + changes nothing; before a number it would be read as part of the number the next time
    if (node.kind != NodeKind::plus) lexemes_.push_back({node.own, node.kind});
    if (node.closing.end > node.closing.begin) lexemes_.push_back({node.closing, NodeKind::group});
  }
}

/// The parts of an item's expressions in the order written.
void Formatter::append_lexemes(std::string& out, const Line& line, std::uint32_t at) {
  const Item& item = line.items[at];
  lexemes_.clear();
  collect_nodes(line, item.first, node_end(line, at));
  const bool o_word = item.kind == ItemKind::o_word;
  if (item.kind == ItemKind::setting) {
    const std::uint32_t begin = item.bytes.begin;
    lexemes_.push_back({{begin, item.name < 0 ? begin + 1 : item.equals}, NodeKind::parameter});
    lexemes_.push_back({{item.equals, item.equals + 1}, NodeKind::group});
  }
  if (o_word && line.flow.keyword.end > 0) lexemes_.push_back({line.flow.keyword, NodeKind::function});
  append_sorted(out, line, o_word);
}

void Formatter::append_sorted(std::string& out, const Line& line, bool o_word) {
  std::sort(lexemes_.begin(), lexemes_.end(),
            [](const Lexeme& a, const Lexeme& b) { return a.bytes.begin < b.bytes.begin; });

  int depth = 0;
  for (const Lexeme& lexeme : lexemes_) {
    const std::string_view text = line.slice(lexeme.bytes);
    if (o_word && lexeme.bytes.begin == line.flow.keyword.begin && line.flow.keyword.end > 0) {
      out += ' ';
      out += keyword_text(line.flow.word);
      continue;
    }
    if (o_word && depth == 0 && text == "[" && lexeme.bytes.begin > line.flow.keyword.begin) out += ' ';
    if (lexeme.kind == NodeKind::number) {
      out += plain_number(text);
    } else if (lexeme.kind == NodeKind::binary) {
      out += ' ';
      append_plain(out, text);
      out += ' ';
    } else {
      append_plain(out, without_blanks_behind(text));
    }
    if (text.find('[') != std::string_view::npos) ++depth;
    if (text == "]") --depth;
  }
}

/// Indentation of this line, in blanks; opens and closes what its O word says.
std::size_t Formatter::indentation(const Line& line) {
  const auto blanks = [](std::size_t depth) { return kIndent * std::min(depth, kMostIndented); };
  if (!line.has_flow) return blanks(open_.size());
  const FlowStatement& flow = line.flow;
  const std::int32_t label = is_macro_word(flow.word) ? flow.number : flow.name;
  const auto close = [&](FlowWord word) {
    // a label that closes nothing is reported elsewhere
    int& still_open = open_of_[{word, label}];
    if (still_open == 0) return false;
    for (bool closed = false; !closed; open_.pop_back()) {
      const Open& last = open_.back();
      closed = last.word == word && last.name == label;
      --open_of_[{last.word, last.name}];
    }
    return true;
  };
  const auto open = [&](FlowWord word) {
    open_.push_back({word, label});
    ++open_of_[{word, label}];
    return blanks(open_.size() - 1);
  };
  switch (flow.word) {
    case FlowWord::sub:
    case FlowWord::if_true:
    case FlowWord::do_once:
    case FlowWord::repeat:
      return open(flow.word);
    case FlowWord::while_true:
      if (close(FlowWord::do_once)) break;
      return open(flow.word);
    case FlowWord::while_do:
    case FlowWord::do_loop:
      return open(FlowWord::do_loop);
    case FlowWord::end_do:
      close(FlowWord::do_loop);
      break;
    case FlowWord::else_if:
    case FlowWord::otherwise:
      return blanks(open_.empty() ? 0 : open_.size() - 1);
    case FlowWord::end_sub:
      close(FlowWord::sub);
      break;
    case FlowWord::end_if:
      close(FlowWord::if_true);
      break;
    case FlowWord::end_while:
      close(FlowWord::while_true);
      break;
    case FlowWord::end_repeat:
      close(FlowWord::repeat);
      break;
    case FlowWord::label:
    case FlowWord::call:
    case FlowWord::return_from:
    case FlowWord::break_loop:
    case FlowWord::continue_loop:
    case FlowWord::go_to:
    case FlowWord::if_go_to:
    case FlowWord::if_then:
      break;
  }
  return blanks(open_.size());
}

/// The first % opens a program, the next one, or the first after a word, ends it.
void Formatter::note_percent(const Line& line) {
  for (const Item& item : line.items) {
    if (item.kind == ItemKind::percent) ended_ = started_;
    started_ = started_ || item.kind == ItemKind::percent || item.kind == ItemKind::word ||
               item.kind == ItemKind::setting || item.kind == ItemKind::o_word ||
               item.kind == ItemKind::control;
  }
}

/// Writes the lines held back, their comments below each other.
void Formatter::flush() {
  std::size_t column = 0;
  for (const Formatted& line : run_) {
    const std::size_t width = count_code_points(line.code);
    if (width <= kAlignedUpTo) column = std::max(column, width);
  }
  for (const Formatted& line : run_) {
    const std::size_t width = count_code_points(line.code);
    out_ += line.code;
    out_.append(width < column ? column - width + 1 : 1, ' ');
    out_ += line.comment;
    out_ += '\n';
  }
  run_.clear();
}

bool format_program(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics, std::string& out,
                    const ReadingBounds& bounds, Dialect dialect) {
  Report report(diagnostics);
  Names names;
  Program program(sources, file, bounds, names, report, dialect);
  Formatter formatter(out);
  std::optional<Diagnostic> encoding = encoding_problem(file, sources[file].text());
  if (encoding) report.last_error(std::move(*encoding));
  bool behind_end = false;  // where check takes unreadable lines as remarks
  const bool macros = rules_of(dialect).macros.on;
  while (!formatter.ended()) {
    program.mute(behind_end);
    const Line* line = program.next();
    if (line == nullptr) break;
    formatter.add(*line);
    if (behind_end)
      behind_end = line->failed || !begins_subroutine(*line);
    else
      behind_end = !macros && !formatter.inside() && ends_program(*line);
  }
  formatter.finish();
  const SourceText& source = sources[file];
  const auto last = program.position();
  std::string_view rest = source.text().substr(std::min(last.offset, source.text().size()));
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    formatter.keep(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  report.close({file, last.line, 1, 1});
  return !diagnostics.has_errors();
}

}  // namespace kadr::gcode
