#include "gcode/program.h"

#include <cstring>

namespace kadr::gcode {
namespace {

/// Length of a UTF-8 byte order mark at the head of a text: editors put it there, it means nothing.
std::size_t byte_order_mark(std::string_view text) { return text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0; }

}  // namespace

Program::Program(const SourceSet& sources, std::uint32_t file, Report& report)
    : source_(sources[file]), text_(source_.text()), file_(file), parser_(report) {}

bool Program::next(Line& line) {
  if (at_.offset >= text_.size()) return false;
  let_go_what_was_read();
  const char* begin = text_.data() + at_.offset;
  const std::size_t left = text_.size() - at_.offset;
  const auto* newline = static_cast<const char*>(std::memchr(begin, '\n', left));
  std::size_t length = newline ? static_cast<std::size_t>(newline - begin) : left;
  const std::size_t whole = newline ? length + 1 : length;
  if (newline && length > 0 && begin[length - 1] == '\r') --length;
  line.file = file_;
  line.number = at_.line;
  line.text = text_.substr(at_.offset, length);
  line.ending = text_.substr(at_.offset + length, whole - length);
  at_.offset += whole;
  ++at_.line;
  parser_.parse(line, line.number == 1 ? byte_order_mark(line.text) : 0);
  return true;
}

void Program::let_go_what_was_read() {
  if (at_.offset < held_from_) held_from_ = at_.offset;
  if (at_.offset - held_from_ < SourceText::kWindow_bytes) return;
  source_.let_go(held_from_, at_.offset);
  held_from_ = at_.offset;
}

}  // namespace kadr::gcode
