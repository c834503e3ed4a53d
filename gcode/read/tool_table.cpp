#include "gcode/read/tool_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "gcode/constants.h"
#include "gcode/interpret/message.h"
#include "gcode/read/report.h"
#include "gcode/read/scanner.h"
#include "machine/base/parse_number.h"

namespace kadr::gcode {
namespace {

constexpr std::string_view kLetters = "TPXYZABCUVWDIJQ";
constexpr double kLargestOffset_u = 1e9;  // far beyond any machine
constexpr double kWholeTolerance = 1e-4;  // RS-274/NGC
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_separator(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// The number that a letter has in a tool; null for T, P and Q, which are whole.
double* real_field(Tool& tool, char letter) {
  const int axis = axis_index(letter);
  if (axis >= 0) return &tool.offset[static_cast<std::size_t>(axis)];
  return letter == 'D'   ? &tool.diameter_mm
         : letter == 'I' ? &tool.front_angle_deg
         : letter == 'J' ? &tool.back_angle_deg
                         : nullptr;
}

class TableReader {
 public:
  TableReader(std::uint32_t file, Report& report) : file_(file), report_(report) {}

  /// @param at  first byte that counts: after a byte order mark
  void read_line(std::string_view text, std::size_t at, std::uint32_t line) {
    line_ = line;
    present_.clear();
    Tool tool;
    const std::string_view words = text.substr(0, text.find(';'));
    bool good = true;
    while (at < words.size()) {
      if (is_separator(words[at])) {
        ++at;
        continue;
      }
      std::size_t end = at;
      while (end < words.size() && !is_separator(words[end])) ++end;
      good = read_word(words.substr(at, end - at), at, tool) && good;
      at = end;
    }
    if (present_.empty() || !good) return;
    if (!has_required(tool)) return;
    keep(tool);
  }
  ToolTable take() { return std::move(table_); }

 private:
  struct Place {
    char letter;
    Span span;
  };

  Span span(std::size_t at, std::size_t length) const {
    return {file_, line_, static_cast<std::uint32_t>(at + 1), static_cast<std::uint32_t>(length)};
  }
  bool fail(Code code, Span place, std::string label, std::string help = {}) {
    report_.error(problem(code, place, std::move(label), std::move(help)));
    return false;
  }
  const Place* find(char letter) const {
    const auto it =
        std::find_if(present_.begin(), present_.end(), [=](const Place& p) { return p.letter == letter; });
    return it == present_.end() ? nullptr : &*it;
  }

  bool read_word(std::string_view word, std::size_t at, Tool& tool) {
    const char letter = upper(word[0]);
    const Span place = span(at, word.size());
    if (kLetters.find(letter) == std::string_view::npos)
      return fail(Code::tool_table_word, place,
                  is_letter(letter) ? fmt::format("{} means nothing in a tool table", letter)
                                    : "a word begins with a letter",
                  "words are T P X Y Z A B C U V W D I J Q, each with its number; remarks follow ;");
    const bool repeated = find(letter) != nullptr;
    present_.push_back({letter, place});
    if (repeated)
      return fail(Code::tool_table_repeated, place, fmt::format("a second {} on this line", letter));
    const auto value = parse_number(word.substr(1));
    if (!value) return bad_number(word, place);
    return set(tool, letter, *value, place);
  }

  bool bad_number(std::string_view word, Span place) {
    std::string help;
    if (word.size() == 1) {
      help = "write the number right after its letter, without a blank: Z12.5";
    } else if (word.find(',') != std::string_view::npos) {
      std::string right(word);
      std::replace(right.begin(), right.end(), ',', '.');
      help = fmt::format("the decimal mark is a point: {}", right);
    } else if (std::any_of(word.begin() + 1, word.end(),
                           [](char c) { return kLetters.find(upper(c)) != std::string_view::npos; })) {
      help = "write a blank or tab between two words: T1 P1";
    }
    return fail(Code::tool_table_number, place,
                word.size() == 1 ? fmt::format("no number follows {}", upper(word[0]))
                                 : fmt::format("{} is not a number", valid_text(word.substr(1))),
                std::move(help));
  }

  bool set(Tool& tool, char letter, double value, Span place) {
    if (double* field = real_field(tool, letter)) {
      *field = value;
      if (std::fabs(value) <= kLargestOffset_u) return true;
      return fail(Code::tool_table_range, place,
                  fmt::format("{} is {:.6g}, allowed up to {:.0e}", letter, value, kLargestOffset_u));
    }
    const double most = letter == 'Q' ? kLargestOrientation : kLargestTool;
    const double whole = std::floor(value + 0.5);
    if (!(std::fabs(value - whole) <= kWholeTolerance) || whole < 0 || whole > most)
      return fail(Code::tool_table_range, place,
                  fmt::format("{} is {:.6g}, allowed: whole numbers from 0 to {:.0f}", letter, value, most));
    (letter == 'T' ? tool.number : letter == 'P' ? tool.pocket : tool.orientation) = static_cast<int>(whole);
    return true;
  }

  bool has_required(const Tool& tool) {
    const Span first = present_.front().span;
    const Span last = present_.back().span;
    const Span all{file_, line_, first.column, last.column + last.length - first.column};
    if (find('T') == nullptr)
      return fail(Code::tool_table_missing, all, "there is no T on this line",
                  "begin the line with T and the number of the tool");
    if (find('P') == nullptr)
      return fail(Code::tool_table_missing, all, fmt::format("tool {} has no P", tool.number),
                  "P is the pocket of the tool; without a changer give each tool a number of its own");
    return true;
  }

  void keep(const Tool& tool) {
    const Span tool_place = find('T')->span;
    if (const auto [before, fresh] = line_of_tool_.try_emplace(tool.number, line_); !fresh) {
      fail(Code::tool_table_tool_twice, tool_place,
           fmt::format("line {} gives T{} already", before->second, tool.number));
      return;
    }
    if (const auto [before, fresh] = line_of_pocket_.try_emplace(tool.pocket, line_); !fresh) {
      report_.warning(
          problem(Code::tool_table_pocket_twice, find('P')->span,
                  fmt::format("pocket {} already holds the tool on line {}", tool.pocket, before->second)));
    }
    table_.tools.push_back(tool);
  }

  std::uint32_t file_;
  Report& report_;
  std::uint32_t line_ = 0;
  std::vector<Place> present_;  ///< words of the line, in order
  std::unordered_map<int, std::uint32_t> line_of_tool_, line_of_pocket_;
  ToolTable table_;
};

}  // namespace

std::optional<std::size_t> ToolIndex::find(const std::vector<Tool>& tools, int number) {
  for (; indexed_ < tools.size(); ++indexed_) rows_.try_emplace(tools[indexed_].number, indexed_);
  const auto row = rows_.find(number);
  return row == rows_.end() ? std::nullopt : std::optional(row->second);
}

const Tool* ToolTable::find(int number) const {
  const auto row = index.find(tools, number);
  return row ? &tools[*row] : nullptr;
}

Tool* ToolTable::find(int number) { return const_cast<Tool*>(std::as_const(*this).find(number)); }

ToolTable read_tool_table(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics) {
  Report report(diagnostics);
  TableReader reader(file, report);
  std::string_view text = sources[file].text();
  std::size_t skipped = text.substr(0, kByteOrderMark.size()) == kByteOrderMark ? kByteOrderMark.size() : 0;
  std::uint32_t line = 0;
  while (!text.empty() && !report.full()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.read_line(text.substr(0, end), std::exchange(skipped, 0), ++line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  report.close({file, std::max<std::uint32_t>(line, 1), 1, 1});
  return reader.take();
}

std::string render_tool_table(const ToolTable& table) {
  std::string out;
  for (Tool tool : table.tools) {
    out += fmt::format("T{} P{}", tool.number, tool.pocket);
    for (const char letter : kLetters) {
      const double* field = real_field(tool, letter);
      if (field != nullptr && *field != 0) out += fmt::format(" {}{}", letter, number_text(*field));
    }
    if (tool.orientation != 0) out += fmt::format(" Q{}", tool.orientation);
    out += '\n';
  }
  return out;
}

}  // namespace kadr::gcode
