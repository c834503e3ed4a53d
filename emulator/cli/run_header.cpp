#include "emulator/cli/run_header.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "machine/base/hash.h"
#include "machine/base/parse_number.h"

namespace kadr::cli {
namespace {

/// The lines without their comments: these name files as the user gave them, and equal inputs give equal logs
/// wherever they are.
std::string without_comments(std::string_view toml) {
  std::string out;
  while (!toml.empty()) {
    const auto end = toml.find('\n');
    std::string_view line = toml.substr(0, end);
    toml.remove_prefix(end == std::string_view::npos ? toml.size() : end + 1);
    bool quoted = false;
    std::size_t kept = 0;
    for (; kept < line.size() && (quoted || line[kept] != '#'); ++kept)
      if (line[kept] == '"') quoted = !quoted;
    line = line.substr(0, kept);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    out += line;
    out += '\n';
  }
  return out;
}

/// "10, 10, -30, 0, ..."
std::string numbers(const AxisValues& values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + number_text(value);
  return out;
}

/// A name in quotes of TOML: bytes that are no plain characters as %41.
std::string quoted_name(std::string_view name) {
  std::string out = "'";
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7F || c == '\'' || c == '%')
      out += fmt::format("%{:02x}", byte);
    else
      out += c;
  }
  return out + "'";
}

/// Codes that are passed over besides those of the machine file, and what #<_hal[...]> and #<_ini[...]> read.
std::string machine_values(const gcode::Reading& reading) {
  std::string out, list;
  for (const machine::CodeName& code : reading.ignored)
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", machine::code_text(code));
  if (!list.empty()) out += fmt::format("ignore = [{}]\n", list);
  for (const gcode::HalValue& value : reading.hal)
    out += fmt::format("[[hal]]\nname = {}\nvalue = {}\n", quoted_name(value.name), number_text(value.value));
  if (!reading.ini) return out;
  for (const gcode::IniValue& value : reading.ini->values)
    if (const auto number = gcode::ini_number(value.text))
      out += fmt::format("[[ini]]\nname = {}\nvalue = {}\n",
                         quoted_name("[" + value.section + "]" + value.name), number_text(*number));
  return out;
}

}  // namespace

log::ReadFile read_file(std::string role, const InputFile& file, std::string_view text) {
  Hash64 content;
  content.bytes(text.data(), text.size());
  return {std::move(role), file.name(), text.size(), content.digest()};
}

log::RunHeader run_header(const cycle::Job& job, const cycle::RunOptions& options,
                          const std::string& scenario_toml, std::vector<log::ReadFile> files) {
  log::RunHeader header;
  const SourceText& program = job.sources[job.given.program];
  header.program_name = InputFile(program.name()).name();
  header.program_text = program.text();
  header.machine_toml = job.given.machine.text;
  header.scenario_toml = scenario_toml;
  header.settings_toml = without_comments(machine::render_machine(job.given.machine));
  header.settings_toml += fmt::format("[run]\nplant = {}\n", options.plant);
  if (options.until_s != machine::kInfinity)
    header.settings_toml += fmt::format("until_s = {}\n", options.until_s);
  if (job.given.reading.block_delete) header.settings_toml += "block_delete = true\n";
  if (job.given.reading.from_line)
    header.settings_toml += fmt::format("from_line = {}\n", *job.given.reading.from_line);
  if (job.given.reading.to_line)
    header.settings_toml += fmt::format("to_line = {}\n", *job.given.reading.to_line);
  if (job.given.reading.dialect != gcode::Dialect::linuxcnc)
    header.settings_toml +=
        fmt::format("dialect = \"{}\"\n", gcode::kDialects.word(job.given.reading.dialect));
  for (const gcode::WorkOffset& offset : job.given.reading.work_offsets)
    header.settings_toml +=
        fmt::format("[[offset]]\nsystem = {}\nzero_u = [{}]\n", offset.system, numbers(offset.zero_u));
  if (job.given.reading.tools)
    header.settings_toml +=
        fmt::format("tools = \"\"\"\n{}\"\"\"\n", gcode::render_tool_table(*job.given.reading.tools));
  header.settings_toml += machine_values(job.given.reading);
  for (const std::uint32_t file : job.read.called_files) {
    const SourceText& called = job.sources[file];
    files.push_back(read_file("called", called.name(), called.text()));
    header.settings_toml +=
        fmt::format("[[called]]\nfile = \"{}\"\nhash = \"{:016x}\"\n", files.back().name, files.back().hash);
  }
  header.files = std::move(files);
  header.machine = &job.given.machine.model;

  Hash64 hash;
  for (const std::string* text :
       {&header.program_text, &header.machine_toml, &header.scenario_toml, &header.settings_toml}) {
    hash.integer(static_cast<std::int64_t>(text->size()));
    hash.bytes(text->data(), text->size());
  }
  header.inputs_hash = hash.digest();
  return header;
}

}  // namespace kadr::cli
