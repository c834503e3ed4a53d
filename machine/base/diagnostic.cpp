#include "machine/base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "machine/base/terminal_text.h"
#include "machine/base/utf8.h"

namespace kadr {

namespace {

/// Cuts a text that quotes a file, between two code points.
void shorten(std::string& text) {
  if (text.size() <= Diagnostics::kMostText_bytes) return;
  std::size_t end = Diagnostics::kMostText_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  text.shrink_to_fit();
  text += "...";
}

}  // namespace

bool tells_rest(const Diagnostic& d) {
  return d.code == Code::too_many_errors && d.severity == Severity::note;
}

void Diagnostics::add(Diagnostic d) {
  if (d.severity == Severity::error && errors_ - left_out_errors_ >= kMost)
    return leave_out(Severity::error, 1, d.span);
  if (d.severity == Severity::warning && warnings_ - left_out_warnings_ >= kMost)
    return leave_out(Severity::warning, 1, d.span);
  if (d.severity == Severity::error) ++errors_;
  if (d.severity == Severity::warning) ++warnings_;
  for (std::string* text : {&d.message, &d.label, &d.help}) shorten(*text);
  for (std::string& note : d.notes) shorten(note);
  list_.push_back(std::move(d));
}

void Diagnostics::add(const Diagnostics& others) {
  for (const Diagnostic& d : others.list_)
    if (!tells_rest(d)) add(d);
  if (others.rest_ == 0) return;
  const Span at = others.list_[others.rest_ - 1].span;
  leave_out(Severity::error, others.left_out_errors_, at);
  leave_out(Severity::warning, others.left_out_warnings_, at);
  if (others.stopped()) stop(at);
}

void Diagnostics::leave_out(Severity severity, std::size_t count, Span at) {
  if (count == 0 || severity == Severity::note) return;
  (severity == Severity::error ? errors_ : warnings_) += count;
  (severity == Severity::error ? left_out_errors_ : left_out_warnings_) += count;
  tell_rest(at);
}

void Diagnostics::stop(Span at) {
  errors_read_ = errors_;
  tell_rest(at);
}

/// Writes the note, or brings it up to date.
void Diagnostics::tell_rest(Span at) {
  if (rest_ == 0) {
    list_.push_back({.code = Code::too_many_errors,
                     .severity = Severity::note,
                     .span = at,
                     .message = {},
                     .label = {},
                     .notes = {},
                     .help = {}});
    rest_ = list_.size();
  }
  std::string more;
  if (left_out_errors_ > 0) more += fmt::format("{} more errors", left_out_errors_);
  if (left_out_warnings_ > 0)
    more += fmt::format("{}{} more warnings", more.empty() ? "" : " and ", left_out_warnings_);
  Diagnostic& note = list_[rest_ - 1];
  if (!more.empty()) more += " are not shown";
  if (!stopped()) {
    note.message = "more mistakes than are shown";
    note.label = more;
    return;
  }
  note.message = code_entry(Code::too_many_errors).title;
  note.label =
      fmt::format("reading stopped here after {} errors{}{}", errors_read_, more.empty() ? "" : "; ", more);
  note.help = "fix the first ones; later ones often follow from them";
}

void Diagnostics::sort_by_place() {
  std::stable_sort(list_.begin(), list_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    const auto place = [](const Span& s) { return std::tuple(s.file, s.line, s.column); };
    return place(a.span) < place(b.span);
  });
  if (rest_ == 0) return;
  const auto note = std::find_if(list_.begin(), list_.end(), tells_rest);
  rest_ = static_cast<std::size_t>(note - list_.begin()) + 1;
}

namespace {

/// Widest excerpt printed of a source line, in terminal columns; longer lines are cut around the caret.
constexpr std::size_t kExcerpt = 160;

/// Longest label, note or help, in code points: it may quote a word of any length.
constexpr std::size_t kLongestText = 400;

constexpr std::size_t kTab_columns = 8;
constexpr std::size_t kLongestCodePoint_bytes = 4;

/// Calls shown from either end of a long chain.
constexpr std::size_t kCallsShown = 4;

/// Most columns of a code point; a mark that takes none counts too, or a line of them would never end.
std::size_t columns_of(char32_t c) {
  if (c == U'\t') return kTab_columns;
  return static_cast<std::size_t>(std::max(display_width(c), 1));
}

/// Number of bytes at the beginning of a text that fit in that many columns.
std::size_t prefix_bytes(std::string_view text, std::size_t columns) {
  std::size_t at = 0;
  while (at < text.size()) {
    const CodePoint c = decode_utf8(text, at);
    const std::size_t needed = columns_of(c.value);
    if (needed > columns) break;
    columns -= needed;
    at += c.bytes;
  }
  return at;
}

std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    columns += columns_of(c.value);
    at += c.bytes;
  }
  return columns;
}

