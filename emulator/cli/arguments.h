#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "emulator/log_tools/diff/diff_options.h"
#include "emulator/log_tools/export/export_options.h"
#include "emulator/studies/point_to_point/point_study.h"
#include "emulator/studies/teach/pulses.h"
#include "gcode/gcode.h"
#include "machine/base/vocabulary.h"
#include "machine/file/data_sheet.h"
#include "machine/infinity.h"
#include "scenarios/generator/wind.h"

namespace kadr::cli {

class Console;
struct Arguments;

/// Does the work of a command (emulator/cli/commands.h).
using Run = int (*)(const Arguments&, Console&);

enum class When : std::uint8_t { automatic, always, never };
inline constexpr Vocabulary<When, 3> kWhens{{
    {When::automatic, "auto", "on a terminal"},
    {When::always, "always"},
    {When::never, "never"},
}};
static_assert(kWhens.complete());

enum class DiagnosticFormat : std::uint8_t { human, gcc, json, sarif };
inline constexpr Vocabulary<DiagnosticFormat, 4> kDiagnosticFormats{{
    {DiagnosticFormat::human, "human", "with the source line and a caret"},
    {DiagnosticFormat::gcc, "gcc", "file:line:column: severity: message"},
    {DiagnosticFormat::json, "json", "one object per line"},
    {DiagnosticFormat::sarif, "sarif", "one SARIF 2.1.0 document"},
}};
static_assert(kDiagnosticFormats.complete());

enum class ProgressMode : std::uint8_t { automatic, never, plain };
inline constexpr Vocabulary<ProgressMode, 3> kProgressModes{{
    {ProgressMode::automatic, "auto", "a bar on a terminal, else a line every 10 s"},
    {ProgressMode::never, "never"},
    {ProgressMode::plain, "plain", "a line every 10 s"},
}};
static_assert(kProgressModes.complete());

/// How a command reports.
struct OutputOptions {
  bool json = false;   ///< one JSON document on standard output
  bool quiet = false;  ///< no notes, no progress, no summary
  When color = When::automatic;
  ProgressMode progress = ProgressMode::automatic;
  DiagnosticFormat format = DiagnosticFormat::human;
  std::optional<std::size_t> max_errors;  ///< diagnostics shown; 0: all. Not given: 20, in SARIF all
};

/// The request to `kadr teach`.
struct TeachArguments {
  studies::TeachOptions options;
  int axes = 2;  ///< of a polyline or Bezier
  studies::PulseTiming timing = studies::PulseTiming::uniform;
  double feed_steps_s = 1000;
  std::string vcd_path;
  bool spacing = false;           ///< a line of times between pulses
  double feed_mm_s = 0;           ///< bezier; 0: not asked
  double acceleration_mm_s2 = 0;  ///< bezier; 0: not given
  bool paper = false;             ///< bezier: t(S) by every method
  std::string page_path = "teach.html";
  std::uint32_t cases = 20'000;  ///< of a sweep
};

/// The formats of `kadr export`.
enum class ExportForm : std::uint8_t { none, csv, excel, json, vcd, svg };

/// Commands that show what is in logs.
struct ExportOptions {
  ExportForm form = ExportForm::none;
  log_tools::SampleChoice choice;
  log_tools::PlotForm plot;
  bool path = false;        ///< plot --path
  std::string output_path;  ///< -o; empty: standard output
  double max_size_mb = 10;  ///< of a report page, MB
  bool plain = false;       ///< a report page without script
};

/// The command line as read. Fields that a command does not have keep their defaults.
struct Arguments {
  Run command = nullptr;
  OutputOptions output;
  /// programs, logs, machine files, scenarios, codes: what the command works on
  std::vector<std::string> files;
  std::string machine;                ///< -m: file or shipped name; empty: the default machine
  std::vector<std::string> settings;  ///< --set key=value
  machine::DataSheetWords sheet;      ///< machine new --axes and the others
  bool ask = false;                   ///< machine new --ask
  std::string tools;                  ///< tool table; empty: none
  std::optional<gcode::Dialect> dialect;
  bool recognise_dialect = false;          ///< --dialect auto
  std::vector<gcode::WorkOffset> offsets;  ///< --offset
  std::optional<std::uint32_t> from_line, to_line;
  std::vector<machine::CodeName> ignored;    ///< --ignore
  std::string ini;                           ///< --ini: INI file; empty: none
  std::vector<gcode::HalValue> hal;          ///< --hal
  gcode::ReadingBounds bounds;               ///< --limit
  std::uint64_t log_bytes = 10'000'000'000;  ///< --limit log_bytes: longest log; 0: no bound
  std::vector<std::string> sub_folders;      ///< --subs
  std::vector<std::string> allowed_folders;  ///< --allow
  std::string scenario;
  std::string log_path;
  std::string wind_kind;
  scenarios::WindSettings wind_settings;
  std::string program_path;  ///< wind -o; empty: standard output
  std::string publish_url;
  bool plant = true;
  bool log = true;
  bool strict = false;
  bool csv = false;
  bool block_delete = false;
  bool list = false;
  bool force = false;
  bool update = false;
  bool only_check = false;  ///< fmt --check
  bool in_place = false;    ///< fmt --in-place
  log_tools::DiffOptions diff;
  std::vector<std::string> methods;  ///< tube --method
  std::string csv_path, page_path;   ///< tube, law --csv, --page
  bool timing = false;               ///< tube --timing
  studies::PointQuestion point;      ///< law
  bool table2 = false;               ///< law --paper
  TeachArguments teach;
  int first_level = 0, last_level = 0;  ///< tube --sweep-levels; 0: no sweep
  std::string junit_path;
  double until_s = machine::kInfinity;
  int threads = 1;
  std::uint32_t first_line = 1;
  std::uint32_t last_line = UINT32_MAX;
  ExportOptions exported;  ///< export, plot, report, compare
};

/// Reads the command line. Help goes to standard output, a complaint to standard error.
/// @return the arguments, or the exit code if there is nothing left to do
std::variant<Arguments, int> read_arguments(int argc, const char* const* argv);

}  // namespace kadr::cli
