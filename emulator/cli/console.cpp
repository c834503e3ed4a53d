#include "emulator/cli/console.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "emulator/cli/standard_streams.h"
#include "emulator/text/text.h"
#include "machine/base/output_file.h"
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

/// True if standard output and standard error are one file or pipe; on a terminal both are read.
bool same_streams() {
  struct stat output {
  }, errors{};
  return ::fstat(STDOUT_FILENO, &output) == 0 && ::fstat(STDERR_FILENO, &errors) == 0 &&
         !S_ISCHR(output.st_mode) && output.st_dev == errors.st_dev && output.st_ino == errors.st_ino;
}

/// What a list keeps, the note that tells the rest apart.
struct Kept {
  std::size_t errors = 0, others = 0, rest = 0;
};

Kept count_kept(const Diagnostics& list) {
  Kept kept;
  for (const Diagnostic& d : list.list())
    ++(tells_rest(d) ? kept.rest : d.severity == Severity::error ? kept.errors : kept.others);
  return kept;
}

/// "5980 more not shown (--max-errors 0 shows 1980 of them)". @param hidden  kept and not shown
std::string hidden_text(const Diagnostics& list, std::size_t hidden, std::string_view what) {
  const bool all = list.left_out() == 0 && !list.stopped();
  return fmt::format("{}{} more {}not shown (--max-errors 0 shows {})", list.stopped() ? "at least " : "",
                     hidden + list.left_out(), what, all ? "all" : fmt::format("{} of them", hidden));
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

void Console::summary(std::string_view text) {
  if (output_claimed_)
    message(text, Styles::replaced);
  else
    data(text);
}

void Console::claim_output(const std::string& path) {
  if (path.empty()) return;
  struct stat status {};
  const bool named = ::stat(path.c_str(), &status) == 0;
  // a terminal shows both, and the null device neither
  const bool mixes = path == "-" || (named && !S_ISCHR(status.st_mode));
  if (!mixes) return;
  const std::string shown = path == "-" ? "standard output" : path;
  if (is_standard_output(path)) {
    if (options_.json) throw WorldError(fmt::format("{}: the JSON document goes there, too", shown));
    if (output_claimed_) throw WorldError(fmt::format("{}: another result goes there, too", shown));
    output_claimed_ = true;
  }
  const bool with_messages = path == "-" ? same_streams() : is_standard_error(path);
  if (with_messages && !options_.quiet)
    throw WorldError(fmt::format("{}: messages go there, too; -q leaves them out", shown));
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
  Kept kept = count_kept(list);
  std::size_t most = options_.max_errors.value_or(sarif() ? 0 : kMaxErrors);
  if (most == 0) most = kept.errors + kept.others;
  std::size_t errors = std::min(most, kept.errors);
  std::size_t others = std::min(most - errors, kept.others);
  const std::size_t hidden = kept.errors + kept.others - errors - others;

  std::string out;
  for (const Diagnostic* d : by_place(list)) {
    // how many there are beyond those kept is said however few are shown
    std::size_t& room = tells_rest(*d) ? kept.rest : d->severity == Severity::error ? errors : others;
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
    if (hidden > 0) out += hidden_text(list, hidden, "") + '\n';
    out += fmt::format("{}{} in {}\n", list.stopped() ? "at least " : "",
                       count_text(list.errors(), list.warnings()), displayable(subject));
  }
  const Styles styles = colour(where) ? Styles::kept : Styles::replaced;
  if (where == Where::output)
    gather(out, styles);
  else
    message(out, styles);
  if (hidden == 0 || options_.format == DiagnosticFormat::human) return;
  const std::string text = hidden_text(list, hidden, "diagnostics ");
  if (!sarif()) return note(text);
  sarif_.add({.code = Code::too_many_errors,
              .severity = Severity::note,
              .span = {},
              .message = text,
              .label = {},
              .notes = {},
              .help = {}},
             sources);
}

}  // namespace kadr::cli
