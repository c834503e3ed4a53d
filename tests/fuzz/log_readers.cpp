#include "log_readers.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "emulator/log/log_info.h"
#include "emulator/log_tools/diff/diff_report.h"
#include "emulator/log_tools/export/export.h"
#include "emulator/log_tools/report/compare.h"
#include "emulator/log_tools/report/report_page.h"
#include "emulator/log_tools/report/run_data.h"
#include "machine/base/require.h"

namespace kadr::fuzz {
namespace {

using log_tools::LogSamples;

/// One export or plot: the text, empty if a reader did not say yes to the end.
template <class Write>
std::string sampled(const std::string& path, Write write) {
  auto log = LogSamples::open(path);
  if (!log) {
    require(!log.error().reason.empty(), "a reader says why it can't read");
    return {};
  }
  std::string out;
  write(*log, [&](std::string_view text) { out += text; });
  const log::LogEnd* end = log->end();
  require(end != nullptr, "an export without a window reads to the end");
  require(log::is_sound(end->state) || !end->detail.empty(), "a log that breaks off says where");
  return log::is_sound(end->state) ? out : std::string();
}

void check_rows(const std::string& csv, std::int64_t control_ticks) {
  require(std::count(csv.begin(), csv.end(), '\n') > control_ticks, "a CSV has a line for each control tick");
}

std::string exports(const std::string& path, const log::LogInfo& info) {
  const auto csv = [](log_tools::CsvForm form) {
    return [form](LogSamples& log, const log_tools::Sink& sink) { write_csv(log, form, sink); };
  };
  const std::string plain = sampled(path, csv(log_tools::CsvForm::plain));
  if (!plain.empty()) check_rows(plain, info.control_ticks);
  const log_tools::PlotForm form{.width = 40};
  return plain + sampled(path, csv(log_tools::CsvForm::excel)) + sampled(path, log_tools::write_json_lines) +
         sampled(path, log_tools::write_vcd) +
         sampled(path, [](LogSamples& log, const log_tools::Sink& sink) { write_svg(log, "title", sink); }) +
         sampled(path, [&](LogSamples& log, const log_tools::Sink& sink) { sink(render_plot(log, form)); }) +
         sampled(path,
                 [&](LogSamples& log, const log_tools::Sink& sink) { sink(render_path_plot(log, form)); });
}

std::string pages(const std::string& path, const std::string& other) {
  auto data = log_tools::read_page_data(path, {});
  if (!data) return {};
  std::string out = log_tools::render_plain_page(*data) + log_tools::run_scripts(*data, "A-", true);
  const auto stretches = log_tools::stretches_of_interest(*data, 1000);
  if (auto full = log_tools::read_full_rate(path, {}, *data, stretches)) data->full_rate = std::move(*full);
  out += log_tools::run_scripts(*data, "B-", false);
  if (!log::is_sound(data->end.state)) return {};
  auto second = log_tools::read_page_data(other, {});
  require(second.has_value(), "a true log can be read");
  std::vector<log_tools::ComparedRun> runs;
  runs.push_back({"a", std::move(*data)});
  runs.push_back({"b", std::move(*second)});
  out += log_tools::render_comparison(runs) + text::json_line(log_tools::json_of(runs));
  return out + log_tools::render_compare_page(std::move(runs), 1'000'000);
}

void diffs(const std::string& path, const std::string& other) {
  log_tools::DiffOptions options;
  options.all = true;
  std::size_t bytes = 0;
  const log_tools::LogDiff* logs = nullptr;
  log_tools::TickDiffSinks by_tick;
  by_tick.begin = [&](const log_tools::LogDiff& diff) { logs = &diff; };
  by_tick.each = [&](const log_tools::TickDifference& d) {
    bytes += render_tick_difference(d, *logs).size();
  };
  if (const auto diff = log_tools::diff_logs(other, path, options, by_tick))
    bytes += log_tools::render_log_diff(*diff).size() + text::json_text(log_tools::json_of(*diff)).size();
  const log_tools::PathDiff* paths = nullptr;
  log_tools::PathDiffSinks by_path;
  by_path.begin = [&](const log_tools::PathDiff& diff) { paths = &diff; };
  by_path.block = [&](const log_tools::BlockDifference& d) {
    bytes += render_block_difference(d, paths->a.header).size();
  };
  by_path.span = [&](const log_tools::FeedSpan& span) { bytes += render_feed_span(span, *paths).size(); };
  if (const auto diff = log_tools::diff_paths(other, path, options, by_path))
    bytes += log_tools::render_path_diff(*diff).size() + text::json_text(log_tools::json_of(*diff)).size();
  require(bytes < 100'000'000, "a diff of small logs is small");
}

}  // namespace

LogAnswers read_log(const std::string& path, const std::string& other) {
  LogAnswers answers;
  const auto info = log::log_info(path);
  if (!info) {
    require(!log::LogReader::open(path), "what info can't read, no reader reads");
    require(!LogSamples::open(path), "what info can't read, no reader reads");
    return answers;
  }
  log::LogInfo shown = *info;
  shown.path = "a";
  const std::string table = log::render_log_info(shown);
  answers.sound = log::is_sound(info->end.state);
  if (answers.sound)
    require(info->content_hash_agrees().value_or(false) && info->log_hash_agrees().value_or(true) &&
                (info->steps_hash_agrees().value_or(true) ||
                 info->summary->run.outcome == log::Outcome::plant_error),
            "a sound log has the hashes of its summary");
  const std::string text = exports(path, *info), page = pages(path, other);
  diffs(path, other);
  require(answers.sound || (text.empty() && page.empty()), "what info denies, no reader says yes to");
  if (answers.sound) answers.text = table + text + page;
  return answers;
}

MemoryFile::MemoryFile() : file_(::memfd_create("log", 0)) {
  if (file_ < 0) throw std::runtime_error("memfd_create");
  path_ = "/proc/self/fd/" + std::to_string(file_);
}
MemoryFile::~MemoryFile() { ::close(file_); }

void MemoryFile::write(const void* data, std::size_t size) {
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, data, size, 0) != static_cast<ssize_t>(size))
    throw std::runtime_error("pwrite");
}

}  // namespace kadr::fuzz
