#include "emulator/cycle/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "emulator/cycle/block_starts.h"
#include "emulator/cycle/input_timeline.h"
#include "emulator/cycle/monitor/monitor.h"
#include "emulator/cycle/operator/operator_panel.h"
#include "emulator/cycle/operator/operator_watch.h"
#include "emulator/cycle/program_clock.h"
#include "emulator/cycle/record_writer.h"
#include "emulator/cycle/sound_nodes.h"
#include "emulator/cycle/tick_time.h"
#include "emulator/interpolator/interpolator.h"
#include "planner/planner.h"
#include "plant/plant.h"

namespace kadr::cycle {

using planner::LimitedBy;

namespace {

/// The interpolator is checked in every control tick with a multiple of this number: a prime, so that no
/// program repeats itself in step with it.
constexpr ControlTicks kNodeCheckPeriod{127};

bool has_operator(const Job& job, const SessionOptions& options) {
  return options.live_operator || job.given.most_override || !job.given.operator_steps.empty();
}

/// The highest feed override that the run is prepared for.
double prepared_override(const JobInputs& given) {
  return given.most_override.value_or(most_override(given.operator_steps));
}

std::unique_ptr<planner::MotionSource> make_source(const Job& job, const SessionOptions& options) {
  const machine::MachineModel& machine = job.given.machine.model;
  if (!has_operator(job, options)) return std::make_unique<planner::LawSource>(job.planned.plan.law, machine);
  return planner::override_source(job.read.path, job.planned.plan, machine, prepared_override(job.given));
}

std::vector<double> start_u(const Job& job) {
  std::vector<double> position_u;
  for (std::size_t a = 0; a < job.given.machine.model.axis.size(); ++a)
    position_u.push_back(job.read.path.size() > 0 ? job.read.path.node(0)[a]
                                                  : job.given.machine.model.axis[a].home_u);
  return position_u;
}

}  // namespace

/// The run loop's body, control tick after control tick: operator, motion source, interpolator, plant,
/// monitors, log.
class Session::Cycle {
 public:
  Cycle(const Job& job, log::RunLog* log, SessionOptions options)
      : job_(job),
        machine_(job.given.machine.model),
        options_(std::move(options)),
        log_(log, machine_.clock),
        has_operator_(has_operator(job, options_)),
        source_(make_source(job, options_)),
        events_(job.read.path),
        panel_(job.given.operator_steps, job.planned.step_places_u, machine_, events_),
        operator_watch_(job.planned.plan.law, machine_.clock.tau_s(), events_),
        inputs_(job.given.inputs, machine_.clock, events_),
        program_(job.read.events, job.read.path, machine_, events_),
        block_starts_(job),
        interpolator_(job.read.path, machine_),
        monitor_(job.read.path, machine_, events_, block_ends_) {
    batch_.axis.resize(machine_.axis.size());
    const bool has_plant = std::any_of(machine_.axis.begin(), machine_.axis.end(),
                                       [](const machine::AxisModel& a) { return a.has_plant; });
    if (!options_.plant || !has_plant) return;
    plant_.emplace(machine_, plant::PlantOptions{.energy = machine_.log.energy});
    plant_->reset(start_u(job));
    if (machine_.log.energy) energy_.resize(machine_.axis.size());
  }

  bool ended() const { return outcome_ || at_program_end(); }

  /// @pre not ended
  std::optional<RunFailure> advance() {
    ask_source();
    move_interpolator();
    events_.move_to(segment());
    ++ticks_;
    inputs_.tick(motion_.tick);
    block_starts_.tick(motion_);
    program_.tick(motion_);
    if (plant_)
      if (auto moved = plant_->advance(batch_); !moved) return fail(moved.error());
    // pulses of a control tick whose plant failed are in no record
    hash_.add(batch_);
    watch();
    if (motion_.s_end_u > motion_.s_begin_u) {
      ++motion_ticks_;
      if (motion_.s_end_u <= job_.read.path.program_begin_u()) ++approach_ticks_;
    }
    if (auto failure = log_tick()) return failure;
    if (machine_.on_alarm == machine::OnAlarm::stop && monitor_.alarms() > 0)
      outcome_ = log::Outcome::alarm;
    else if (has_operator_)
      outcome_ = ended_by_operator();
    return std::nullopt;
  }

  bool operate(const OperatorStep& step) {
    if (!options_.live_operator) return false;
    if (step.action == OperatorAction::feed_override && step.value > prepared_override(job_.given))
      return false;
    panel_.operate(step);
    return true;
  }

