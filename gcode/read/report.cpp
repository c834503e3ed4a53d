#include "gcode/read/report.h"

#include <fmt/format.h>

#include <utility>

namespace kadr::gcode {

void Report::error(Diagnostic d) {
  ++errors_;
  if (place_) d.span = *place_;
  if (full() || !first_time(d)) return;
  ++told_errors_;
  d.severity = Severity::error;
  add(std::move(d));
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
  diagnostics_.add(std::move(d));
}

void Report::close(Span end) {
  if (warnings_ > kMaxWarnings) diagnostics_.leave_out(Severity::warning, warnings_ - kMaxWarnings, end);
  if (full()) diagnostics_.stop(end);
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
