#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/emulator.h"
#include "machine/base/confinement.h"

/// Scenarios: a program, a machine and the expected results. The same cases serve tests, benchmarks, demos and
/// documents.
///
/// A scenario is a folder with a scenario.toml; scenarios/README.md has its keys.
namespace kadr::scenario {

/// Least and most of a measured value, axis units (mm or deg).
struct ValueRange {
  double least_u = 0;
  double most_u = 0;
};

struct AxisExpectation {
  char letter = 'X';
  std::optional<std::int64_t> pulses;     ///< counted, both directions
  std::optional<std::int64_t> end_steps;  ///< lattice node at the end, from machine zero
  std::optional<ValueRange> vibration;    ///< AxisSummary::peak_vibration_u
  std::optional<ValueRange> residual;     ///< AxisSummary::residual_u
};

/// Least and most of a signal over control ticks that end in (from_s, to_s].
struct SignalExpectation {
  std::string signal;  ///< signals.h
  double from_s = 0;
  double to_s = machine::kInfinity;
  double least = -machine::kInfinity;
  double most = machine::kInfinity;
  Span span;  ///< of the name
};

/// Where one block ends and the next begins.
struct BoundaryExpectation {
  std::int64_t block = 0;         ///< that begins, counted from 0
  std::int64_t control_tick = 0;  ///< in which it begins
  std::int64_t offset = 0;        ///< base ticks since that control tick's beginning
  double feed_u_s = 0;            ///< to 1e-4
  double planned_u_s = 0;         ///< F_KK at 100 %, to 1e-4
  std::int64_t deferred_ticks = 0;
  Span span;  ///< of the table
};

/// Expected results. Errors and alarms that are not listed here always fail the scenario.
struct Expectations {
  std::optional<double> time_s;  ///< machine time of the whole run
  double within_s = 0;           ///< allowed difference of time_s
  std::optional<std::uint64_t> steps_hash;
  std::vector<std::pair<Code, std::int64_t>> alarms;  ///< code and count, ascending
  std::vector<Code> diagnostics;                      ///< errors and warnings of a refused program, in order
  std::vector<AxisExpectation> axis;
  std::vector<SignalExpectation> signals;
  std::vector<BoundaryExpectation> boundaries;
};

/// A step of the timeline: an input of M66 changes, or the operator or the spindle does something.
struct ScenarioStep {
  double at_s = 0;  ///< the time, unless at_tick or place is given
  std::optional<std::int64_t> at_tick;
  std::optional<cycle::PathPlace> place;
  std::optional<cycle::OperatorAction> action;  ///< else an input
  bool analog = false;
  int number = 0;
  double value = 0;
  double for_s = 0;  ///< spindle_load: back to the load before after this time; 0: it stays
  Span span;         ///< of the time or place
};

/// A technology point: where an output changes, where the first motion of a line begins, or at a length of the path.
struct ScenarioTechnology {
  machine::TechnologyRule rule;  ///< of a line or length, only its limit
  std::optional<std::uint32_t> line;
  std::optional<double> path_u;
  Span span;
};

/// A scenario file as read; nothing of it has run.
struct Scenario {
  std::string file;      ///< path of scenario.toml as given
  InputFolders folders;  ///< below which program, machine and tools lie
  std::string text;      ///< scenario.toml as read
  std::string name;
  std::string summary;
  std::string program_name;       ///< file name without folders; "wind_hoop.ngc" of a generated one
  std::string program_file;       ///< as written; empty if the program is generated
  std::string generated_program;  ///< text of a generated program
  std::string machine;            ///< name of a shipped machine, or a file as written
  bool machine_is_file = false;
  std::string tools_file;  ///< tool table as written, empty: none
  gcode::Dialect dialect = gcode::Dialect::linuxcnc;
  std::optional<std::uint32_t> from_line, to_line;  ///< as gcode::Reading has them
  std::string ini_file;                             ///< INI file as written, empty: none
  std::vector<machine::CodeName> ignored;           ///< codes that are passed over
  std::vector<gcode::HalValue> hal;                 ///< values of HAL pins
  std::vector<std::string> settings;                ///< "key=value"
  std::optional<double> most_override;              ///< JobInputs::most_override
  std::vector<ScenarioStep> steps;
  std::vector<ScenarioTechnology> technology;
  Expectations expect;

