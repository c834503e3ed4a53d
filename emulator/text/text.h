#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Numbers and tables for people: dot as decimal sign, a space between thousands, whatever the locale.
namespace kadr::text {

/// "38 412", "-1 190"
std::string grouped(std::int64_t value);
/// "1 block", "38 412 blocks"; `plural` where adding an s is wrong: "2 axes".
std::string counted(std::int64_t n, std::string_view one, std::string_view plural = {});
/// "+38 412"; zero has no sign
std::string grouped_signed(std::int64_t value);
/// Fixed decimals with grouped thousands: "1 942.113"; never "-0.000". Not finite: "inf", "-inf", "nan".
std::string fixed(double value, int decimals);
/// About four significant digits, no exponent between 1e-4 and 1e6: "0.3120", "31.20", "214.0".
std::string significant(double value);
/// "812 B", "16.2 MB"; powers of 1000
std::string bytes_text(std::int64_t bytes);
/// "0.044 s", "38.412 s", "12 min 03.4 s", "1 h 02 min 03 s"
std::string duration_text(double time_s);

/// Number of terminal cells of a text as it is shown (machine/base/terminal_text.h).
std::size_t display_width(std::string_view text);
/// The text on one line, as displayable() shows it (machine/base/terminal_text.h); outer blanks are dropped; beyond `most` (>= 3) cells it is cut and ends in "...".
std::string one_line(std::string_view text, std::size_t most);
std::string pad_left(std::string_view text, std::size_t width);   ///< text at the right end
std::string pad_right(std::string_view text, std::size_t width);  ///< text at the left end

/// Text for XML and HTML: markup escaped; whatever XML 1.0 can't hold and a terminal may not be shown (control characters,
/// marks of direction, bytes that are not UTF-8) is replaced.
std::string xml_text(std::string_view text);

/// Columns that align themselves. Cells are added row by row, each as one line that a terminal may be shown; render()
/// pads each column to its widest cell.
class TextTable {
 public:
  enum class Align : std::uint8_t { left, right };
  struct Column {
    std::string title;
    Align align = Align::right;
  };
  explicit TextTable(std::vector<Column> columns);
  /// A row may have fewer cells than columns; a last left-aligned cell beyond the others is never padded.
  void add(std::vector<std::string> cells);
  bool empty() const { return rows_.empty(); }
  /// Title line and rows, each starting with `indent` and ending in '\n'; no trailing blanks.
  std::string render(std::string_view indent = "", std::string_view gap = "  ") const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace kadr::text
