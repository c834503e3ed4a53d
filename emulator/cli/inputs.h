#pragma once
#include <string>

#include "emulator/cli/arguments.h"
#include "emulator/cli/console.h"
#include "emulator/emulator.h"
#include "machine/base/confinement.h"

namespace kadr::cli {

/// Reads a machine. An empty name is mill3; a shipped machine's name takes precedence over a file of that
/// name.
/// @param name  with folders only if a file names it; then it is no shipped machine
/// @return false if it has errors (in `diagnostics`)
/// @throws WorldError for a name that is neither, or a file that can't be read
bool load_machine(const InputFile& name, const std::vector<std::string>& settings, SourceSet& sources,
                  machine::MachineFile& machine, Diagnostics& diagnostics);
/// "mill3 (shipped, the default; -m names another)", "shop (shop.toml)"
std::string machine_text(const std::string& name, const machine::MachineModel& model);

/// Files of the machine that a program is read with; an empty path: none.
struct ReadingFiles {
  InputFile tools, ini;
};

/// Reads tool table and INI file and takes over the dialect, if the command line gives them; --dialect auto looks at the
/// program.
/// @param program  its file in the sources
/// @return false if one has errors (in `diagnostics`)
/// @throws WorldError for a file that can't be read
bool load_reading(const Arguments& arguments, std::uint32_t program, SourceSet& sources,
                  gcode::Reading& reading, Diagnostics& diagnostics);
/// The same with files from elsewhere; they are the next files of the sources, in their order.
bool load_reading(const Arguments& arguments, std::uint32_t program, const ReadingFiles& files,
                  SourceSet& sources, gcode::Reading& reading, Diagnostics& diagnostics);
/// The file of the first error.
std::string file_in_error(const Diagnostics& diagnostics, const SourceSet& sources);

/// @throws WorldError if an --offset is that of an axis which the machine lacks; 0 is none
void refuse_offsets(const Arguments& arguments, const machine::MachineModel& machine);

/// Opens a program as a file of the sources: `-` is standard input. TOML is refused by its name.
/// @throws WorldError with path and reason
std::uint32_t load_program(const InputFile& file, const gcode::ReadingBounds& bounds, SourceSet& sources);
/// The same for a machine, scenario or problem file.
std::uint32_t load_settings(const std::string& path, SourceSet& sources);
/// The program's name for people: "standard input" for `-`.
std::string program_text(const std::string& path);
/// Number of lines of a text.
std::uint32_t count_lines(std::string_view text);

/// True if there are errors, or warnings under --strict.
bool refused(const Diagnostics& diagnostics, bool strict);

}  // namespace kadr::cli
