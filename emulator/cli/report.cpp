#include <fmt/format.h>

#include <optional>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/log_notes.h"
#include "emulator/cli/result_file.h"
#include "emulator/log_tools/report/report_page.h"
#include "emulator/text/text.h"

namespace kadr::cli {
namespace {

/// "part.html" of "part.lcmlog".
std::string page_path(const std::string& log) {
  constexpr std::string_view kEnd = ".lcmlog";
  const bool usual = log.size() > kEnd.size() && log.ends_with(kEnd);
  return (usual ? log.substr(0, log.size() - kEnd.size()) : log) + ".html";
}

}  // namespace

int report_log(const Arguments& arguments, Console& console) {
  const ExportOptions& out = arguments.exported;
  const std::string& path = arguments.files.front();
  auto data = log_tools::read_page_data(path, out.choice);
  if (!data) return unreadable_log(data.error(), console);
  const bool whole = log::is_sound(data->end.state);
  const std::string end = data->end.detail;
  note_passed_over(path, data->end, console);
  const std::string name = out.output_path.empty() ? page_path(path) : out.output_path;
  std::optional<log::LogReadError> failure;
  const auto again = [&](const log_tools::PageData& page, const std::vector<log_tools::Stretch>& stretches) {
    auto read = log_tools::read_full_rate(path, out.choice, page, stretches);
    if (!read) failure = read.error();
    return read ? std::move(*read) : log_tools::FullRate{};
  };
  const std::string page =
      out.plain ? log_tools::render_plain_page(*data)
                : log_tools::render_report_page(std::move(*data),
                                                static_cast<std::size_t>(out.max_size_mb * 1e6), again);
  if (failure) return unreadable_log(*failure, console);
  if (name == "-") {
    console.data(page);
  } else {
    write_file(name, page);
    console.note(fmt::format("wrote {}: {}", name, text::bytes_text(static_cast<std::int64_t>(page.size()))));
  }
  if (!whole) console.error(fmt::format("{}: the log breaks off; the page says where: {}", path, end));
  return whole ? kYes : kNo;
}

}  // namespace kadr::cli
