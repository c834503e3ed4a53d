#include "gcode/read/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace kadr::gcode {
namespace {

// texts up to here stay parsed once they were read as a whole
constexpr std::size_t kKeptBytes = 1U << 20;

/// Length of a UTF-8 byte order mark at the beginning of a text: editors add it, it means nothing.
std::size_t byte_order_mark(std::string_view text) { return text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0; }

/// The first thing on a line after everything that may precede an O word: blanks, comments, / and N words.
enum class LineHead : std::uint8_t { nothing, o_word, other };

LineHead head_of(std::string_view line) {
  std::size_t at = byte_order_mark(line);
  while (at < line.size()) {
    const char c = upper(line[at]);
    if (is_blank(c) || c == '/' || c == '%') {
      ++at;
    } else if (c == 'O') {
      return LineHead::o_word;
    } else if (c == ';') {
      return LineHead::nothing;
    } else if (c == '(') {
      at = line.find(')', at);
      if (at == std::string_view::npos) return LineHead::other;
      ++at;
    } else if (c == 'N') {
      at = line.find_first_not_of("0123456789.+- \t\r", at + 1);
      if (at == std::string_view::npos) return LineHead::nothing;
      // only the parser knows where the value of N ends
      const bool computed = line[at] == '[' || line[at] == '#';
      if (computed && line.find_first_of("Oo", at) != std::string_view::npos) return LineHead::o_word;
      if (computed) return LineHead::other;
    } else {
      return LineHead::other;
    }
  }
  return LineHead::nothing;
}

}  // namespace

Program::Program(const SourceSet& sources, std::uint32_t file, const ReadingBounds& bounds, Names& names,
                 Report& report, Dialect dialect)
    : text_(sources[file].text()),
      file_(file),
      line_bytes_(bounds.line_bytes),
      parser_(names, report, dialect),
      report_(report) {}

const Line* Program::next() {
  if (kept_.empty()) return read(line_) ? &line_ : nullptr;
  if (at_.line > kept_.size()) return nullptr;
  return &kept_[at_.line++ - 1];
}

void Program::rewind() {
  at_ = {};
  parser_.mute(true);
  if (text_.size() > kKeptBytes) return;
  while (read(line_)) kept_.push_back(line_);
  at_ = {};
}

bool Program::has_o_words() const {
  bool at_head = true;
  for (std::size_t at = 0; at < text_.size();) {
    const auto* newline = static_cast<const char*>(std::memchr(text_.data() + at, '\n', text_.size() - at));
    const std::size_t end = newline ? static_cast<std::size_t>(newline - text_.data()) : text_.size();
    const LineHead head = head_of(text_.substr(at, end - at));
    if (head == LineHead::o_word && !at_head) return true;
    if (head == LineHead::o_word) {
      // a number alone at the beginning names the program, as on a Fanuc control
      std::string_view rest = text_.substr(at, end - at);
      rest.remove_prefix(rest.find_first_of("Oo") + 1);
      const auto letter =
          std::find_if(rest.begin(), rest.end(), [](char c) { return !is_digit(c) && !is_blank(c); });
      if (letter != rest.end() && *letter != '(' && *letter != ';') return true;
    }
    if (head != LineHead::nothing) at_head = false;
    at = end + 1;
  }
  return false;
}

bool Program::read(Line& line) {
  if (at_.offset >= text_.size()) return false;
  const char* begin = text_.data() + at_.offset;
  const std::size_t left = text_.size() - at_.offset;
  const auto* newline = static_cast<const char*>(std::memchr(begin, '\n', left));
  std::size_t length = newline ? static_cast<std::size_t>(newline - begin) : left;
  const std::size_t whole = newline ? length + 1 : length;
  if (length > 0 && begin[length - 1] == '\r') --length;
  line.file = file_;
  line.number = at_.line;
  line.text = text_.substr(at_.offset, length);
  line.ending = text_.substr(at_.offset + length, whole - length);
  at_.offset += whole;
  ++at_.line;
  if (line_bytes_ != 0 && length > line_bytes_) {
    parser_.leave_unread(line);
    Diagnostic d = problem(Code::line_too_long, line.span({0, 1}), fmt::format("{} bytes", length));
    d.notes.push_back(fmt::format("allowed: {} (--limit line_bytes=N)", line_bytes_));
    report_.error(std::move(d));
    return true;
  }
  parser_.parse(line, line.number == 1 ? byte_order_mark(line.text) : 0);
  return true;
}

}  // namespace kadr::gcode