/// Text that may quote the user's bytes, safe for one line of a terminal.
std::string clean(std::string_view text) {
  std::size_t column = 0;
  const std::size_t kept = text.size() > kLongestText ? prefix_bytes(text, kLongestText) : text.size();
  return displayable(text.substr(0, kept), column) + (kept < text.size() ? "..." : "");
}

std::string message_of(const Diagnostic& d) {
  return clean(d.message.empty() ? code_entry(d.code).title : std::string_view(d.message));
}

/// Terminal styles; all empty when colour is off.
struct Style {
  std::string_view severity, place, bold, off;
};

Style style_of(Severity severity, bool colour) {
  if (!colour) return {};
  std::string_view word;
  switch (severity) {
    case Severity::note:
      word = style::kNote;
      break;
    case Severity::warning:
      word = style::kWarning;
      break;
    case Severity::error:
      word = style::kError;
      break;
  }
  return {word, style::kPlace, style::kBold, style::kOff};
}

/// A source line split at the span: before, at and after the carets.
struct Excerpt {
  std::string_view before, marked, after;
  bool cut_before = false, cut_after = false;
};

Excerpt excerpt(std::string_view line, const Span& span) {
  const std::size_t begin = std::min<std::size_t>(span.column > 0 ? span.column - 1 : 0, line.size());
  const std::size_t length = std::min<std::size_t>(span.length, line.size() - begin);
  Excerpt e{line.substr(0, begin), line.substr(begin, length), line.substr(begin + length)};

  // generated programs have lines of any length: keep what a screen can show around the caret
  if (e.before.size() > kExcerpt * kLongestCodePoint_bytes) {
    e.before.remove_prefix(e.before.size() - kExcerpt * kLongestCodePoint_bytes);
    while (!e.before.empty() && (static_cast<unsigned char>(e.before.front()) & 0xC0U) == 0x80U)
      e.before.remove_prefix(1);
    e.cut_before = true;
  }
  for (std::size_t columns = columns_of(e.before); columns > kExcerpt / 2;) {
    const CodePoint c = decode_utf8(e.before, 0);
    columns -= columns_of(c.value);
    e.before.remove_prefix(c.bytes);
    e.cut_before = true;
  }
  const std::size_t marked = prefix_bytes(e.marked, kExcerpt / 2);
  if (marked < e.marked.size()) {
    e.marked = e.marked.substr(0, marked);
    e.after = {};
    e.cut_after = true;
  }
  const std::size_t after = prefix_bytes(e.after, kExcerpt / 2);
  if (after < e.after.size()) {
    e.after = e.after.substr(0, after);
    e.cut_after = true;
  }
  return e;
}

/// The line, and below it the carets with the label.
void append_excerpt(std::string& out, const Diagnostic& d, std::string_view line, std::size_t gutter,
                    const Style& style) {
  const Excerpt e = excerpt(line, d.span);
  std::size_t column = e.cut_before ? 3 : 0;
  const std::string before = (e.cut_before ? "..." : "") + displayable(e.before, column);
  const std::size_t caret_begin = column;
  const std::string marked = displayable(e.marked, column);
  const std::size_t carets = std::max<std::size_t>(column - caret_begin, 1);
  const std::string after = displayable(e.after, column) + (e.cut_after ? "..." : "");

  const std::string shown = before + marked + after;
  const auto bar = [&](std::string_view head) {
    return fmt::format("{}{:>{}} |{}", style.place, head, gutter, style.off);
  };
  out += bar("") + '\n';
  out += fmt::format("{}{}{}\n", bar(std::to_string(d.span.line)), shown.empty() ? "" : " ", shown);
  out += fmt::format("{} {}{}{}{}{}{}\n", bar(""), std::string(caret_begin, ' '), style.severity,
                     std::string(carets, '^'), d.label.empty() ? "" : " ", clean(d.label), style.off);
  out += bar("") + '\n';
}

