#pragma once
#include <memory>
#include <vector>

#include "emulator/emulator.h"
#include "machine/tick_motion.h"

namespace kadr::cycle {

/// A run that its caller advances: so many control ticks at a time, with a live operator if wanted. run() is
/// a loop over it. Neither the size of the portions nor the time between them changes what is run and logged.
class Session {
 public:
  /// Begins the run, at rest at the path's beginning.
  /// @param job  prepared; outlives the session, as do log (may be null) and what options.exit_code refers to
  Session(const Job& job, log::RunLog* log, SessionOptions options = {});
  Session(Session&&) noexcept;
  ~Session();

  /// Advances by up to `n` control ticks. Plant failures are logged and end the run.
  /// @return control ticks made: fewer than n if the run has ended; or an I/O error of the log: call nothing any more
  tl::expected<ControlTicks, RunFailure> advance(ControlTicks n);
  /// Does a step of a live operator: it comes into force with the coming control tick. The same step of a
  /// timeline at that tick gives the same run, if both have the same JobInputs::most_override.
  /// @param step  its tick and position do not count
  /// @return false without SessionOptions::live_operator, and for a feed override above the highest that the run is
  ///         prepared for: nothing changes
  bool operate(const OperatorStep& step);
  /// Ends the run and writes its summary.
  /// @param unfinished  outcome of a run that has not ended yet
  tl::expected<log::RunSummary, RunFailure> finish(log::Outcome unfinished = log::Outcome::interrupted);

  /// The program is at its end, or something has ended the run: an alarm (on_alarm = "stop"), the plant's
  /// numerics, an emergency stop, a hold that no step ends.
  bool ended() const;
  ControlTicks ticks() const;  ///< made so far
  /// Of the last control tick.
  const TickMotion& motion() const;
  const StepBatch& batch() const;
  const std::vector<AxisState>* plant() const;  ///< [axes]; null without plant
  std::uint32_t line() const;                   ///< of the program; 0 where it moves nothing

 private:
  class Cycle;
  std::unique_ptr<Cycle> cycle_;
};

}  // namespace kadr::cycle
