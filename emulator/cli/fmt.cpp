#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/cli/result_file.h"
#include "gcode/gcode.h"
#include "machine/base/terminal_text.h"

/// `kadr fmt`: programs in normal form.
namespace kadr::cli {
namespace {

using text::Json;

struct Formatted {
  bool readable = false;
  bool differs = false;
  std::string text;
};

int act(const Formatted& formatted, const std::string& path, const Arguments& arguments, Console& console) {
  const int code = formatted.readable ? kYes : kNo;
  if (arguments.only_check) {
    if (formatted.differs && !console.options().json) console.data(displayable(program_text(path)) + '\n');
    return formatted.differs ? kNo : code;
  }
  if (!arguments.in_place) {
    if (!console.options().json) console.bytes(formatted.text);
    return code;
  }
  if (!formatted.readable) {
    console.error(fmt::format("{}: left unchanged; fix its errors first", path));
    return code;
  }
  // a reader sees the old text or the new one
  if (formatted.differs) write_file(path, formatted.text, {.own_input = true});
  return code;
}

/// One program; its exit code.
int format_one(const std::string& path, const Arguments& arguments, Console& console, Json& documents) {
  SourceSet sources;
  Diagnostics diagnostics;
  Formatted formatted;
  try {
    if (path == "-" && arguments.in_place) throw WorldError("standard input can't be rewritten in place");
    const std::uint32_t program = load_program(path, arguments.bounds, sources);
    formatted.readable =
        gcode::format_program(sources, program, diagnostics, formatted.text, arguments.bounds,
                              arguments.dialect.value_or(gcode::Dialect::linuxcnc));
    formatted.differs = formatted.text != sources[program].text();
    const int code = act(formatted, path, arguments, console);
    if (!console.options().json) {
      console.diagnostics(diagnostics, sources, program_text(path), Console::Where::errors);
      return code;
    }
    Json j;
    j["program"] = program_text(path);
    j["exit_code"] = code;
    j["differs"] = formatted.differs;
    j["text"] = arguments.only_check || arguments.in_place ? Json(nullptr) : Json(formatted.text);
    j["diagnostics"] = text::json_of(diagnostics, sources);
    documents.push_back(std::move(j));
    return code;
  } catch (const WorldError& e) {
    // the other programs are still formatted
    console.error(e.what());
    return kNotStarted;
  }
}

}  // namespace

int format_programs(const Arguments& arguments, Console& console) {
  int worst = kYes;
  Json documents = Json::array();
  for (const std::string& path : arguments.files)
    worst = std::max(worst, format_one(path, arguments, console, documents));
  if (console.options().json) console.document(documents);
  return worst;
}

}  // namespace kadr::cli