  /// A file that it names.
  InputFile input(const std::string& named) const { return {named, folders}; }
};

/// Reads a scenario file. All its mistakes are reported at once; unknown keys are errors.
/// @param sources  the text is added here, so that diagnostics can be rendered
/// @param file     scenario.toml, or its folder
/// @param allowed  folders below which its files may lie, too (--allow)
/// @return the scenario, or the diagnostics
/// @throws std::system_error if the file can't be opened
tl::expected<Scenario, Diagnostics> read_scenario(const InputFile& file, SourceSet& sources,
                                                  const std::vector<std::string>& allowed = {});
/// The same of a text, named as its file is.
tl::expected<Scenario, Diagnostics> read_scenario(SourceText text, SourceSet& sources,
                                                  const std::vector<std::string>& allowed = {});

/// Opens program, machine and tool table of a scenario as inputs of prepare(). Diagnostics of
/// machine file and tool table are added.
/// @return false if there were errors
/// @throws std::system_error if a file can't be opened
bool open_job(const Scenario& scenario, cycle::JobInputs& given, SourceSet& sources,
              Diagnostics& diagnostics);

/// Puts the steps of a scenario on the control ticks of the job's machine; a time between two ticks is an
/// error. Steps at a position on the path keep it until prepare() knows the path.
/// @param file  of the scenario's text in the sources
void place_inputs(const Scenario& scenario, std::uint32_t file, cycle::JobInputs& given,
                  Diagnostics& diagnostics);

/// One compared value.
struct ScenarioCheck {
  std::string what;      ///< "time", "pulses X", "steps hash", "alarms", "diagnostics", ...
  std::string expected;  ///< as printed
  std::string measured;
  bool passed = false;
};

struct ScenarioResult {
  std::string name;
  std::string file;
  std::vector<ScenarioCheck> checks;
  std::string failure;      ///< why nothing could be compared: unreadable file, numerical fault; else empty
  std::string diagnostics;  ///< rendered for people; empty if there were none
  std::vector<Code> codes;  ///< of the program's errors and warnings, in order
  std::vector<std::pair<Code, std::int64_t>> alarms;  ///< code and count, ascending
  std::vector<BoundaryExpectation> boundaries;        ///< measured
  std::optional<log::RunSummary> summary;             ///< empty if the program was refused
  double machine_s = 0;                               ///< machine time of the run
  bool passed() const;
};

/// Runs one scenario and compares. Never throws for a fault of the scenario: that becomes `failure`.
/// @param bounds  of the program
ScenarioResult run_scenario(const Scenario& scenario, const cycle::RunOptions& options = {},
                            const gcode::ReadingBounds& bounds = {});
/// The same from a file; one that can't be read is a failed result.
ScenarioResult run_scenario(const InputFile& file, const cycle::RunOptions& options = {},
                            const std::vector<std::string>& allowed = {},
                            const gcode::ReadingBounds& bounds = {});

/// The scenario files under the given paths: a scenario.toml, its folder, or a folder of such folders.
/// Sorted by path; with no paths those under "scenarios". What is found in a folder lies below it, or an allowed one.
/// @throws std::system_error for a path that does not exist or holds no scenario
std::vector<InputFile> find_scenarios(const std::vector<std::string>& paths,
                                      const std::vector<std::string>& allowed = {});

/// One line: "passed  01_first_cut   4.211 s  12 checks", and below a failed one its differences, line by line.
std::string render_result(const ScenarioResult& result);
/// Last line: "8 passed, 1 failed".
std::string render_totals(const std::vector<ScenarioResult>& results);
/// JUnit XML of all results; `time` is machine time, so that equal runs give equal bytes.
std::string render_junit(const std::vector<ScenarioResult>& results);
/// JSON of all results: [{"name":..., "passed":..., "machine_s":..., "checks":[...]}].
std::string render_json(const std::vector<ScenarioResult>& results);

/// scenario.toml with every stated expectation replaced by the measured value (comments and order stay); where
/// [expect] is missing, one is added with time, hash and pulses. Bounds stay: they are a person's judgement.
std::string updated_text(const Scenario& scenario, const ScenarioResult& result);

}  // namespace kadr::scenario
