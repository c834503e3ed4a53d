#include "gcode/read/ini_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gcode/read/report.h"
#include "gcode/read/scanner.h"
#include "machine/base/parse_number.h"

namespace kadr::gcode {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kLongestName_bytes = 64;  // each value keeps the name of its section

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Reads one file; mistakes go to the list.
class IniReader {
 public:
  IniReader(const SourceText& source, std::uint32_t file, Diagnostics& diagnostics)
      : file_(file), rest_(source.text()), report_(diagnostics) {
    ini_.name = source.name();
  }

  IniFile read() {
    while (!rest_.empty() && !report_.full()) {
      const std::uint32_t first = line_ + 1;
      std::string joined;
      std::string_view line = next();
      while (!line.empty() && line.back() == '\\' && !rest_.empty()) {
        joined += line.substr(0, line.size() - 1);
        line = next();
      }
      joined += line;
      take(trimmed(joined), {file_, first, 1, 1});
    }
    report_.close({file_, std::max(line_, std::uint32_t{1}), 1, 1});
    return std::move(ini_);
  }

 private:
  std::string_view next() {
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  void take(std::string_view line, Span place) {
    if (line.empty() || line.front() == '#' || line.front() == ';') return;
    if (line.front() == '[') {
      const std::size_t close = line.find(']');
      if (close == std::string_view::npos) return refuse(place, "no ] closes the name of the section");
      const std::string_view section = trimmed(line.substr(1, close - 1));
      if (section.size() > kLongestName_bytes) return refuse_length(place, section);
      section_ = section;
      return;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return refuse(place, "neither [SECTION] nor NAME = VALUE");
    const std::string_view name = trimmed(line.substr(0, equals));
    if (name.empty()) return refuse(place, "no name stands before =");
    if (name.size() > kLongestName_bytes) return refuse_length(place, name);
    ini_.values.push_back({section_, std::string(name), std::string(trimmed(line.substr(equals + 1)))});
  }

  void refuse_length(Span place, std::string_view name) {
    Diagnostic d = problem(Code::ini_line, place, fmt::format("a name of {} bytes", name.size()));
    d.notes.push_back(fmt::format("allowed: {}", kLongestName_bytes));
    report_.error(std::move(d));
  }

  void refuse(Span place, std::string label) {
    report_.error(problem(Code::ini_line, place, std::move(label), "write NAME = VALUE"));
  }

  std::uint32_t file_;
  std::string_view rest_;
  Report report_;
  IniFile ini_;
  std::string section_;
  std::uint32_t line_ = 0;
};

}  // namespace

IniFile read_ini_file(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics) {
  return IniReader(sources[file], file, diagnostics).read();
}

std::optional<double> ini_number(std::string_view text) {
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  return parse_number(word);
}

bool is_hal_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) > 0x20 && c != 0x7F && c != '[' && c != ']' && c != '<' &&
           c != '>' && c != '(';
  });
}

bool is_machine_value(std::string_view name) {
  return name.starts_with("_ini[") || name.starts_with("_hal[");
}

}  // namespace kadr::gcode
