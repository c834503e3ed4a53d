#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/block.h"
#include "gcode/dialect/dialect.h"
#include "gcode/read/ini_file.h"
#include "gcode/read/text_resolver.h"
#include "gcode/read/tool_table.h"
#include "gcode/reading_bounds.h"
#include "machine/base/diagnostic.h"
#include "machine/owner_codes.h"

/// The G-code front end: text -> parse tree (what was written, with spans) -> Blocks (what it means).
/// Dialect: RS-274/NGC. Every mistake of a program is reported in one run; an unknown word is never skipped.
namespace kadr::gcode {

/// Material that a probe meets: the half space below (or above) a plane across one axis, machine coordinates.
struct StockPlane {
  int axis = 2;  ///< program axis
  double position_u = 0;
  bool below = true;  ///< the material lies where the axis reads less
};

/// Reading of an input when M66 ends. `reached` is false if the time ran out.
struct InputReading {
  bool reached = false;
  double value = 0;
};

inline constexpr int kPlainWorkSystems = 9;  ///< G54 .. G59.3

/// Zero point of a work system before the first line.
struct WorkOffset {
  int system = 1;  ///< 1 .. 9: G54 .. G59.3; 10 and on: G54.1 P1 and on
  AxisValues zero_u{};
};

/// The user's options for reading a program, whatever the machine.
struct Reading {
  Dialect dialect = Dialect::linuxcnc;
  bool dialect_said =
      false;  ///< false: of a program with errors is told for which dialect it seems to be written
  bool block_delete = false;  ///< skip lines that begin with '/'
  ReadingBounds bounds;
  std::vector<std::string> sub_folders;  ///< where called files are looked for after the program's own folder
  std::vector<std::string> allowed_folders;  ///< where links beside a program may lead (--allow)
  /// Where called files come from instead, while the program is read; null: from the folders.
  const TextResolver* called_files = nullptr;
  std::optional<ToolTable> tools;  ///< none: tools have no length and no radius
  std::vector<WorkOffset> work_offsets;
  /// Line of the program's own text, from 1, at which the program is entered: what comes before it is run for what it
  /// sets alone. Its blocks are left out, but for those that set what holds; then comes an Approach.
  std::optional<std::uint32_t> from_line;
  /// Line of the program's own text behind which the program ends, the first time that it is run.
  std::optional<std::uint32_t> to_line;
  std::vector<machine::CodeName> ignored;  ///< codes that are passed over, besides those of the machine
  std::optional<IniFile> ini;              ///< --ini: what #<_ini[SECTION]NAME> reads
  std::vector<HalValue> hal;               ///< --hal: what #<_hal[NAME]> reads
};

struct InterpretOptions : Reading {
  std::string axis_letters = "XYZABCUVW";  ///< axes of the machine; a word of another axis is an error
  bool inches = false;                     ///< units at start
  bool units_said = true;  ///< false: a program with lengths before its first G20 or G21 is warned of
  std::string startup;  ///< words that hold before the first line, as of RS274NGC_STARTUP_CODE: modes alone
  AxisValues home{};    ///< machine position at start, mm and deg
  AxisValues g28{};     ///< G28 reference point, machine coordinates
  AxisValues g30{};     ///< G30 reference point, machine coordinates
  /// Axes of an Approach that move together, one group after the other: {"XY", "Z"}. Empty: all but Z together, and Z
  /// last where it goes down, first where it goes up.
  std::vector<std::string> approach;
  machine::OwnerCodes codes;           ///< G and M codes of the machine's owner
  double arc_end_tolerance_mm = 0.01;  ///< docs: PathLimits
  double arc_end_tolerance_relative = 0.001;
  std::optional<StockPlane> stock;  ///< none: a probe meets material at the end of its move
  std::function<InputReading(const InputWait&)> read_input;  ///< asked at M66; none: every input reads 0
};

/// Chooses the dialect by words that one kind of controller alone has, linuxcnc without any, and adds a note that says
/// which was taken and why.
void recognise_dialect(const SourceSet& sources, std::uint32_t file, Reading& reading,
                       Diagnostics& diagnostics);
/// Of a program with errors: adds a note that names the dialect for which it seems to be written, if there is a sign.
void suggest_dialect(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics);

/// Reads and interprets sources[file], handing each Block to `sink` in program order. Streaming: memory does
/// not grow with the program beyond its text. After the first error blocks are still made where possible, so that later
/// mistakes are reported too; the caller moves nothing if diagnostics.has_errors(). The file that ends without
/// M2/M30/% still gets a program_end block.
void interpret(SourceSet& sources, std::uint32_t file, const InterpretOptions& options,
               const std::function<void(const Block&)>& sink, Diagnostics& diagnostics);

/// One line of the canonical trace for a block (without line end), e.g.
/// "STRAIGHT_FEED 10.000000 0.000000 ... @12"; empty if the block is not part of the trace.
/// @param called_file  name of the file that the block stands in, where that is not the program: "... @name:12"
void append_canon(std::string& out, const Block& block, std::string_view called_file = {});

/// Adds a program in its normal form (gcode/format/format.h) to `out`: line for line, with the same meaning.
/// A line that can't be read stays as it is, and its mistake is reported.
/// @return false if there was a mistake
bool format_program(const SourceSet& sources, std::uint32_t file, Diagnostics& diagnostics, std::string& out,
                    const ReadingBounds& bounds = {}, Dialect dialect = Dialect::linuxcnc);

}  // namespace kadr::gcode
