#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/log/forwarding_log.h"
#include "machine/base/vocabulary.h"
#include "machine/machine.h"
#include "plant/plant.h"
#include "tests/storm/run_case.h"

namespace kadr::storm {

/// What holds of every case.
enum class Invariant : std::uint8_t {
  no_broken_promise,
  verify,
  same_steps,
  end_exact,
  threads_equal,
  log_proved,
  diff_of_itself,
  replay_equal,
  live_equal,
  integrators_agree,
  exit_code,
  program_equal,
  whole_or_nothing,
  inputs_unchanged,
  time_bounded,
  memory_bounded,
  no_crash,
  planted,
};
inline constexpr Vocabulary<Invariant, 18> kInvariants{{
    {Invariant::no_broken_promise, "no broken promise", "no promise of kadr's own code is broken"},
    {Invariant::verify, "verify", "verify() finds nothing in the plan, wherever it looks"},
    {Invariant::same_steps, "same steps", "every block has the same step sequence under any timeline"},
    {Invariant::end_exact, "end exact", "a whole run ends on the lattice node of the path's end"},
    {Invariant::threads_equal, "threads equal", "one thread and two write the same log"},
    {Invariant::log_proved, "log proved", "a log is complete, its hashes agree, and it holds what was run"},
    {Invariant::diff_of_itself, "diff of itself", "a log does not differ from itself"},
    {Invariant::replay_equal, "replay equal",
     "the inputs in a log give it again; its pulses give its states"},
    {Invariant::live_equal, "live equal",
     "a live operator's steps give the run of the timeline with the same steps"},
    {Invariant::integrators_agree, "integrators agree", "smooth, reference and oracle give the same states"},
    {Invariant::exit_code, "exit code", "the program ends with 0 1 2 3 130 or 143"},
    {Invariant::program_equal, "program equal",
     "the program writes the library's log, and exit 0 means the whole output"},
    {Invariant::whole_or_nothing, "whole or nothing", "what has its name is whole"},
    {Invariant::inputs_unchanged, "inputs unchanged", "no input is written"},
    {Invariant::time_bounded, "time bounded", "time is bounded by control ticks"},
    {Invariant::memory_bounded, "memory bounded", "memory is bounded"},
    {Invariant::no_crash, "no crash", "no signal ends the process"},
    {Invariant::planted, "planted", "a defect of the self-test: an arc of a radius above 7 mm"},
}};
static_assert(kInvariants.complete());

struct Finding {
  Invariant invariant{};
  std::string text;  ///< one sentence
};
using Verdict = std::optional<Finding>;

// Each looks at one invariant. Files that they write lie in `scratch`, a folder.
Verdict check_verify(const PreparedCase& prepared);
Verdict check_end(const PreparedCase& prepared, const FinishedRun& run);
/// @param other  a run of the same program under another timeline, prepared for the same highest override
Verdict check_same_steps(const FinishedRun& run, const FinishedRun& other);
Verdict check_threads(const PreparedCase& prepared, const FinishedRun& run, const std::string& scratch);
Verdict check_log(const PreparedCase& prepared, const FinishedRun& run);
Verdict check_diff(const FinishedRun& run);
/// The texts in the log's header are a case; its run writes the same log.
Verdict check_replay_of_inputs(const StormCase& storm_case, const FinishedRun& run,
                               const std::string& scratch);
/// The pulses in the log, through a plant of its own, give the states in the log, to the last bit.
Verdict check_replay_of_pulses(const PreparedCase& prepared, const FinishedRun& run);
Verdict check_live(const PreparedCase& prepared, const FinishedRun& run, std::uint64_t seed);
/// @param apart_um  set to the largest distance; stays where there is nothing to compare: no plant, steps lost, many pulses
Verdict check_integrators(const PreparedCase& prepared, const FinishedRun& run,
                          std::optional<double>& apart_um);
Verdict check_planted(const PreparedCase& prepared);

}  // namespace kadr::storm
