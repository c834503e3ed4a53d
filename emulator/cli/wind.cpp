#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/result_file.h"
#include "emulator/text/text.h"

/// `kadr wind`: winding programs.
namespace kadr::cli {

int write_winding(const Arguments& arguments, Console& console) {
  const std::string& kind = arguments.wind_kind;
  const auto winding = scenarios::wind(kind, arguments.wind_settings);
  if (!winding) {
    console.error(fmt::format("wind {}: {}", kind, winding.error()));
    return kNotStarted;
  }
  const std::string command = scenarios::wind_command(kind, arguments.wind_settings);
  const std::string text = scenarios::render_winding(*winding, command);
  const std::string& path = arguments.program_path;
  const bool to_file = !path.empty() && path != "-";
  if (to_file) write_file(path, text);
  if (console.options().json) {
    text::Json j;
    j["file"] = to_file ? text::Json(path) : text::Json(nullptr);
    j["command"] = command;
    j["title"] = winding->title;
    j["blocks"] = winding->points.size() - 1;
    j["fibre_mm_s"] = winding->fibre_mm_s;
    j["text"] = to_file ? text::Json(nullptr) : text::Json(text);
    console.document(j);
  } else if (to_file) {
    console.note(fmt::format("wrote {}: {}, {}", path, winding->title,
                             text::counted(static_cast<std::int64_t>(winding->points.size() - 1), "block")));
  } else {
    console.bytes(text);
  }
  return kYes;
}

}  // namespace kadr::cli
