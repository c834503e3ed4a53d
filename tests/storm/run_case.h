#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/emulator.h"
#include "emulator/log/forwarding_log.h"
#include "emulator/scenario/scenario.h"
#include "machine/axis_state.h"
#include "machine/step_batch.h"
#include "tests/storm/storm_case.h"

/// Reads, prepares and runs a case as `kadr run -s FOLDER` does, in this process.
namespace kadr::storm {

/// A case that was read from its folder. Stays where it is: the job refers to it.
struct PreparedCase {
  SourceSet sources;
  Diagnostics diagnostics;
  cycle::JobInputs given;
  std::string scenario_toml;
  std::vector<log::ReadFile> files;  ///< that were read, as kadr lists them
  std::string program_name;
  std::optional<cycle::Job> job;        ///< nothing: refused
  double until_s = machine::kInfinity;  ///< of runs that would take too long
  std::string refusal;  ///< "scenario", "machine", "program K2107", "plan K4008"; empty: there is a job
};

/// Every control tick of a run, beside its log.
struct TapeTick {
  StepBatch batch;
  std::vector<AxisState> axis;  ///< [axes]; empty without plant
  std::vector<Steps> position;  ///< [axes] at its end
};

struct FinishedRun {
  std::string log_path;
  std::vector<TapeTick> tape;
  std::vector<double> start_u;  ///< [axes]
  log::RunSummary summary;
  bool whole() const { return summary.outcome == log::Outcome::complete; }
};

/// @param scenario_file  kScenarioFile or kOtherFile of the folder
/// @throws BrokenPromise, and what else a fault of kadr throws
std::unique_ptr<PreparedCase> prepare_case(const std::string& folder, const std::string& scenario_file);

/// Runs a prepared case into a log.
/// @throws std::runtime_error if the log can't be written
FinishedRun run_case(const PreparedCase& prepared, const std::string& log_path, int threads);

/// What the command answers to the shell.
int exit_code_of(const log::RunSummary& summary);

}  // namespace kadr::storm
