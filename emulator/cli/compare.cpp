#include "emulator/log_tools/report/compare.h"

#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/log_notes.h"
#include "emulator/cli/result_file.h"
#include "emulator/text/text.h"

namespace kadr::cli {

int compare_logs(const Arguments& arguments, Console& console) {
  std::vector<log_tools::ComparedRun> runs;
  for (const std::string& path : arguments.files) {
    auto data = log_tools::read_page_data(path, {});
    if (!data) return unreadable_log(data.error(), console);
    if (!log::is_sound(data->end.state)) {
      console.error(fmt::format("{}: {}", path, data->end.detail));
      return kNo;
    }
    note_passed_over(path, data->end, console);
    runs.push_back({path, std::move(*data)});
  }
  if (console.options().json)
    console.document(log_tools::json_of(runs));
  else if (!console.options().quiet)
    console.data(log_tools::render_comparison(runs));
  const std::string& name = arguments.exported.output_path;
  if (!name.empty()) {
    const std::string page = log_tools::render_compare_page(
        std::move(runs), static_cast<std::size_t>(arguments.exported.max_size_mb * 1e6));
    write_file(name, page);
    console.note(fmt::format("wrote {}: {}", name, text::bytes_text(static_cast<std::int64_t>(page.size()))));
  }
  return kYes;
}

}  // namespace kadr::cli
