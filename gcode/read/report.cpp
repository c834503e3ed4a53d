#include "gcode/read/report.h"

#include <fmt/format.h>

#include <utility>

#include "gcode/read/other_kind.h"

namespace kadr::gcode {

void Report::error(Diagnostic d) {
  ++errors_;
  if (place_) d.span = *place_;
  if (full() || tell_kind(d) || !first_time(d)) return;
  ++told_errors_;
  d.severity = Severity::error;
  add(std::move(d));
}

void Report::last_error(Diagnostic d) {
  error(std::move(d));
  stopped_ = true;
}

/// The first error of a text of another kind is told as that.
bool Report::tell_kind(const Diagnostic& d) {
  if (!watched_ || watched_->file != d.span.file) return false;
  const std::optional<OtherKind> kind = other_kind(watched_->text, watched_->macros);
  watched_.reset();
  if (!kind) return false;
  Diagnostic told = problem(Code::kind_other, d.span, "this looks like " + kind->name, kind->help);
  told.notes.push_back(fmt::format("the first mistake here: {}{}{} [{}]", d.message,
                                   d.label.empty() ? "" : ": ", d.label, code_name(d.code)));
  ++told_errors_;
  add(std::move(told));
  stopped_ = true;
  return true;
}

void Report::repeated_warning(Diagnostic d, double size, std::string what, const std::string& subject) {
  if (place_) d.span = *place_;
  ++met_;
  d.severity = Severity::warning;
  const auto [it, is_new] = repeated_.try_emplace({d.code, subject});
  Repeated& kind = it->second;
  // places are remembered as far as those of other warnings; more are counted at each pass
  if (kind.count < kMaxWarnings && !first_time(d)) return;
  if (is_new) {
    take_calls(d);
    kind.first = std::move(d);
  }
  ++kind.count;
  if (!is_new && size <= kind.largest) return;
  kind.largest = size;
  kind.what = std::move(what);
}

void Report::repeated_error(Diagnostic d, const std::string& subject) {
  if (place_) d.span = *place_;
  const auto [it, is_new] = repeated_errors_.try_emplace({d.code, subject});
  Counted& kind = it->second;
  if (is_new) {
    const std::size_t listed = diagnostics_.list().size();
    error(std::move(d));
    if (diagnostics_.list().size() > listed) kind.told = listed + 1;
  } else {
    ++errors_;
    // places are remembered as far as those of warnings; more are counted at each pass
    if (kind.count < kMaxWarnings && !first_time(d)) return;
  }
  ++kind.count;
}

void Report::repeated_note(Diagnostic d, const std::string& key) {
  if (place_) d.span = *place_;
  d.severity = Severity::note;
  Repeated& kind = noted_[key];
  // places are remembered as far as those of warnings; more are counted at each pass
  if (kind.count < kMaxWarnings && !first_time(d)) return;
  if (kind.count++ == 0) kind.first = std::move(d);
}

void Report::warning(Diagnostic d) {
  if (place_) d.span = *place_;
  if (warnings_ > kMaxWarnings) {
    // only counted: remembering their positions would take unbounded memory
    ++warnings_;
    return;
  }
  if (!first_time(d) || ++warnings_ > kMaxWarnings) return;
  d.severity = Severity::warning;
  add(std::move(d));
}

bool Report::first_time(const Diagnostic& d) {
  return told_.emplace(d.code, d.span.file, d.span.line, d.span.column).second;
}

void Report::add(Diagnostic d) {
  take_calls(d);
  diagnostics_.add(std::move(d));
}

void Report::take_calls(Diagnostic& d) const {
  if (chain_ != nullptr && !chain_->empty()) {
    const std::size_t depth = chain_->size();
    const std::size_t half = depth > kMaxCalls ? kMaxCalls / 2 : depth;
    const auto innermost = chain_->rbegin();
    d.calls.assign(innermost, innermost + static_cast<std::ptrdiff_t>(half));
    if (depth > kMaxCalls) {
      d.calls.insert(d.calls.end(), chain_->rend() - static_cast<std::ptrdiff_t>(half), chain_->rend());
      d.calls_left_out = depth - kMaxCalls;
    }
  }
}

void Report::close(Span end) {
  for (auto& [subject, kind] : repeated_) {
    if (kind.count > 1)
      kind.first.notes.push_back(
          fmt::format("{} times in this program{}{}", kind.count, kind.what.empty() ? "" : "; ", kind.what));
    diagnostics_.add(std::move(kind.first));
  }
  for (const auto& [subject, kind] : repeated_errors_)
    if (kind.count > 1 && kind.told > 0)
      diagnostics_.add_note(kind.told - 1, fmt::format("{} times in this program", kind.count));
  for (auto& [key, kind] : noted_) {
    if (kind.count > 1) kind.first.notes.push_back(fmt::format("{} times in this program", kind.count));
    diagnostics_.add(std::move(kind.first));
  }
  if (warnings_ > kMaxWarnings) diagnostics_.leave_out(Severity::warning, warnings_ - kMaxWarnings, end);
  if (told_errors_ >= kMaxErrors) diagnostics_.stop(end);
}

Diagnostic problem(Code code, Span span, std::string label, std::string help) {
  return {.code = code,
          .severity = Severity::error,
          .span = span,
          .message = std::string(code_entry(code).title),
          .label = std::move(label),
          .notes = {},
          .help = std::move(help)};
}

std::string figure(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

}  // namespace kadr::gcode
