#include "emulator/cli/inputs.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace kadr::cli {
namespace {

constexpr std::string_view kDefaultMachine = "mill3";

SourceText open_text(const InputFile& file, std::uint64_t most_bytes) {
  try {
    return SourceText::open(file, most_bytes);
  } catch (const UnreadableText& e) {
    throw WorldError(e.what());
  }
}

std::string shipped_names() {
  std::string names;
  for (const std::string_view name : machine::shipped_machine_names())
    names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

}  // namespace

bool load_machine(const InputFile& name, const std::vector<std::string>& settings, SourceSet& sources,
                  machine::MachineFile& machine, Diagnostics& diagnostics) {
  const InputFile given = name.path.empty() ? InputFile(std::string(kDefaultMachine)) : name;
  const std::string& wanted = given.path;
  const std::string_view shipped = given.folders ? std::string_view() : machine::shipped_machine(wanted);
  struct stat status {};
  if (shipped.empty() && wanted != "-" && ::stat(wanted.c_str(), &status) != 0)
    throw WorldError(fmt::format("machine {}: {}; machines that ship with kadr: {}", wanted,
                                 std::strerror(errno), shipped_names()));
  auto file = machine::read_machine(shipped.empty() ? open_text(given, kMostSettings_bytes)
                                                    : SourceText(wanted + ".toml", std::string(shipped)),
                                    sources, settings);
  if (!file) {
    diagnostics.add(file.error());
    return false;
  }
  machine = std::move(*file);
  return true;
}

std::string machine_text(const std::string& name, const machine::MachineModel& model) {
  if (name.empty()) return model.name + " (shipped, the default; -m names another)";
  if (!machine::shipped_machine(name).empty()) return model.name + " (shipped)";
  return fmt::format("{} ({})", model.name, name);
}

bool load_reading(const Arguments& arguments, std::uint32_t program, SourceSet& sources,
                  gcode::Reading& reading, Diagnostics& diagnostics) {
  return load_reading(arguments, program, {arguments.tools, arguments.ini}, sources, reading, diagnostics);
}

bool load_reading(const Arguments& arguments, std::uint32_t program, const ReadingFiles& files,
                  SourceSet& sources, gcode::Reading& reading, Diagnostics& diagnostics) {
  if (arguments.dialect) reading.dialect = *arguments.dialect;
  reading.dialect_said = arguments.dialect.has_value();
  if (arguments.recognise_dialect) gcode::recognise_dialect(sources, program, reading, diagnostics);
  reading.block_delete = arguments.block_delete;
  reading.bounds = arguments.bounds;
  reading.sub_folders = arguments.sub_folders;
  reading.allowed_folders = arguments.allowed_folders;
  reading.work_offsets = arguments.offsets;
  reading.from_line = arguments.from_line;
  reading.to_line = arguments.to_line;
  reading.ignored = arguments.ignored;
  reading.hal = arguments.hal;
  const std::size_t errors = diagnostics.errors();
  if (!files.tools.path.empty())
    reading.tools =
        gcode::read_tool_table(sources, sources.add(open_text(files.tools, kMostTable_bytes)), diagnostics);
  if (!files.ini.path.empty())
    reading.ini =
        gcode::read_ini_file(sources, sources.add(open_text(files.ini, kMostSettings_bytes)), diagnostics);
  return diagnostics.errors() == errors;
}

std::string file_in_error(const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error && d.span.file < sources.size()) return sources[d.span.file].name();
  return {};
}

void refuse_offsets(const Arguments& arguments, const machine::MachineModel& machine) {
  std::string axes;
  for (const machine::AxisModel& axis : machine.axis) axes += axis.letter;
  for (const gcode::WorkOffset& offset : arguments.offsets)
    for (std::size_t a = 0; a < offset.zero_u.size(); ++a)
      if (offset.zero_u[a] != 0.0 && axes.find(kAxisLetters[a]) == std::string::npos)
        throw WorldError(
            fmt::format("--offset gives {} the zero {:.6g}, and machine {} has no such axis; its axes: {}",
                        kAxisLetters[a], offset.zero_u[a], displayable(machine.name), axes));
}

std::uint32_t load_program(const InputFile& file, const gcode::ReadingBounds& bounds, SourceSet& sources) {
  if (file.path.ends_with(".toml"))
    throw WorldError(
        fmt::format("{}: a TOML file is no program; kadr run -s FILE runs a scenario", file.path));
  try {
    return sources.add(gcode::open_program(file, bounds.file_bytes));
  } catch (const UnreadableText& e) {
    throw WorldError(e.what());
  }
}

std::uint32_t load_settings(const std::string& path, SourceSet& sources) {
  return sources.add(open_text(path, kMostSettings_bytes));
}

std::string program_text(const std::string& path) { return path == "-" ? "standard input" : path; }

std::uint32_t count_lines(std::string_view text) {
  const auto ends = std::count(text.begin(), text.end(), '\n');
  return static_cast<std::uint32_t>(ends) + (text.empty() || text.back() == '\n' ? 0 : 1);
}

bool refused(const Diagnostics& diagnostics, bool strict) {
  return diagnostics.has_errors() || (strict && diagnostics.warnings() > 0);
}

}  // namespace kadr::cli