  tl::expected<log::RunSummary, RunFailure> finish(log::Outcome unfinished) {
    if (!outcome_) outcome_ = at_program_end() ? log::Outcome::complete : unfinished;
    monitor_.finish(now());
    if (auto failure = log_happenings()) return tl::unexpected(*failure);
    log::RunSummary made = summary();
    if (auto failure = log_.end(made)) return tl::unexpected(*failure);
    return made;
  }

  ControlTicks ticks() const { return ticks_; }
  const TickMotion& motion() const { return motion_; }
  const StepBatch& batch() const { return batch_; }
  const std::vector<AxisState>* plant() const { return plant_ ? &plant_->state() : nullptr; }
  std::uint32_t line() const { return events_.line(); }

 private:
  bool at_program_end() const { return source_->finished() && program_.finished(now()); }
  Ticks now() const { return begin_of(ticks_, machine_.clock); }
  std::size_t segment() const {
    return job_.read.path.size() == 0 ? 0 : std::min(interpolator_.segment(), job_.read.path.size() - 1);
  }

  /// How the path moves in this control tick, under what the operator asks for.
  void ask_source() {
    if (!has_operator_) {
      motion_ = source_->advance(planner::OperatorInput{});
      return;
    }
    const planner::OperatorInput& input = panel_.advance(ticks_, motion_.s_end_u);
    motion_ = source_->advance(input);
    operator_watch_.tick(motion_, input, panel_.spindle_override(), now());
  }

  void move_interpolator() {
    const bool check = checks_nodes_ && ticks_.value % kNodeCheckPeriod.value == 0;
    batch_.tick = motion_.tick;
    interpolator_.set_self_check(check);
    interpolator_.advance(motion_, batch_);
    if (check) require_sound_nodes(ticks_, interpolator_, job_);
  }

  void watch() {
    for (std::size_t a = 0; a < energy_.size(); ++a) energy_[a] = plant_->energy(static_cast<int>(a));
    monitor_.tick({motion_, batch_, segment(), begin_of(motion_.tick, machine_.clock), now(), plant(),
                   energy_.empty() ? nullptr : &energy_});
    if (plant_) monitor_.lost_steps(plant_->lost_steps(), now());
  }

  /// Why a run under an operator ends before the program does, or nothing.
  std::optional<log::Outcome> ended_by_operator() {
    const double begin_u = job_.read.path.program_begin_u();
    const double at_u = motion_.s_end_u - begin_u, length_u = job_.read.path.length_u() - begin_u;
    if (source_->stopped()) {
      operator_alarm(Code::emergency_stopped, fmt::format("stands at {:.6g} of {:.6g}", at_u, length_u));
      return log::Outcome::emergency_stop;
    }
    const bool held = motion_.limited_by == LimitedBy::hold && motion_.speed_end_u_s == 0 &&
                      motion_.s_end_u == motion_.s_begin_u;
    // a live operator may still end it
    if (!held || options_.live_operator || !panel_.at_its_end()) return std::nullopt;
    operator_alarm(Code::held_to_the_end,
                   fmt::format("held at {:.6g} of {:.6g}, and no step releases it", at_u, length_u));
    return log::Outcome::held;
  }
  void operator_alarm(Code code, std::string text) {
    events_.alarm(now(), code, motion_.s_end_u, job_.read.path.length_u(), std::move(text));
    ++end_alarms_;
  }

  std::optional<RunFailure> fail(const plant::PlantError& error) {
    log::EventRecord e;
    e.tick = now();
    e.kind = log::EventKind::alarm;
    e.code = Code::plant_numerics;
    e.axis = error.axis;
    e.text = fmt::format("{}: {}", error.flag, error.detail);
    if (job_.read.path.size() > 0) e.span = job_.read.path.segments[segment()].span;
    events_.append(std::move(e));
    ++end_alarms_;
    outcome_ = log::Outcome::plant_error;
    return log_happenings();
  }

  std::optional<RunFailure> log_happenings();
  std::optional<RunFailure> log_tick();
  log::RunSummary summary() const;

