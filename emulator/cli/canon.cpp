#include <fmt/format.h>

#include <string>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/text/text.h"
#include "gcode/gcode.h"
#include "machine/base/terminal_text.h"

namespace kadr::cli {
namespace {

constexpr std::size_t kPiece_bytes = std::size_t{1} << 15;  // of the trace, handed to the console at once

const Diagnostic& first_error(const Diagnostics& diagnostics) {
  for (const Diagnostic* d : by_place(diagnostics))
    if (d->severity == Severity::error) return *d;
  return diagnostics.list().front();
}

/// The trace's last line for a program with errors.
std::string error_line(const Diagnostic& d) {
  const std::string message = d.message.empty() ? std::string(code_entry(d.code).title) : d.message;
  std::string text = text::one_line(
      fmt::format("{}{}{} [{}]", message, d.label.empty() ? "" : ": ", d.label, code_name(d.code)), 500);
  for (char& c : text)
    if (c == '"') c = '\'';
  return fmt::format("ERROR {} \"{}\"\n", d.span.line, text);
}

/// "STRAIGHT_FEED 1.000000 ... @12" as {"call": ..., "line": 12, "arguments": [...]}; words stay words.
std::string call_json(std::string_view line, std::uint32_t source_line) {
  text::Json j;
  if (const auto at = line.rfind(" @"); at != std::string_view::npos) line = line.substr(0, at);
  const auto name_end = std::min(line.find(' '), line.size());
  j["call"] = std::string(line.substr(0, name_end));
  j["line"] = source_line;
  text::Json words = text::Json::array();
  line.remove_prefix(std::min(name_end + 1, line.size()));
  if (!line.empty() && line.front() == '"') {
    words.push_back(std::string(line.substr(1, line.size() < 2 ? 0 : line.size() - 2)));
    line = {};
  }
  while (!line.empty()) {
    const auto end = std::min(line.find(' '), line.size());
    const text::Json number = text::Json::parse(line.substr(0, end), nullptr, false);
    words.push_back(number.is_number() ? number : text::Json(std::string(line.substr(0, end))));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  j["arguments"] = std::move(words);
  return text::json_line(j);
}

}  // namespace

int canon_program(const Arguments& arguments, Console& console) {
  SourceSet sources;
  const std::uint32_t program = load_program(arguments.files.front(), arguments.bounds, sources);
  const bool json = console.options().json;
  Diagnostics diagnostics;
  gcode::InterpretOptions options;
  options.units_said = false;
  if (!load_reading(arguments, program, sources, options, diagnostics)) {
    console.diagnostics(diagnostics, sources, file_in_error(diagnostics, sources), Console::Where::errors);
    return kNotStarted;
  }

  if (json)
    console.data(
        fmt::format("{{\n  \"kadr\": \"{}\",\n  \"command\": \"canon\",\n  \"calls\": [", KADR_VERSION));
  std::string text;
  const auto hand_over = [&] {
    console.data(text);
    text.clear();
  };
  bool first = true;
  gcode::interpret(
      sources, program, options,
      [&](const gcode::Block& block) {
        // nothing moves after an error
        if (diagnostics.has_errors()) return;
        if (block.span.line < arguments.first_line || block.span.line > arguments.last_line) return;
        const std::size_t before = text.size();
        const bool called = block.span.file != program;
        gcode::append_canon(text, block,
                            called ? displayable(sources[block.span.file].name()) : std::string());
        if (text.size() == before) return;
        if (json) {
          console.data((first ? "\n    " : ",\n    ") + call_json(text, block.span.line));
          text.clear();
        } else {
          text += '\n';
          if (text.size() >= kPiece_bytes) hand_over();
        }
        first = false;
      },
      diagnostics);

  hand_over();

  const int code = diagnostics.has_errors() ? kNo : kYes;
  if (json) {
    text::Json list = text::json_of(diagnostics, sources);
    console.data(fmt::format("{}],\n  \"exit_code\": {},\n  \"diagnostics\": {}\n}}\n", first ? "" : "\n  ",
                             code, text::json_line(list)));
    return code;
  }
  if (diagnostics.has_errors()) console.data(error_line(first_error(diagnostics)));
  console.diagnostics(diagnostics, sources, program_text(arguments.files.front()), Console::Where::errors);
  return code;
}

}  // namespace kadr::cli
