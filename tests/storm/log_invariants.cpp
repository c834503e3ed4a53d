#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "emulator/cycle/session.h"
#include "emulator/log/log_info.h"
#include "emulator/log_tools/diff/diff.h"
#include "machine/step_hash.h"
#include "tests/storm/draw.h"
#include "tests/storm/invariants.h"

namespace kadr::storm {
namespace {

Finding found(Invariant invariant, std::string text) { return {invariant, std::move(text)}; }

std::string where_texts_part(const std::string& a, const std::string& b) {
  std::size_t at = 0;
  while (at < a.size() && at < b.size() && a[at] == b[at]) ++at;
  return fmt::format("{} and {} bytes, the first difference at byte {}", a.size(), b.size(), at);
}

bool same_pulses(const AxisPulses& a, const AxisPulses& b) {
  return a.offset_ticks == b.offset_ticks && (a.count() == 0 || a.first_sign == b.first_sign) &&
         a.reversals == b.reversals;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// What a log holds, control tick by control tick, beside the tape of its run.
class LogBesideTape {
 public:
  LogBesideTape(const FinishedRun& run) : run_(run) {}

  Verdict check(const std::string& path, const log::LogHeader& header) {
    auto reader = log::LogReader::open(path);
    if (!reader) return found(Invariant::log_proved, "the log can't be read again");
    for (log::LogMessage message; !wrong_ && reader->next(message);) {
      if (const auto* ticks = std::get_if<log::TickBlock>(&message)) compare(*ticks);
      if (const auto* steps = std::get_if<log::StepBlock>(&message)) compare(*steps);
    }
    if (!wrong_ && header.logs_ticks && ticks_ != run_.tape.size()) tell("control ticks", ticks_);
    if (!wrong_ && header.logs_steps && steps_ != run_.tape.size()) tell("control ticks of pulses", steps_);
    return wrong_;
  }

 private:
  void tell(const std::string& what, std::size_t tick) {
    wrong_ = found(Invariant::log_proved, fmt::format("{} at control tick {} of {} are not those of the run",
                                                      what, tick, run_.tape.size()));
  }
  void compare(const log::TickBlock& block) {
    for (std::size_t i = 0; i < block.size() && !wrong_; ++i, ++ticks_) {
      if (ticks_ >= run_.tape.size()) return tell("ticks", ticks_);
      const TapeTick& tape = run_.tape[ticks_];
      for (std::size_t a = 0; a < block.axis.size(); ++a) {
        const log::AxisTicks& axis = block.axis[a];
        if (axis.steps[i] != tape.position[a].value) return tell("positions", ticks_);
        if (!same_bits(axis.command_u[i], tape.batch.axis[a].command.position_end_u))
          return tell("commands", ticks_);
        if (tape.axis.empty()) continue;
        const AxisState& s = tape.axis[a];
        if (!same_bits(axis.base_u[i], s.base_u) || !same_bits(axis.base_u_s[i], s.base_u_s) ||
            !same_bits(axis.link_u[i], s.link_u) || !same_bits(axis.link_u_s[i], s.link_u_s) ||
            !same_bits(axis.motor_force_N[i], s.motor_force_N))
          return tell("states", ticks_);
      }
    }
  }
  void compare(const log::StepBlock& block) {
    for (std::size_t i = 0; i < block.batches.size() && !wrong_; ++i, ++steps_) {
      if (steps_ >= run_.tape.size()) return tell("pulses", steps_);
      for (std::size_t a = 0; a < block.batches[i].axis.size(); ++a)
        if (!same_pulses(block.batches[i].axis[a], run_.tape[steps_].batch.axis[a]))
          return tell("pulses", steps_);
    }
  }

  const FinishedRun& run_;
  std::size_t ticks_ = 0, steps_ = 0;
  Verdict wrong_;
};

}  // namespace

Verdict check_threads(const PreparedCase& prepared, const FinishedRun& run, const std::string& scratch) {
  const FinishedRun two = run_case(prepared, scratch + "/threads.lcmlog", 2);
  const std::string a = read_file(run.log_path), b = read_file(two.log_path);
  if (a == b) return {};
  return found(Invariant::threads_equal, where_texts_part(a, b));
}

Verdict check_log(const PreparedCase& prepared, const FinishedRun& run) {
  const auto info = log::log_info(run.log_path);
  if (!info) return found(Invariant::log_proved, info.error().reason);
  if (info->end.state != log::LogState::complete)
    return found(Invariant::log_proved,
                 fmt::format("the log is {}: {}", log::log_state_name(info->end.state), info->end.detail));
  if (!info->content_hash_agrees().value_or(false))
    return found(Invariant::log_proved, "the hash of its messages does not agree");
  if (info->header.logs_steps && !info->steps_hash_agrees().value_or(false))
    return found(Invariant::log_proved, "the hash of its pulses does not agree");
  StepHash hash;
  for (const TapeTick& tick : run.tape) hash.add(tick.batch);
  if (hash.digest() != run.summary.steps_hash)
    return found(Invariant::log_proved, "the summary's hash is not that of the pulses");
  std::vector<Steps> at;
  const machine::MachineModel& machine = prepared.given.machine.model;
  for (std::size_t a = 0; a < machine.axis.size(); ++a)
    at.push_back(lattice_node(run.start_u[a], machine.axis[a].step_u));
  for (std::size_t k = 0; k < run.tape.size(); ++k)
    for (std::size_t a = 0; a < at.size(); ++a) {
      at[a] += run.tape[k].batch.axis[a].net_steps();
      if (at[a] != run.tape[k].position[a])
        return found(Invariant::log_proved,
                     fmt::format("axis {} is not where its pulses lead at control tick {}",
                                 machine.axis[a].letter, k));
    }
  return LogBesideTape(run).check(run.log_path, info->header);
}

Verdict check_diff(const FinishedRun& run) {
  const log_tools::DiffOptions options;
  const auto by_tick = log_tools::diff_logs(run.log_path, run.log_path, options);
  if (!by_tick) return found(Invariant::diff_of_itself, by_tick.error().reason);
  if (by_tick->differ() || by_tick->inputs_differ())
    return found(Invariant::diff_of_itself, "by control tick the log differs from itself");
  const auto by_path = log_tools::diff_paths(run.log_path, run.log_path, options);
  // a log without KADR_TICKS has no path
  if (by_path && (by_path->differ() || by_path->inputs_differ()))
    return found(Invariant::diff_of_itself, "by path the log differs from itself");
  return {};
}

Verdict check_same_steps(const FinishedRun& run, const FinishedRun& other) {
  if (!run.whole() || !other.whole()) return {};
  for (std::size_t a = 0; a < run.summary.axis.size(); ++a)
    if (run.summary.axis[a].pulses != other.summary.axis[a].pulses)
      return found(Invariant::same_steps,
                   fmt::format("axis {} has {} pulses under one timeline, {} under another", a,
                               run.summary.axis[a].pulses, other.summary.axis[a].pulses));
  log_tools::DiffOptions options;
  if (auto added = log_tools::add_ignored(options, "feed"); !added)
    return found(Invariant::same_steps, added.error());
  const auto diff = log_tools::diff_paths(run.log_path, other.log_path, options);
  if (!diff) return {};  // the log was asked not to hold what is compared
  if (diff->blocks_differing > 0) {
    const log_tools::BlockDifference& d = *diff->first_block;
    std::string text = fmt::format("block {} of line {} has other steps: {} {}", d.a.block, d.a.span.line,
                                   d.order, d.geometry);
    for (const auto& count : d.counts) text += fmt::format(" {} {} | {}", count.axis, count.a, count.b);
    return found(Invariant::same_steps, text);
  }
  if (diff->event)
    return found(Invariant::same_steps,
                 fmt::format("event {} is \"{}\" under one timeline, \"{}\" under another",
                             diff->event->number, diff->event->a, diff->event->b));
  if (diff->given_up)
    return found(Invariant::same_steps, "the logs are too far apart to compare their steps");
  // the last bit of the path's end may depend on the timeline; its steps do not
  constexpr double kSameEnd = 1e-12;
  if (std::fabs(diff->path_a_u - diff->path_b_u) > kSameEnd * diff->path_a_u)
    return found(Invariant::same_steps,
                 fmt::format("the path is {:.17g} under one timeline, {:.17g} under another", diff->path_a_u,
                             diff->path_b_u));
  return {};
}

Verdict check_replay_of_inputs(const StormCase& storm_case, const FinishedRun& run,
                               const std::string& scratch) {
  const auto reader = log::LogReader::open(run.log_path);
  if (!reader) return found(Invariant::replay_equal, "the log can't be read");
  // what the log holds only by its hash, called files, and the tools, come from the case
  StormCase replayed = storm_case;
  replayed.files[reader->header().program_name] = reader->header().program_text;
  replayed.files[kMachineFile] = reader->header().machine_toml;
  replayed.files[kScenarioFile] = reader->header().scenario_toml;
  const std::string folder = scratch + "/replay";
  write_case(replayed, folder);
  const auto prepared = prepare_case(folder, kScenarioFile);
  if (!prepared->job)
    return found(Invariant::replay_equal, "what a log holds is refused: " + prepared->refusal);
  const FinishedRun again = run_case(*prepared, scratch + "/replay.lcmlog", 1);
  const std::string a = read_file(run.log_path), b = read_file(again.log_path);
  if (a == b) return {};
  return found(Invariant::replay_equal, "the inputs in the log give another one: " + where_texts_part(a, b));
}

Verdict check_live(const PreparedCase& prepared, const FinishedRun& run, std::uint64_t seed) {
  const auto& steps = prepared.given.operator_steps;
  const bool placed =
      std::any_of(steps.begin(), steps.end(), [](const auto& s) { return s.place.has_value(); });
  if (!run.whole() || placed || !prepared.given.most_override) return {};
  cycle::JobInputs given = prepared.given;
  given.operator_steps.clear();
  cycle::PlannedProgram planned = prepared.job->planned;
  planned.step_places_u.clear();
  const cycle::Job job{prepared.sources, given, prepared.job->read, planned};
  cycle::SessionOptions options;
  options.live_operator = true;
  cycle::Session session(job, nullptr, options);
  Draw draw(seed);
  const auto advance = [&](std::int64_t ticks) {
    return session.advance(ControlTicks{ticks}).has_value() && !session.ended();
  };
  bool on = true;
  for (const cycle::OperatorStep& step : steps) {
    if (!on) break;
    if (step.tick > session.ticks()) on = advance(step.tick.value - session.ticks().value);
    if (on && !session.operate(step))
      return found(Invariant::live_equal, "a step of the timeline is refused of a live operator");
  }
  // a hold that nothing releases does not end a live run
  while (on && session.ticks() < run.summary.control_ticks) on = advance(draw.whole(1, 60));
  auto summary = session.finish();
  if (!summary) return found(Invariant::live_equal, summary.error().what);
  if (summary->steps_hash == run.summary.steps_hash && summary->control_ticks == run.summary.control_ticks)
    return {};
  return found(Invariant::live_equal,
               fmt::format("{} control ticks and steps {:016x} live, {} and {:016x} by the timeline",
                           summary->control_ticks.value, summary->steps_hash, run.summary.control_ticks.value,
                           run.summary.steps_hash));
}

}  // namespace kadr::storm