  const Job& job_;
  const machine::MachineModel& machine_;
  const SessionOptions options_;
  const bool checks_nodes_ = machine_.interpolator == machine::StepMethod::crossing;
  RecordWriter log_;
  const bool has_operator_;
  std::unique_ptr<planner::MotionSource> source_;
  EventList events_;
  std::vector<log::BlockRecord> begun_;
  std::vector<log::BlockEndRecord> block_ends_;
  OperatorPanel panel_;
  OperatorWatch operator_watch_;
  InputEvents inputs_;
  ProgramClock program_;
  BlockStarts block_starts_;
  interpolator::CrossingInterpolator interpolator_;
  std::optional<plant::Plant> plant_;
  std::vector<plant::EnergyBalance> energy_;  // [axes]; empty unless log.energy
  Monitor monitor_;
  StepHash hash_;
  StepBatch batch_;
  TickMotion motion_{};
  ControlTicks ticks_, motion_ticks_;
  ControlTicks approach_ticks_;  // of motion_ticks_, before the program's own path begins
  std::size_t end_alarms_ = 0;   // that ended the run, and are no monitor's
  std::optional<log::Outcome> outcome_;
};

std::optional<RunFailure> Session::Cycle::log_happenings() {
  begun_.clear();
  if (log_.writes())
    for (const BlockStarts::Start& start : block_starts_.list())
      begun_.push_back(block_starts_.record(start, motion_, operator_watch_.deferred_ticks()));
  auto failure = log_.happenings(begun_, events_.list(), block_ends_);
  block_starts_.clear();
  events_.clear();
  block_ends_.clear();
  return failure;
}

std::optional<RunFailure> Session::Cycle::log_tick() {
  if (auto failure = log_happenings()) return failure;
  // by name: a member without a default that is missing here does not compile
  const log::TickRecord record{.tick = motion_.tick,
                               .block = events_.block(),
                               .motion = &motion_,
                               .position_steps = &interpolator_.position_steps(),
                               .axis = plant(),
                               .has_override = has_operator_};
  return log_.tick(record, batch_);
}

log::RunSummary Session::Cycle::summary() const {
  const planner::Path& path = job_.read.path;
  log::RunSummary summary;
  summary.outcome = *outcome_;
  summary.ticks = now();
  summary.control_ticks = ticks_;
  summary.blocks = job_.read.blocks;
  monitor_.summarize(summary);
  const std::vector<double> begin_u = start_u(job_);
  for (std::size_t a = 0; a < summary.axis.size(); ++a)
    summary.axis[a].end_steps = lattice_node(begin_u[a], machine_.axis[a].step_u) + summary.axis[a].net_steps;
  for (std::size_t i = path.approach_size(); i < block_starts_.segments(); ++i) {
    const double done =
        std::clamp((motion_.s_end_u - path.start_s_u[i]) / path.segments[i].length_u, 0.0, 1.0);
    summary.path_u += done * path.segments[i].feed_length_u;
  }
  summary.motion_s = static_cast<double>(motion_ticks_.value) * machine_.clock.tau_s();
  summary.dwell_s = job_.planned.plan.pause_s;
  const double program_s =
      static_cast<double>((motion_ticks_ - approach_ticks_).value) * machine_.clock.tau_s();
  summary.mean_feed_u_s = program_s > 0 ? summary.path_u / program_s : 0.0;
  summary.steps_hash = hash_.digest();
  summary.limited_by = limit_shares(job_.planned.plan.law, machine_);
  summary.planned_s = job_.planned.plan.motion_s;
  if (has_operator_) summary.lost_by = operator_watch_.lost_by();
  summary.alarms += end_alarms_ + operator_watch_.alarms();
  summary.warnings = options_.warnings;
  if (options_.exit_code) summary.exit_code = options_.exit_code(summary);
  return summary;
}

Session::Session(const Job& job, log::RunLog* log, SessionOptions options)
    : cycle_(std::make_unique<Cycle>(job, log, std::move(options))) {}
Session::Session(Session&&) noexcept = default;
Session::~Session() = default;

tl::expected<ControlTicks, RunFailure> Session::advance(ControlTicks n) {
  const ControlTicks before = ticks();
  while (ticks() - before < n && !ended())
    if (auto failure = cycle_->advance()) return tl::unexpected(*failure);
  return ticks() - before;
}

bool Session::operate(const OperatorStep& step) { return cycle_->operate(step); }
tl::expected<log::RunSummary, RunFailure> Session::finish(log::Outcome unfinished) {
  return cycle_->finish(unfinished);
}
bool Session::ended() const { return cycle_->ended(); }
ControlTicks Session::ticks() const { return cycle_->ticks(); }
const TickMotion& Session::motion() const { return cycle_->motion(); }
const StepBatch& Session::batch() const { return cycle_->batch(); }
const std::vector<AxisState>* Session::plant() const { return cycle_->plant(); }
std::uint32_t Session::line() const { return cycle_->line(); }

}  // namespace kadr::cycle
