#include "emulator/text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/base/terminal_text.h"
#include "machine/base/utf8.h"

namespace kadr::text {
namespace {

/// Puts a space between groups of three digits before the decimal point.
std::string with_groups(std::string digits) {
  std::size_t begin = 0;
  while (begin < digits.size() && (digits[begin] < '0' || digits[begin] > '9')) ++begin;
  std::size_t end = begin;
  while (end < digits.size() && digits[end] >= '0' && digits[end] <= '9') ++end;
  for (std::size_t at = end; at > begin + 3; at -= 3) digits.insert(at - 3, 1, ' ');
  return digits;
}

}  // namespace

std::string grouped(std::int64_t value) { return with_groups(fmt::format("{}", value)); }

std::string counted(std::int64_t n, std::string_view one, std::string_view plural) {
  std::string text = grouped(n) + ' ';
  if (n == 1) return text.append(one);
  return plural.empty() ? text.append(one) + 's' : text.append(plural);
}
std::string grouped_signed(std::int64_t value) { return value > 0 ? "+" + grouped(value) : grouped(value); }

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text[0] == '-' && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
  return with_groups(text);
}

std::string significant(double value) {
  const double size = std::fabs(value);
  if (!std::isfinite(value) || size == 0) return fixed(value, 0);
  if (size < 1e-4 || size >= 1e6) return fmt::format("{:.3e}", value);
  int decimals = 3;
  for (double scale = 10; decimals > 0 && size >= scale; scale *= 10) --decimals;
  for (double scale = 1; decimals < 7 && size < scale; scale /= 10) ++decimals;
  return fixed(value, decimals);
}

std::string bytes_text(std::int64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  auto size = static_cast<double>(bytes);
  const char* unit = "B";
  for (const char* next : {"kB", "MB", "GB", "TB"}) {
    // 999.95 would round to "1000.0"
    if (size < 999.95) break;
    size /= 1000;
    unit = next;
  }
  return fmt::format("{:.1f} {}", size, unit);
}

std::string duration_text(double time_s) {
  if (!(time_s < 59.9995)) {
    if (!std::isfinite(time_s)) return fixed(time_s, 0) + " s";
    if (time_s < 3599.95) {
      const auto tenths = static_cast<std::int64_t>(time_s * 10 + 0.5);
      return fmt::format("{} min {:02}.{} s", tenths / 600, tenths % 600 / 10, tenths % 10);
    }
    const auto seconds = static_cast<std::int64_t>(time_s + 0.5);
    return fmt::format("{} h {:02} min {:02} s", grouped(seconds / 3600), seconds % 3600 / 60, seconds % 60);
  }
  return fixed(time_s, 3) + " s";
}

std::size_t display_width(std::string_view text) {
  std::size_t cells = 0;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    cells += static_cast<std::size_t>(kadr::display_width(c.value));
    at += c.bytes;
  }
  return cells;
}

std::string one_line(std::string_view text, std::size_t most) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  // a line of any length, of which little is shown
  constexpr std::size_t kBytesPerCell = 16;
  const bool longer = text.size() / kBytesPerCell > most;
  if (longer) text = text.substr(0, most * kBytesPerCell);
  std::size_t column = 0;
  std::string line = displayable(text, column);
  if (column <= most) return longer ? line + "..." : line;
  std::size_t kept = 0, cells = 0;
  while (kept < line.size()) {
    const CodePoint c = decode_utf8(line, kept);
    cells += static_cast<std::size_t>(kadr::display_width(c.value));
    if (cells + 3 > most) break;
    kept += c.bytes;
  }
  line.erase(line.find_last_not_of(' ', kept > 0 ? kept - 1 : 0) + 1);
  return line + "...";
}

std::string pad_left(std::string_view text, std::size_t width) {
  const std::size_t cells = display_width(text);
  return std::string(width > cells ? width - cells : 0, ' ') + std::string(text);
}

std::string pad_right(std::string_view text, std::size_t width) {
  const std::size_t cells = display_width(text);
  return std::string(text) + std::string(width > cells ? width - cells : 0, ' ');
}

TextTable::TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {
  for (Column& column : columns_) column.title = displayable(column.title);
}

void TextTable::add(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = displayable(cell);
  rows_.push_back(std::move(cells));
}

std::string TextTable::render(std::string_view indent, std::string_view gap) const {
  std::vector<std::size_t> width;
  for (const Column& c : columns_) width.push_back(display_width(c.title));
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size() && i < width.size(); ++i)
      // the last cell of a short row may run on across the columns that the row lacks
      if (row.size() == columns_.size() || i + 1 < row.size())
        width[i] = std::max(width[i], display_width(row[i]));

  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text(indent);
    for (std::size_t i = 0; i < cells.size() && i < width.size(); ++i) {
      if (i > 0) text += gap;
      text +=
          columns_[i].align == Align::right ? pad_left(cells[i], width[i]) : pad_right(cells[i], width[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + '\n';
  };
  std::vector<std::string> titles;
  for (const Column& c : columns_) titles.push_back(c.title);
  line(titles);
  for (const auto& row : rows_) line(row);
  return out;
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint c = decode_utf8(text, at);
    const bool forbidden = c.value == 0xFFFD || c.value == 0xFFFE || c.value == 0xFFFF ||
                           (!may_be_shown(c.value) && c.value != '\n' && c.value != '\t');
    switch (c.value) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (forbidden)
          out += "\xEF\xBF\xBD";
        else
          out += text.substr(at, c.bytes);
    }
    at += c.bytes;
  }
  return out;
}

}  // namespace kadr::text