/// "part.ngc:42:6", the column counted in code points from 1.
std::string place_text(const Span& span, const SourceSet& sources) {
  return fmt::format("{}:{}:{}", clean(sources[span.file].name()), span.line, place_of(span, sources).column);
}

/// A call as text: the marked part of its line.
std::string call_text(const Span& span, const SourceSet& sources) {
  const Excerpt e = excerpt(sources[span.file].line(span.line), span);
  return clean(e.marked) + (e.cut_after && e.after.empty() ? "..." : "");
}

/// "called from part.ngc:42:1: O100 call [5]" for each call, the middle of many left out.
std::vector<std::string> call_notes(const Diagnostic& d, const SourceSet& sources) {
  std::vector<std::string> notes;
  const std::size_t left_out_here = d.calls.size() > 2 * kCallsShown ? d.calls.size() - 2 * kCallsShown : 0;
  const std::size_t left_out = left_out_here + d.calls_left_out;
  for (std::size_t i = 0; i < d.calls.size(); ++i) {
    const bool middle = left_out_here == 0 ? i == d.calls.size() / 2 : i == kCallsShown;
    if (middle && left_out > 0) {
      notes.push_back(fmt::format("... {} further call{} ...", left_out, left_out == 1 ? "" : "s"));
      i += left_out_here;
    }
    if (!has_place(d.calls[i], sources)) continue;
    notes.push_back(
        fmt::format("called from {}: {}", place_text(d.calls[i], sources), call_text(d.calls[i], sources)));
  }
  return notes;
}

}  // namespace

bool has_place(const Span& span, const SourceSet& sources) {
  return span.line > 0 && span.file < sources.size();
}

Place place_of(const Span& span, const SourceSet& sources) {
  const std::string_view line = sources[span.file].line(span.line);
  const std::size_t begin = std::min<std::size_t>(span.column > 0 ? span.column - 1 : 0, line.size());
  const std::size_t column = count_code_points(line.substr(0, begin)) + 1;
  return {column, column + count_code_points(line.substr(begin, span.length))};
}

std::string render_human(const Diagnostic& d, const SourceSet& sources, bool colour) {
  const Style style = style_of(d.severity, colour);
  std::string out = fmt::format("{}{}[{}]{}{}: {}{}\n", style.severity, kSeverities.word(d.severity),
                                code_name(d.code), style.off, style.bold, message_of(d), style.off);
  std::size_t gutter = 1;
  if (has_place(d.span, sources)) {
    gutter = std::to_string(d.span.line).size();
    out += fmt::format("{:>{}}{}-->{} {}\n", "", gutter, style.place, style.off, place_text(d.span, sources));
    append_excerpt(out, d, sources[d.span.file].line(d.span.line), gutter, style);
  }
  const auto fact = [&](std::string_view kind, std::string_view text) {
    out += fmt::format("{:>{}} {}={} {}{}:{} {}\n", "", gutter, style.place, style.off, style.bold, kind,
                       style.off, clean(text));
  };
  if (!has_place(d.span, sources) && !d.label.empty()) fact("note", d.label);
  for (const std::string& note : d.notes) fact("note", note);
  for (const std::string& call : call_notes(d, sources)) fact("note", call);
  if (!d.help.empty()) fact("help", d.help);
  fact("more", "kadr explain " + code_name(d.code));
  return out;
}

std::string render_gcc(const Diagnostic& d, const SourceSet& sources) {
  std::string out =
      fmt::format("{}: {}: {}{}{} [{}]", has_place(d.span, sources) ? place_text(d.span, sources) : "kadr",
                  kSeverities.word(d.severity), message_of(d), d.label.empty() ? "" : ": ", clean(d.label),
                  code_name(d.code));
  for (const Span& call : d.calls) {
    if (!has_place(call, sources)) continue;
    out +=
        fmt::format("\n{}: note: called from here: {}", place_text(call, sources), call_text(call, sources));
  }
  return out;
}

std::string count_text(std::size_t errors, std::size_t warnings) {
  const auto counted = [](std::size_t n, std::string_view word) {
    return fmt::format("{} {}{}", n, word, n == 1 ? "" : "s");
  };
  if (errors == 0 && warnings == 0) return "no errors";
  if (warnings == 0) return counted(errors, "error");
  if (errors == 0) return counted(warnings, "warning");
  return counted(errors, "error") + ", " + counted(warnings, "warning");
}

}  // namespace kadr
