#include "emulator/log_tools/diff/diff_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "emulator/text/text.h"
#include "machine/base/hash.h"
#include "machine/base/parse_number.h"
#include "machine/base/terminal_text.h"

namespace kadr::log_tools {
namespace {

constexpr std::size_t kShownWidth = 48;  // cells of a quoted line

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

std::string in_quotes(std::string_view line) { return "'" + text::one_line(line, kShownWidth) + "'"; }

std::string_view without_indent(std::string_view line) {
  const auto begin = line.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view{} : line.substr(begin);
}

/// "[feed] " of the table that contains a line of a TOML text; of an array's entry with its name:
/// "[axis.plant] of "X" ".
std::string section_of(const std::vector<std::string_view>& lines, std::size_t at) {
  std::string section, name;
  for (std::size_t i = std::min(at, lines.size()); i-- > 0;) {
    const std::string_view line = without_indent(lines[i]);
    if (line.starts_with("name =") && name.empty()) name = text::one_line(line.substr(6), kShownWidth);
    if (!line.starts_with('[')) continue;
    if (section.empty()) section = text::one_line(line, kShownWidth);
    const bool entry = line.starts_with("[[");
    if (entry && !name.empty()) return section + " of " + name + " ";
    // the table of an array's entry is indented or has the array's name before a dot
    if (entry || section.find('.') == std::string::npos) break;
  }
  return section.empty() ? "" : section + " ";
}

/// The first line that differs, and how many more do.
std::string text_difference(std::string_view a, std::string_view b, bool toml) {
  const auto p = lines_of(a), q = lines_of(b);
  const auto line = [](const auto& lines, std::size_t i) {
    return i < lines.size() ? in_quotes(lines[i]) : std::string("(none)");
  };
  std::size_t first = 0;
  while (first < std::min(p.size(), q.size()) && p[first] == q[first]) ++first;
  if (first == p.size() && first == q.size()) return "line ends differ";
  std::string text = toml ? section_of(p, first) : "";
  text += fmt::format("{}{} | {}", toml ? "" : fmt::format("line {}: ", first + 1), line(p, first),
                      line(q, first));
  if (p.size() != q.size()) return text + fmt::format(", {} | {} lines", p.size(), q.size());
  std::size_t more = 0;
  for (std::size_t i = first + 1; i < p.size(); ++i)
    if (p[i] != q[i]) ++more;
  return more == 0 ? text : text + fmt::format(", and {} more", more);
}

InputDifference text_input(const char* name, const std::string& a, const std::string& b) {
  if (a == b) return {name, true, ""};
  if (a.empty() || b.empty()) return {name, false, a.empty() ? "none | there" : "there | none"};
  return {name, false, text_difference(a, b, true)};
}

InputDifference program_input(const log::LogHeader& a, const log::LogHeader& b) {
  if (a.program_hash == b.program_hash && a.program_bytes == b.program_bytes &&
      a.program_text == b.program_text) {
    // the same text under another name moves the same
    if (a.program_name == b.program_name) return {"program", true, ""};
    return {"program", true, fmt::format("other name: {} | {}", a.program_name, b.program_name)};
  }
  if (a.program_text.empty() || b.program_text.empty())
    return {"program", false,
            fmt::format("{} | {} bytes", text::grouped(a.program_bytes), text::grouped(b.program_bytes))};
  return {"program", false, text_difference(a.program_text, b.program_text, false)};
}

InputDifference clock_input(const log::LogHeader& a, const log::LogHeader& b) {
  if (same_clock(a, b)) return {"clock", true, ""};
  const auto text = [](const log::LogHeader& h) {
    return fmt::format("{} Hz, control tick {}", text::grouped(h.base_hz),
                       text::grouped(h.control_tick_ticks));
  };
  return {"clock", false, text(a) + " | " + text(b)};
}

InputDifference axes_input(const log::LogHeader& a, const log::LogHeader& b) {
  const auto text = [](const log::LogHeader& h) {
    std::string list;
    for (const log::LogAxis& axis : h.axis)
      list += fmt::format("{}{} {} {}{}", list.empty() ? "" : ", ", axis.name, number_text(axis.step_u),
                          axis.unit, axis.has_plant ? "" : " (no plant)");
    return list;
  };
  const std::string p = text(a), q = text(b);
  if (p != q) return {"axes", false, p + " | " + q};
  for (std::size_t i = 0; i < a.axis.size(); ++i)
    if (a.axis[i].home_u != b.axis[i].home_u)
      return {"axes", false,
              fmt::format("{} begins at {} | {} {}", a.axis[i].name, number_text(a.axis[i].home_u),
                          number_text(b.axis[i].home_u), a.axis[i].unit)};
  return {"axes", true, ""};
}

InputDifference channels_input(const log::LogHeader& a, const log::LogHeader& b) {
  const auto text = [](const log::LogHeader& h) {
    return h.logs_ticks && h.logs_steps ? "KADR_TICKS and KADR_STEPS"
           : h.logs_ticks               ? "KADR_TICKS"
           : h.logs_steps               ? "KADR_STEPS"
                                        : "events only";
  };
  if (a.logs_ticks == b.logs_ticks && a.logs_steps == b.logs_steps) return {"channels", true, ""};
  return {"channels", false, fmt::format("{} | {}: what one lacks is not compared", text(a), text(b))};
}

}  // namespace

bool same_clock(const log::LogHeader& a, const log::LogHeader& b) {
  return a.base_hz == b.base_hz && a.control_tick_ticks == b.control_tick_ticks;
}

std::vector<InputDifference> compare_inputs(const log::LogHeader& a, const log::LogHeader& b) {
  std::vector<InputDifference> list = {program_input(a, b),
                                       text_input("machine", a.machine_toml, b.machine_toml),
                                       text_input("settings", a.settings_toml, b.settings_toml),
                                       text_input("scenario", a.scenario_toml, b.scenario_toml)};
  const bool same_kadr = a.kadr_version == b.kadr_version;
  list.push_back(
      {"kadr", same_kadr, same_kadr ? "" : in_quotes(a.kadr_version) + " | " + in_quotes(b.kadr_version)});
  list.push_back(clock_input(a, b));
  list.push_back(axes_input(a, b));
  list.push_back(channels_input(a, b));
  return list;
}

std::string ProgramPlace::name() const {
  if (line == 0) return "";
  return file.empty() ? fmt::format("line {} of a called file", line)
                      : fmt::format("{}:{}", displayable(file), line);
}

ProgramPlace place_of(const log::LogHeader& header, std::uint32_t line) {
  if (line == 0) return {};
  std::string_view text = header.program_text;
  for (std::uint32_t n = 1; n < line; ++n) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return {header.program_name, line, ""};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return {header.program_name, line, std::string(text)};
}

ProgramPlace place_of(const log::LogHeader& header, const log::BlockRecord& block) {
  const ProgramPlace place = place_of(header, block.span.line);
  std::string text = block.text;
  if (!text.empty() && text.back() == '\r') text.pop_back();
  if (place.line == 0 || header.program_text.empty() || place.text == text)
    return {place.file, place.line, std::move(text)};
  return {"", place.line, std::move(text)};
}

}  // namespace kadr::log_tools
