#include "emulator/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "emulator/cli/standard_streams.h"
#include "emulator/text/text.h"
#include "machine/base/write_all.h"

namespace kadr::cli {
namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr std::size_t kBuffer_bytes = std::size_t{1} << 18;

bool set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value && std::string_view(value) != "0";
}

/// The current folder; empty if it is gone.
std::string current_folder() {
  std::error_code gone;
  return std::filesystem::current_path(gone).string();
}

}  // namespace

Console::Console(const OutputOptions& options)
    : options_(options), terminal_(::isatty(STDOUT_FILENO) != 0), sarif_(current_folder()) {
  buffer_.reserve(kBuffer_bytes + 4096);
}

Console::~Console() {
  // a command that ends with an exception: what it printed before still goes out
  write_all(STDOUT_FILENO, buffer_);
}

void Console::data(std::string_view text) { gather(text, Styles::replaced); }

void Console::gather(std::string_view text, Styles styles) {
  append_shown(buffer_, text, styles);
  if (buffer_.size() >= kBuffer_bytes) flush();
}

void Console::bytes(std::string_view bytes) {
  if (terminal_) return data(bytes);
  buffer_ += bytes;
  if (buffer_.size() >= kBuffer_bytes) flush();
}

void Console::flush() {
  try {
    print_gathered(buffer_);
  } catch (...) {
    // what can't be written is not tried again
    buffer_.clear();
    throw;
  }
  buffer_.clear();
}

void Console::finish(int exit_code) {
  if (sarif()) {
    const std::string text = text::json_text(sarif_.document(exit_code)) + '\n';
    if (sarif_where_ == Where::output)
      data(text);
    else
      message(text, Styles::replaced);
  }
  flush();
}

void Console::message(std::string_view text, Styles styles) {
  flush();
  tell(text, styles);
}

void Console::note(std::string_view text) {
  if (!options_.quiet && !sarif()) error(text);
}

void Console::error(std::string_view text) {
  flush();
  tell_line(text);
}

bool Console::colour(Where where) const {
  if (options_.color != When::automatic) return options_.color == When::always;
  if (set("NO_COLOR")) return false;
  if (set("CLICOLOR_FORCE")) return true;
  // standard output has the same bytes on a terminal and in a file
  return where == Where::errors && ::isatty(STDERR_FILENO) && !std::getenv("CI") &&
         std::string_view(std::getenv("TERM") ? std::getenv("TERM") : "dumb") != "dumb";
}

std::vector<const Diagnostic*> by_place(const Diagnostics& list) {
  std::vector<const Diagnostic*> sorted;
  for (const Diagnostic& d : list.list()) sorted.push_back(&d);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic* a, const Diagnostic* b) {
    const auto place = [](const Span& s) {
      return s.line == 0 ? std::tuple(0u, 0u, 0u) : std::tuple(s.file + 1, s.line, s.column);
    };
    return place(a->span) < place(b->span);
  });
  return sorted;
}

void Console::diagnostics(const Diagnostics& list, const SourceSet& sources, const std::string& subject,
                          Where where) {
  sarif_where_ = where;
  if (list.list().empty()) return;
  // errors come first if there is not room for all
  std::size_t most = options_.max_errors.value_or(sarif() ? 0 : kMaxErrors);
  if (most == 0) most = list.list().size();
  std::size_t errors = std::min(most, list.errors());
  std::size_t others = std::min(most - errors, list.list().size() - list.errors());
  const std::size_t shown = errors + others;

  std::string out;
  for (const Diagnostic* d : by_place(list)) {
    std::size_t& room = d->severity == Severity::error ? errors : others;
    if (room == 0) continue;
    --room;
    switch (options_.format) {
      case DiagnosticFormat::human:
        out += render_human(*d, sources, colour(where)) + '\n';
        break;
      case DiagnosticFormat::gcc:
        out += render_gcc(*d, sources) + '\n';
        break;
      case DiagnosticFormat::json:
        out += text::json_line(text::json_of(*d, sources)) + '\n';
        break;
      case DiagnosticFormat::sarif:
        sarif_.add(*d, sources);
        break;
    }
  }
  if (options_.format == DiagnosticFormat::human) {
    if (shown < list.list().size())
      out += fmt::format("{} more not shown (--max-errors 0 shows all)\n", list.list().size() - shown);
    out += fmt::format("{} in {}\n", count_text(list.errors(), list.warnings()), displayable(subject));
  }
  const Styles styles = colour(where) ? Styles::kept : Styles::replaced;
  if (where == Where::output)
    gather(out, styles);
  else
    message(out, styles);
  if (options_.format != DiagnosticFormat::human && shown < list.list().size())
    note(fmt::format("{} more diagnostics not shown (--max-errors 0 shows all)", list.list().size() - shown));
}

}  // namespace kadr::cli
