#include <fmt/format.h>

#include <string>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/text/text.h"
#include "machine/base/codes.h"
#include "machine/base/utf8.h"

/// `kadr explain`.
namespace kadr::cli {
namespace {

using text::Json;

constexpr std::size_t kLineCells = 90;

/// Text broken at blanks into lines of at most kLineCells; line ends in the text stay.
std::string wrapped(std::string_view text) {
  std::string out;
  std::size_t column = 0;
  while (!text.empty()) {
    if (text.front() == '\n') {
      out += '\n';
      column = 0;
      text.remove_prefix(1);
      continue;
    }
    const auto end = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    const bool blank = !text.empty() && text.front() == ' ';
    if (blank) text.remove_prefix(1);
    const std::size_t cells = text::display_width(word);
    if (column > 0 && column + cells > kLineCells) {
      if (!out.empty() && out.back() == ' ') out.pop_back();
      out += '\n';
      column = 0;
    }
    out += word;
    column += cells;
    if (blank) {
      out += ' ';
      ++column;
    }
  }
  return out;
}

Json code_json(const CodeEntry& entry) {
  return {{"code", code_name(entry.code)},
          {"name", entry.name},
          {"title", entry.title},
          {"explanation", entry.explanation}};
}

int list_codes(Console& console) {
  using Align = text::TextTable::Align;
  text::TextTable table({{"code", Align::left}, {"title", Align::left}});
  Json list = Json::array();
  for (const CodeEntry& entry : all_codes()) {
    table.add({code_name(entry.code), std::string(entry.title)});
    list.push_back(code_json(entry));
  }
  if (console.options().json)
    console.document(list);
  else
    console.data(table.render());
  return kYes;
}

}  // namespace

int explain_codes(const Arguments& arguments, Console& console) {
  if (arguments.list) return list_codes(console);
  if (arguments.files.empty()) {
    console.error("which code? e.g. kadr explain K2107; kadr explain --list shows all");
    return kNotStarted;
  }
  Json list = Json::array();
  int code = kYes;
  bool first = true;
  for (const std::string& text : arguments.files) {
    const auto known = parse_code(text);
    if (!known) {
      console.error(fmt::format("there is no diagnostic '{}'; kadr explain --list shows all", text));
      code = kNotStarted;
      continue;
    }
    const CodeEntry& entry = code_entry(*known);
    list.push_back(code_json(entry));
    if (!console.options().json)
      console.data(fmt::format("{}{}: {}\n\n{}\n", first ? "" : "\n", code_name(entry.code), entry.title,
                               wrapped(entry.explanation)));
    first = false;
  }
  if (console.options().json) console.document(list);
  return code;
}

}  // namespace kadr::cli
