#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emulator/log_tools/export/export.h"

namespace kadr::log_tools {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A text as RFC 4180 has it: in quotes if it holds what would end the field.
std::string field(const std::string& text, char separator) {
  if (text.find_first_of(std::string("\"\r\n") + separator) == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace

void write_csv(LogSamples& log, CsvForm form, const Sink& sink) {
  const bool excel = form == CsvForm::excel;
  const char separator = excel ? ';' : ',';
  std::string line(excel ? kByteOrderMark : std::string_view{});
  line += "t_s";
  for (const Signal& signal : log.chosen()) line += separator + field(signal.name, separator);
  line += '\n';
  sink(line);
  const auto number = [&](double value) {
    const auto begin = static_cast<std::ptrdiff_t>(line.size());
    fmt::format_to(std::back_inserter(line), "{}", value);
    if (excel) std::replace(line.begin() + begin, line.end(), '.', ',');
  };
  for (Sample sample; log.next(sample);) {
    line.clear();
    number(sample.t_s);
    for (const double value : sample.value) {
      line += separator;
      if (std::isfinite(value)) number(value);
    }
    line += '\n';
    sink(line);
  }
}

}  // namespace kadr::log_tools
