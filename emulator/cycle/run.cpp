#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "emulator/cycle/log_thread.h"
#include "emulator/cycle/lost_time.h"
#include "emulator/cycle/monitor.h"
#include "emulator/cycle/operator_panel.h"
#include "emulator/cycle/program_event.h"
#include "emulator/cycle/sound_nodes.h"
#include "emulator/emulator.h"
#include "emulator/interpolator/interpolator.h"
#include "plant/plant.h"

namespace kadr::emulator {
namespace {

/// Base tick at which the path reaches s inside this control tick: the inverse of TickMotion's linear feed.
Ticks tick_at(const planner::TickMotion& m, double s_u, const machine::ClockModel& clock) {
  const std::int64_t begin = m.tick.value * clock.control_tick.value;
  const double left_u = s_u - m.s_begin_u;
  const double span_ticks = m.move_end_ticks - m.move_begin_ticks;
  if (!(left_u > 0) || !(span_ticks > 0)) return {begin};
  const double span_s = span_ticks / static_cast<double>(clock.base_hz);
  const double accel_u_s2 = (m.ramp_end_u_s - m.ramp_begin_u_s) / span_s;
  const double root = std::sqrt(std::max(0.0, m.ramp_begin_u_s * m.ramp_begin_u_s + 2 * accel_u_s2 * left_u));
  const double t_s = 2 * left_u / (m.ramp_begin_u_s + root);
  const double ticks = m.move_begin_ticks + std::min(t_s, span_s) * static_cast<double>(clock.base_hz);
  return {begin + std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(ticks)), 0,
                                           clock.control_tick.value)};
}

// every so many control ticks the interpolator is checked; a prime, so that no repeating program hides from
// it
constexpr std::int64_t kNodeCheckTicks = 127;

/// The run loop: one control tick after the other, from the motion source through interpolator and plant to
/// the log.
class Cycle {
 public:
  Cycle(const Job& job, RunLog* log, const RunOptions& options)
      : job_(job),
        machine_(job.machine.model),
        options_(options),
        log_(log),
        source_(make_source(job)),
        panel_(job.operator_steps, machine_),
        lost_(job.plan.law, machine_.clock.tau_s()),
        interpolator_(job.path, machine_),
        monitor_(job.path, machine_) {
    batch_.axis.resize(machine_.axis.size());
    if (options.plant && std::any_of(machine_.axis.begin(), machine_.axis.end(),
                                     [](const machine::AxisModel& a) { return a.has_plant; })) {
      plant_.emplace(machine_, plant::PlantOptions{.energy = machine_.log.energy});
      std::vector<double> start_u;
      for (std::size_t a = 0; a < machine_.axis.size(); ++a)
        start_u.push_back(job.path.size() > 0 ? job.path.node(0)[a] : machine_.axis[a].home_u);
      plant_->reset(start_u);
    }
  }

