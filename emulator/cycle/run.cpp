#include "emulator/cycle/log_thread.h"
#include "emulator/cycle/session.h"
#include "emulator/emulator.h"

namespace kadr::cycle {
namespace {

constexpr std::int64_t kProgressTicks = 1000;

void report_progress(const Job& job, const Session& session, const RunOptions& options) {
  const machine::ClockModel& clock = job.given.machine.model.clock;
  const double length_u = job.read.path.length_u();
  const auto base_ticks = static_cast<double>(session.ticks().value * clock.control_tick.value);
  options.progress(length_u > 0 ? session.motion().s_end_u / length_u : 1.0, session.line(),
                   base_ticks / static_cast<double>(clock.base_hz));
}

tl::expected<log::RunSummary, RunFailure> run_session(const Job& job, log::RunLog* log,
                                                      const RunOptions& options) {
  const double tau_s = job.given.machine.model.clock.tau_s();
  Session session(job, log, static_cast<const SessionOptions&>(options));
  while (!session.ended()) {
    if (options.interrupt && options.interrupt->load(std::memory_order_relaxed))
      return session.finish(log::Outcome::interrupted);
    if (static_cast<double>(session.ticks().value) * tau_s >= options.until_s)
      return session.finish(log::Outcome::stopped_by_until);
    if (auto moved = session.advance(ControlTicks{1}); !moved) return tl::unexpected(moved.error());
    if (options.progress && session.ticks().value % kProgressTicks == 0)
      report_progress(job, session, options);
  }
  return session.finish();
}

}  // namespace

tl::expected<log::RunSummary, RunFailure> run(const Job& job, log::RunLog* log, const RunOptions& options) {
  if (log && options.threads > 1) {
    const auto threaded = make_threaded_log(*log);
    return run_session(job, threaded.get(), options);
  }
  return run_session(job, log, options);
}

}  // namespace kadr::cycle
