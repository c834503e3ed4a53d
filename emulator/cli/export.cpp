#include <fmt/format.h>

#include <optional>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/log_notes.h"
#include "emulator/cli/result_file.h"
#include "emulator/log_tools/export/export.h"
#include "emulator/text/text.h"
#include "machine/base/terminal_text.h"

/// `kadr export` and `kadr plot`: a log's signals for other tools and for a quick look.
namespace kadr::cli {
namespace {

using log_tools::LogSamples;

// shown unless signals are chosen
constexpr const char* kFew = "feed.commanded*,feed.programmed*,path.error*,axis.*.following*";
constexpr const char* kTwo = "feed.commanded*,path.error*";

/// The log with its signals chosen, or the exit code.
tl::expected<LogSamples, int> open_log(const Arguments& arguments, const char* without_choice,
                                       Console& console) {
  auto log = LogSamples::open(arguments.files.front());
  if (!log) return tl::unexpected(unreadable_log(log.error(), console));
  const log_tools::SampleChoice& choice = arguments.exported.choice;
  if (choice.from_s > choice.to_s) {
    console.error(fmt::format("--from {} s is after --to {} s", choice.from_s, choice.to_s));
    return tl::unexpected(kNotStarted);
  }
  if (choice.signals.empty() && without_choice != nullptr) {
    std::vector<std::string> names;
    // the usual signals that the log has: without plant there is no path error
    for (const log_tools::Signal& signal : log->signals()) {
      std::string_view rest = without_choice;
      while (!rest.empty()) {
        const auto comma = rest.find(',');
        if (log_tools::matches_pattern(signal.name, rest.substr(0, comma))) names.push_back(signal.name);
        rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
      }
    }
    log->choose(choice, names);
    return std::move(*log);
  }
  if (const auto chosen = log->choose(choice); !chosen) {
    console.error(fmt::format("{}: {}", arguments.files.front(), chosen.error()));
    return tl::unexpected(kNotStarted);
  }
  return std::move(*log);
}

/// Yes if everything requested was there. Reports a log that breaks off, and what of it was passed over.
int end_of(const LogSamples& log, const std::string& path, Console& console, bool all_read = true) {
  const log::LogEnd* end = all_read ? log.end() : nullptr;
  if (end == nullptr && !log.remainder().empty()) {
    console.error(fmt::format("{}: {}, behind what was read", path, log.remainder()));
    return kNo;
  }
  if (end != nullptr) note_passed_over(path, *end, console);
  if (end == nullptr || log::is_sound(end->state)) return kYes;
  console.error(fmt::format("{}: {}; what was written ends at {} s", path, end->detail,
                            text::fixed(log.header().seconds(end->valid_until), 6)));
  return kNo;
}

/// The meanings of code values, one paragraph per signal.
std::string code_legend(const LogSamples& log) {
  std::string out;
  for (const log_tools::Signal& s : log.signals()) {
    if (s.words.empty()) continue;
    out += fmt::format("\n{}:", displayable(s.name));
    for (std::size_t i = 0; i < s.words.size(); ++i)
      out += fmt::format("{} {} {}", i == 0 ? "" : ",", i, s.words[i]);
  }
  return out.empty() ? out : out + '\n';
}

std::string signal_list(const LogSamples& log) {
  text::TextTable table({{"signal", text::TextTable::Align::left}, {"unit", text::TextTable::Align::left}});
  for (const log_tools::Signal& s : log.signals()) table.add({s.name, s.unit.empty() ? "-" : s.unit});
  return table.render() + code_legend(log);
}

void write(LogSamples& log, ExportForm form, const log_tools::Sink& sink) {
  switch (form) {
    case ExportForm::csv:
      return log_tools::write_csv(log, log_tools::CsvForm::plain, sink);
    case ExportForm::excel:
      return log_tools::write_csv(log, log_tools::CsvForm::excel, sink);
    case ExportForm::json:
      return log_tools::write_json_lines(log, sink);
    case ExportForm::vcd:
      return log_tools::write_vcd(log, sink);
    case ExportForm::svg:
      return log_tools::write_svg(log, log.header().program_name + " on " + log.header().machine_name, sink);
    case ExportForm::none:
      return;
  }
}

}  // namespace

int export_log(const Arguments& arguments, Console& console) {
  const ExportOptions& out = arguments.exported;
  const bool few = out.form == ExportForm::vcd || out.form == ExportForm::svg;
  if (out.form == ExportForm::vcd && out.choice.rate_hz > 0) {
    console.error("--vcd contains every pulse: use --from and --to with it, not --rate-hz");
    return kNotStarted;
  }
  auto log = open_log(arguments, few ? kFew : nullptr, console);
  if (!log) return log.error();
  if (arguments.list) {
    console.data(signal_list(*log));
    return end_of(*log, arguments.files.front(), console, false);
  }
  std::optional<ResultFile> file;
  if (!out.output_path.empty() && out.output_path != "-") file.emplace(out.output_path);
  std::int64_t bytes = 0;
  write(*log, out.form, [&](std::string_view text) {
    bytes += static_cast<std::int64_t>(text.size());
    if (file)
      file->write(text);
    else
      console.bytes(text);
  });
  if (file) {
    file->close();
    console.note(fmt::format("wrote {}: {}", out.output_path, text::bytes_text(bytes)));
  }
  return end_of(*log, arguments.files.front(), console);
}

int plot_log(const Arguments& arguments, Console& console) {
  const ExportOptions& out = arguments.exported;
  auto log = open_log(arguments, out.path ? nullptr : kTwo, console);
  if (!log) return log.error();
  console.data(out.path ? log_tools::render_path_plot(*log, out.plot)
                        : log_tools::render_plot(*log, out.plot));
  return end_of(*log, arguments.files.front(), console);
}

}  // namespace kadr::cli