  tl::expected<RunSummary, RunFailure> run() {
    Outcome outcome = Outcome::complete;
    std::int64_t k = 0;
    for (; !done(); ++k) {
      if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed)) {
        outcome = Outcome::interrupted;
        break;
      }
      if (static_cast<double>(k) * machine_.clock.tau_s() >= options_.until_s) {
        outcome = Outcome::stopped_by_until;
        break;
      }
      if (auto failure = advance(k)) {
        if (failure->world) return tl::unexpected(*failure);
        outcome = Outcome::plant_error;
        ++k;
        break;
      }
      if (machine_.on_alarm == machine::OnAlarm::stop && monitor_.alarms() > 0) {
        outcome = Outcome::alarm;
        ++k;
        break;
      }
      if (const auto end = ended_by_operator()) {
        outcome = *end;
        ++k;
        break;
      }
      if (options_.progress && k % 1000 == 999) report_progress();
    }
    return finish(outcome, k);
  }

 private:
  /// A block whose motion begins in this tick, by its first segment.
  struct BlockStart {
    std::size_t segment = 0;
    Ticks tick;
  };

  static std::unique_ptr<planner::MotionSource> make_source(const Job& job) {
    const machine::MachineModel& machine = job.machine.model;
    if (job.operator_steps.empty()) return std::make_unique<planner::LawSource>(job.plan.law, machine);
    return planner::override_source(job.path, job.plan, machine, most_percent(job.operator_steps));
  }
  bool has_operator() const { return !job_.operator_steps.empty(); }

  bool done() const { return source_->finished() && next_event_ == job_.events.size() && !job_pending(); }
  bool job_pending() const { return ready_at_ > now_; }

  /// One control tick. A failure of the plant is logged and ends the run; one of the log is the world's.
  std::optional<RunFailure> advance(std::int64_t k) {
    if (has_operator()) {
      const auto& input = panel_.advance(ControlTicks{k}, motion_.s_end_u, events_);
      motion_ = source_->advance(input);
      watch_operator(input);
    } else {
      motion_ = source_->advance(planner::OperatorInput{});
    }
    batch_.tick = motion_.tick;
    const bool check = checks_nodes_ && k % kNodeCheckTicks == 0;
    interpolator_.set_self_check(check);
    interpolator_.advance(motion_, batch_);
    if (check) require_sound_nodes(k, interpolator_, job_);
    hash_.add(batch_);
    now_ = Ticks{(k + 1) * machine_.clock.control_tick.value};
    collect_inputs();
    collect_starts();

    std::optional<plant::PlantError> plant_error;
    if (plant_) {
      if (auto moved = plant_->advance(batch_); !moved) plant_error = moved.error();
    }
    if (plant_error) return plant_failure(*plant_error);
    TickView view{&motion_, &batch_, plant_ ? &plant_->state() : nullptr,
                  plant_ && machine_.log.energy ? &*plant_ : nullptr, segment()};
    monitor_.tick(view, events_, block_ends_);
    if (plant_) monitor_.lost_steps(plant_->lost_steps(), now_, events_);
    if (motion_.s_end_u > motion_.s_begin_u) ++motion_ticks_;
    return log_tick();
  }

  /// Why a run under a timeline ends before the program does, or nothing.
  std::optional<Outcome> ended_by_operator() {
    if (!has_operator()) return std::nullopt;
    if (source_->stopped()) {
      add_alarm(Code::emergency_stopped, motion_.s_end_u, job_.path.length_u(),
                fmt::format("stands at {:.6g} of {:.6g}", motion_.s_end_u, job_.path.length_u()));
      return Outcome::emergency_stop;
    }
    const bool held = motion_.limited_by == planner::LimitedBy::hold && motion_.speed_end_u_s == 0 &&
                      motion_.s_end_u == motion_.s_begin_u;
    if (!held || !panel_.at_its_end()) return std::nullopt;
    add_alarm(Code::held_to_the_end, motion_.s_end_u, job_.path.length_u(),
              fmt::format("held at {:.6g} of {:.6g}, and no step releases it", motion_.s_end_u,
                          job_.path.length_u()));
    return Outcome::held;
  }

  void add_alarm(Code code, double value, double limit, std::string text) {
    EventRecord e;
    e.tick = now_;
    e.kind = EventKind::alarm;
    e.code = code;
    e.value = value;
    e.limit = limit;
    e.text = std::move(text);
    if (job_.path.size() > 0) {
      e.span = job_.path.segments[segment()].span;
      e.block = job_.path.segments[segment()].block;
    }
    events_.push_back(std::move(e));
    ++operator_alarms_;
  }

  /// Waiting percents, time lost and what is alarming about them.
  void watch_operator(const planner::OperatorInput& input) {
    using planner::LimitedBy;
    using planner::OverrideNote;
    if (motion_.note == OverrideNote::none || motion_.note == OverrideNote::limited)
      deferred_ticks_ = ControlTicks{};
    else
      ++deferred_ticks_;
    const bool locked_overload = motion_.note == OverrideNote::locked && panel_.spindle_percent() < 1;
    if (locked_overload && !overload_told_)
      add_alarm(
          Code::overload_locked, panel_.spindle_percent() * 100, 100,
          fmt::format("the load asks for {:.6g} %, but the feed is locked", panel_.spindle_percent() * 100));
    overload_told_ = locked_overload;
    const bool rests = motion_.s_end_u == motion_.s_begin_u;
    if (rests && motion_.limited_by == LimitedBy::stop) return;  // a pause of the program
    if (input.hold || motion_.limited_by == LimitedBy::hold)
      reason_ = LostReason::hold;
    else if (motion_.note == OverrideNote::deferred)
      reason_ = LostReason::deferral;
    else if (motion_.limiter < 1)
      reason_ = LostReason::limiter;
    else if (panel_.spindle_percent() < 1)
      reason_ = LostReason::spindle_load;
    else if (motion_.override_used != 1 || input.rapid_override != 1)
      reason_ = LostReason::feed_override;
    lost_.add(motion_, reason_);
  }

  std::size_t segment() const {
    return job_.path.size() == 0 ? 0 : std::min(interpolator_.segment(), job_.path.size() - 1);
  }

  /// Steps of the timeline: each stands at the beginning of its control tick.
  void collect_inputs() {
    for (; next_input_ < job_.inputs.size() && job_.inputs[next_input_].tick <= motion_.tick; ++next_input_) {
      const InputStep& step = job_.inputs[next_input_];
      EventRecord e;
      e.tick = Ticks{step.tick.value * machine_.clock.control_tick.value};
      e.block = job_.path.size() == 0 ? 0 : job_.path.segments[segment()].block;
      e.kind = EventKind::input;
      e.value = step.value;
      e.text =
          fmt::format("{} input {} = {:.6g}", step.analog ? "analog" : "digital", step.number, step.value);
      events_.push_back(std::move(e));
    }
  }

  /// Blocks that begin and program events that happen in this tick, in tick order (blocks first).
  void collect_starts() {
    while (next_segment_ < job_.path.size() &&
           (motion_.s_end_u > job_.path.start_s_u[next_segment_] ||
            (motion_.s_end_u > motion_.s_begin_u && next_segment_ == 0))) {
      const bool begins = next_segment_ == 0 || job_.path.segments[next_segment_].block !=
                                                    job_.path.segments[next_segment_ - 1].block;
      const double at_u = job_.path.start_s_u[next_segment_];
      if (begins) block_starts_.push_back({next_segment_, tick_at(motion_, at_u, machine_.clock)});
      ++next_segment_;
    }
    for (; next_event_ < job_.events.size(); ++next_event_) {
      const ProgramEvent& event = job_.events[next_event_];
      const double at_u = job_.path.size() == 0 ? 0.0 : job_.path.start_s_u[event.after_segment];
      if (motion_.s_end_u < at_u) break;
      if (event.after_segment != reached_joint_) {
        reached_joint_ = event.after_segment;
        ready_at_ = std::max(ready_at_, tick_at(motion_, at_u, machine_.clock));
      }
      if (ready_at_ > now_) break;
      add_program_event(event);
    }
  }

  void add_program_event(const ProgramEvent& event) {
    EventRecord e = event_record(event);
    e.tick = ready_at_;
    e.block = event.after_segment == 0 ? 0 : job_.path.segments[event.after_segment - 1].block;
    e.span = event.block.span;
    events_.push_back(std::move(e));
    const double hold_s = hold_time_s(event, machine_);
    ready_at_ += Ticks{
        static_cast<std::int64_t>(std::floor(hold_s * static_cast<double>(machine_.clock.base_hz) + 0.5))};
  }

  std::optional<RunFailure> plant_failure(const plant::PlantError& error) {
    EventRecord e;
    e.tick = now_;
    e.kind = EventKind::alarm;
    e.code = Code::plant_numerics;
    e.axis = error.axis;
    e.text = fmt::format("{}: {}", error.flag, error.detail);
    if (job_.path.size() > 0) e.span = job_.path.segments[segment()].span;
    events_.push_back(e);
    ++plant_alarms_;
    if (auto failure = log_small_records()) return failure;
    return RunFailure{e.text, false};
  }

  std::optional<RunFailure> keep(const tl::expected<void, LogError>& written) {
    if (written) return std::nullopt;
    const LogError& e = written.error();
    const double valid_s =
        static_cast<double>(e.valid_until.value) / static_cast<double>(machine_.clock.base_hz);
    return RunFailure{fmt::format("{}: {}; the log is valid up to tick {} ({:.6f} s)", e.path, e.reason,
                                  e.valid_until.value, valid_s),
                      true};
  }

  std::optional<RunFailure> log_small_records() {
    std::optional<RunFailure> failure;
    if (log_) {
      std::size_t e = 0;
      for (std::size_t b = 0; b < block_starts_.size() && !failure; ++b) {
        for (; e < events_.size() && events_[e].tick < block_starts_[b].tick && !failure; ++e)
          failure = keep(log_->event(events_[e]));
        if (!failure) failure = keep(log_->block(block_record(block_starts_[b])));
      }
      for (; e < events_.size() && !failure; ++e) failure = keep(log_->event(events_[e]));
      for (std::size_t i = 0; i < block_ends_.size() && !failure; ++i)
        failure = keep(log_->block_end(block_ends_[i]));
    }
    block_starts_.clear();
    events_.clear();
    block_ends_.clear();
    return failure;
  }

  std::optional<RunFailure> log_tick() {
    if (auto failure = log_small_records()) return failure;
    if (!log_) return std::nullopt;
    TickRecord record;
    record.tick = motion_.tick;
    record.block = job_.path.size() == 0 ? 0 : job_.path.segments[segment()].block;
    record.motion = &motion_;
    record.position_steps = &interpolator_.position_steps();
    record.axis = plant_ ? &plant_->state() : nullptr;
    record.has_override = has_operator();
    return keep(log_->tick(record, batch_));
  }

  /// Feed of the path at s inside this tick, by its linear feed.
  double feed_at(double s_u) const {
    const double left_u = std::max(s_u - motion_.s_begin_u, 0.0);
    const double way_u = motion_.s_end_u - motion_.s_begin_u;
    if (!(way_u > 0)) return motion_.speed_end_u_s;
    const double v0 = motion_.ramp_begin_u_s, v1 = motion_.ramp_end_u_s;
    return std::sqrt(std::max(0.0, v0 * v0 + (v1 * v1 - v0 * v0) * std::min(left_u / way_u, 1.0)));
  }

  BlockRecord block_record(const BlockStart& start) const {
    const planner::PathSegment& s = job_.path.segments[start.segment];
    const BlockSummary summary = block_summary(job_, start.segment);
    BlockRecord r;
    r.tick = start.tick;
    r.block = s.block;
    r.span = s.span;
    r.text = std::string(job_.sources[s.span.file].line(s.span.line));
    r.motion = planner::motion_name(s);
    r.length_u = summary.length_u;
    r.programmed_u_s = summary.programmed_u_s;
    r.planned_peak_u_s = summary.peak_u_s;
    r.planned_end_u_s = summary.end_u_s;
    r.planned_s = summary.time_s;
    r.limited_by = limited_by_text(summary.limited_by, summary.limiting_axis, machine_);
    r.entry_u_s = feed_at(job_.path.start_s_u[start.segment]);
    if (start.segment > 0) r.planned_entry_u_s = job_.plan.segments[start.segment - 1].end_u_s;
    r.deferred_ticks = deferred_ticks_;
    return r;
  }

  void report_progress() const {
    const double length_u = job_.path.length_u();
    const std::uint32_t line = job_.path.size() == 0 ? 0 : job_.path.segments[segment()].span.line;
    options_.progress(length_u > 0 ? motion_.s_end_u / length_u : 1.0, line,
                      static_cast<double>(now_.value) / static_cast<double>(machine_.clock.base_hz));
  }

  tl::expected<RunSummary, RunFailure> finish(Outcome outcome, std::int64_t control_ticks) {
    now_ = Ticks{control_ticks * machine_.clock.control_tick.value};
    monitor_.finish(now_, events_, block_ends_);
    if (auto failure = log_small_records()) return tl::unexpected(*failure);
    RunSummary summary;
    summary.outcome = outcome;
    summary.ticks = now_;
    summary.control_ticks = ControlTicks{control_ticks};
    summary.blocks = job_.blocks;
    monitor_.summarize(summary);
    for (std::size_t a = 0; a < summary.axis.size(); ++a) {
      const double node_u = job_.path.size() == 0 ? machine_.axis[a].home_u : job_.path.node(0)[a];
      summary.axis[a].end_steps =
          Steps{lattice_node(node_u, machine_.axis[a].step_u)} + summary.axis[a].net_steps;
    }
    for (std::size_t i = 0; i < job_.path.size() && i < next_segment_; ++i) {
      const planner::PathSegment& segment = job_.path.segments[i];
      const double done = std::clamp((motion_.s_end_u - job_.path.start_s_u[i]) / segment.length_u, 0.0, 1.0);
      summary.path_u += done * segment.feed_length_u;
    }
    summary.motion_s = static_cast<double>(motion_ticks_) * machine_.clock.tau_s();
    summary.dwell_s = job_.dwell_s;
    summary.mean_feed_u_s = summary.motion_s > 0 ? summary.path_u / summary.motion_s : 0.0;
    summary.steps_hash = hash_.digest();
    summary.limited_by = limit_shares(job_);
    summary.planned_s = job_.motion_s;
    if (has_operator()) summary.lost_by = lost_.shares();
    summary.alarms += plant_alarms_ + operator_alarms_;
    summary.warnings = options_.warnings;
    if (options_.exit_code) summary.exit_code = options_.exit_code(summary);
    if (log_)
      if (auto failure = keep(log_->end(summary))) return tl::unexpected(*failure);
    return summary;
  }

  const Job& job_;
  const machine::MachineModel& machine_;
  const RunOptions& options_;
  const bool checks_nodes_ = machine_.interpolator == machine::StepMethod::crossing;
  RunLog* log_;
  std::unique_ptr<planner::MotionSource> source_;
  OperatorPanel panel_;
  LostTime lost_;
  CrossingInterpolator interpolator_;
  std::optional<plant::Plant> plant_;
  Monitor monitor_;
  StepHash hash_;
  StepBatch batch_;
  planner::TickMotion motion_{};
  Ticks now_, ready_at_;
  std::size_t next_segment_ = 0, next_event_ = 0, next_input_ = 0;
  std::size_t reached_joint_ = static_cast<std::size_t>(-1);
  std::vector<BlockStart> block_starts_;
  std::vector<EventRecord> events_;
  std::vector<BlockEndRecord> block_ends_;
  std::int64_t motion_ticks_ = 0;
  std::size_t plant_alarms_ = 0, operator_alarms_ = 0;
  ControlTicks deferred_ticks_;
  bool overload_told_ = false;
  LostReason reason_ = LostReason::feed_override;
};

}  // namespace

tl::expected<RunSummary, RunFailure> run(const Job& job, RunLog* log, const RunOptions& options) {
  if (log && options.threads > 1) {
    const auto threaded = make_threaded_log(*log);
    return Cycle(job, threaded.get(), options).run();
  }
  return Cycle(job, log, options).run();
}

}  // namespace kadr::emulator
