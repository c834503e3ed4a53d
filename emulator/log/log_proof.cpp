#include "emulator/log/log_proof.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "emulator/log/log_reader.h"
#include "emulator/log/log_types.h"

namespace kadr::log {
namespace {

constexpr std::int64_t kLatest = std::int64_t{1} << 62;

template <class... T>
Breach breach(fmt::format_string<T...> form, T&&... values) {
  return fmt::format(form, std::forward<T>(values)...);
}

/// The base tick that a message's event is stamped with.
class StampOf {
 public:
  explicit StampOf(std::int64_t tau) : tau_(tau) {}
  std::optional<Ticks> operator()(const LogHeader& h) const { return h.tick; }
  std::optional<Ticks> operator()(const TickBlock& b) const { return end(b.first, b.size()); }
  std::optional<Ticks> operator()(const StepBlock& b) const { return end(b.first, b.batches.size()); }
  /// What was found before the run is stamped with its beginning.
  std::optional<Ticks> operator()(const LogDiagnostic& d) const {
    return d.tick == Ticks{-1} ? Ticks{0} : d.tick;
  }
  std::optional<Ticks> operator()(const LogSummary& s) const { return s.run.ticks; }
  std::optional<Ticks> operator()(const UnknownMessage&) const { return std::nullopt; }
  template <class Record>
  std::optional<Ticks> operator()(const Record& r) const {
    return r.tick;
  }

 private:
  Ticks end(ControlTicks first, std::size_t ticks) const {
    return {(first.value + static_cast<std::int64_t>(ticks)) * tau_};
  }
  std::int64_t tau_;
};

/// Bit by bit: a number that is none equals itself.
bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

const char* infinite_column(const TickBlock& b) {
  if (!all_finite(b.feed_u_s)) return "feed_u_s";
  if (!all_finite(b.accel_u_s2)) return "accel_u_s2";
  if (!all_finite(b.path_u)) return "path_u";
  if (!all_finite(b.override_used)) return "override_used";
  if (!all_finite(b.override_requested)) return "override_requested";
  if (!all_finite(b.limiter)) return "limiter";
  for (const AxisTicks& axis : b.axis) {
    if (!all_finite(axis.command_u)) return "command_u";
    if (!all_finite(axis.base_u)) return "base_u";
    if (!all_finite(axis.base_u_s)) return "base_u_s";
    if (!all_finite(axis.link_u)) return "link_u";
    if (!all_finite(axis.link_u_s)) return "link_u_s";
    if (!all_finite(axis.motor_force_N)) return "motor_force";
  }
  return nullptr;
}

}  // namespace

LogProof::LogProof(const LogHeader& header) : header_(header), sums_(header.axis.size()) {}

Breach LogProof::add(const LogEventView& event, const LogMessage& message, bool hashes_deny) {
  hashes_deny_ = hashes_deny;
  if (auto wrong = stamp(event, message)) return wrong;
  if (steps_due_ && !std::holds_alternative<StepBlock>(message) &&
      !std::holds_alternative<UnknownMessage>(message))
    return breach("KADR_STEPS of the control ticks {} to {} is due here", steps_due_->first,
                  steps_due_->end - 1);
  return std::visit([this](const auto& record) { return check(record); }, message);
}

Breach LogProof::stamp(const LogEventView& event, const LogMessage& message) {
  // events of one control tick are written by kind
  const std::int64_t back_us = event_time_us(Ticks{header_.control_tick_ticks}, header_.base_hz) + 1;
  if (event.time_us < last_us_ - back_us)
    return breach("it is stamped with {} us, an event before it with {} us: one control tick back is allowed",
                  event.time_us, last_us_);
  last_us_ = std::max(last_us_, event.time_us);
  const auto tick = std::visit(StampOf(header_.control_tick_ticks), message);
  if (!tick) return {};
  if (tick->value < 0 || tick->value > kLatest)
    return breach("its tick is {}, 0 to {} are allowed", tick->value, kLatest);
  const std::int64_t time_us = event_time_us(*tick, header_.base_hz);
  if (time_us != event.time_us)
    return breach("it is stamped with {} us, its tick {} is at {} us", event.time_us, tick->value, time_us);
  return {};
}

/// Exact data ascend, in blocks no longer than the header says.
Breach LogProof::stretch(ControlTicks first, std::size_t ticks) const {
  if (first.value < next_tick_)
    return breach("it begins with control tick {}, the block before it ends with {}", first.value,
                  next_tick_ - 1);
  if (static_cast<std::int64_t>(ticks) > header_.block_ticks)
    return breach("it has {} control ticks, the header allows {}", ticks, header_.block_ticks);
  return {};
}

Breach LogProof::check(const BlockRecord& block) {
  if (blocks_ > 0 && block.block <= last_block_)
    return breach("block {} begins after block {}", block.block, last_block_);
  last_block_ = block.block;
  ++blocks_;
  if (block.motion == kApproachMotion) ++approaches_;
  return {};
}

Breach LogProof::check(const BlockEndRecord& end) {
  if (blocks_ == 0 || end.block > last_block_)
    return breach("block {} ends, the last one begun is {}", end.block, last_block_);
  if (last_ended_ && end.block <= *last_ended_)
    return breach("block {} ends after block {}", end.block, *last_ended_);
  last_ended_ = end.block;
  const std::size_t axes = header_.axis.size(), energies = end.positive_J.size();
  if (end.peak_link_u.size() != axes)
    return breach("n_axes is {}, in KADR_RUN it is {}", end.peak_link_u.size(), axes);
  if (energies != 0 && energies != axes)
    return breach("n_energy_axes is {}, 0 or {} is allowed", energies, axes);
  return {};
}

Breach LogProof::check(const TickBlock& b) {
  if (!header_.logs_ticks) return breach("KADR_RUN says that KADR_TICKS is not written");
  if (auto wrong = stretch(b.first, b.size())) return wrong;
  if (auto wrong = columns(b)) return wrong;
  if (auto wrong = numbers(b)) return wrong;
  if (auto wrong = viewers(b)) return wrong;
  const auto n = static_cast<std::int64_t>(b.size());
  next_tick_ = b.first.value + n;
  control_ticks_ += n;
  path_u_ = b.path_u.back();
  for (std::size_t a = 0; a < sums_.size(); ++a) sums_[a].last_node = b.axis[a].steps.back();
  if (header_.logs_steps) steps_due_ = Stretch{b.first.value, next_tick_};
  return {};
}

/// A column that one block has, every block has.
Breach LogProof::columns(const TickBlock& b) {
  const auto changed = [](std::optional<bool>& column, bool has, const char* count,
                          std::size_t full) -> Breach {
    if (!column) column = has;
    if (*column == has) return {};
    return breach("{} is {}, in the blocks before it {}", count, has ? full : 0, has ? "0" : "more than 0");
  };
  if (auto wrong = changed(plant_, b.has_plant, "n_plant_axes", b.axis.size())) return wrong;
  if (auto wrong = changed(override_, b.has_override, "n_override", b.size())) return wrong;
  const bool modelled = std::any_of(header_.axis.begin(), header_.axis.end(),
                                    [](const LogAxis& axis) { return axis.has_plant; });
  if (b.has_plant && !modelled)
    return breach("n_plant_axes is {}, but no axis of KADR_RUN has a plant", b.axis.size());
  return {};
}

Breach LogProof::numbers(const TickBlock& b) {
  if (const char* column = infinite_column(b)) return breach("a number in {} is not finite", column);
  double path_u = path_u_;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const std::int64_t tick = b.first.value + static_cast<std::int64_t>(i);
    if (b.path_u[i] < path_u)
      return breach("path_u runs back from {} to {} in control tick {}", path_u, b.path_u[i], tick);
    path_u = b.path_u[i];
    if (b.limiting_axis[i] < -1 || b.limiting_axis[i] >= static_cast<std::int64_t>(header_.axis.size()))
      return breach("limiting_axis is {} in control tick {}, -1 to {} are allowed", b.limiting_axis[i], tick,
                    header_.axis.size() - 1);
  }
  return {};
}

Breach LogProof::viewers(const TickBlock& b) {
  Breach wrong;
  for (const FeedSample& sample : feeds_)
    if (!wrong) wrong = viewer(b, sample);
  for (const AxisSample& sample : axes_)
    if (!wrong) wrong = viewer(b, sample);
  feeds_.clear();
  axes_.clear();
  return wrong;
}

namespace {

/// Index in a block of the control tick that ends at `end`; nothing: it is not in it.
std::optional<std::size_t> index_in(const TickBlock& b, Ticks end, std::int64_t tau) {
  const std::int64_t i = end.value / tau - 1 - b.first.value;
  if (i < 0 || i >= static_cast<std::int64_t>(b.size())) return std::nullopt;
  return static_cast<std::size_t>(i);
}

Breach differs(const char* channel, const char* field, Ticks tick) {
  return breach("{} of {} at tick {} is another one than here", field, channel, tick.value);
}

Breach not_here(const char* channel, Ticks tick) {
  return breach("it does not hold the control tick of the {} at tick {}", channel, tick.value);
}

}  // namespace

Breach LogProof::viewer(const TickBlock& b, const FeedSample& s) const {
  const auto i = index_in(b, s.tick, header_.control_tick_ticks);
  constexpr double kPercent = 100;
  constexpr const char* kChannel = Channel<FeedSample>::info.name.data();
  if (!i) return not_here(kChannel, s.tick);
  if (s.block != b.block[*i]) return differs(kChannel, "block", s.tick);
  if (!same(s.path_u, b.path_u[*i])) return differs(kChannel, "path_u", s.tick);
  if (!same(s.commanded_u_s, b.feed_u_s[*i])) return differs(kChannel, "commanded_u_s", s.tick);
  if (!same(s.acceleration_u_s2, b.accel_u_s2[*i])) return differs(kChannel, "acceleration_u_s2", s.tick);
  if (!same(s.override_used_pct, kPercent * b.override_used[*i]))
    return differs(kChannel, "override_used_pct", s.tick);
  if (s.limited_by != b.limited_by[*i]) return differs(kChannel, "limited_by", s.tick);
  return {};
}

Breach LogProof::viewer(const TickBlock& b, const AxisSample& s) const {
  const auto i = index_in(b, s.tick, header_.control_tick_ticks);
  constexpr const char* kChannel = "KADR_AXIS_*";
  if (!i) return not_here(kChannel, s.tick);
  const AxisTicks& axis = b.axis[static_cast<std::size_t>(s.axis)];
  if (s.steps != axis.steps[*i]) return differs(kChannel, "steps", s.tick);
  if (!same(s.ideal, axis.command_u[*i])) return differs(kChannel, "ideal", s.tick);
  if (!b.has_plant) return {};
  if (!same(s.motor, axis.base_u[*i])) return differs(kChannel, "motor", s.tick);
  if (!same(s.motor_force_N, axis.motor_force_N[*i])) return differs(kChannel, "motor_force_N", s.tick);
  return {};
}

Breach LogProof::check(const StepBlock& b) {
  if (!header_.logs_steps) return breach("KADR_RUN says that KADR_STEPS is not written");
  const auto n = static_cast<std::int64_t>(b.batches.size());
  if (!header_.logs_ticks) {
    if (auto wrong = stretch(b.first, b.batches.size())) return wrong;
    next_tick_ = b.first.value + n;
    control_ticks_ += n;
  } else if (!steps_due_) {
    return breach("it has no KADR_TICKS before it");
  } else if (b.first.value != steps_due_->first || b.first.value + n != steps_due_->end) {
    return breach("it has the control ticks {} to {}, its KADR_TICKS {} to {}", b.first.value,
                  b.first.value + n - 1, steps_due_->first, steps_due_->end - 1);
  }
  steps_due_.reset();
  for (const StepBatch& batch : b.batches) {
    steps_hash_.add(batch);
    for (std::size_t a = 0; a < sums_.size(); ++a) {
      sums_[a].pulses += static_cast<std::int64_t>(batch.axis[a].count());
      sums_[a].net_steps += batch.axis[a].net_steps().value;
    }
  }
  return {};
}

Breach LogProof::check(const FeedSample& s) {
  const std::int64_t tau = header_.control_tick_ticks, every = header_.viewer_every_ticks;
  if (every == 0) return breach("KADR_RUN says that viewer messages are not written");
  if (s.tick.value % (tau * every) != 0 || s.tick.value == 0)
    return breach("its tick {} does not end a control tick with a viewer message: those are {} ticks apart",
                  s.tick.value, tau * every);
  const std::int64_t number = s.tick.value / tau - 1;
  if (last_viewed_ && number <= *last_viewed_)
    return breach("it is of control tick {}, the one before it of {}", number, *last_viewed_);
  if (number < next_tick_) return breach("it is of control tick {}, its exact data came before it", number);
  last_viewed_ = number;
  last_axis_ = -1;
  if (!header_.logs_ticks) return {};
  if (static_cast<std::int64_t>(feeds_.size()) >= header_.block_ticks)
    return breach("it is one of more than {} without exact data", header_.block_ticks);
  feeds_.push_back(s);
  return {};
}

Breach LogProof::check(const AxisSample& s) {
  if (!last_viewed_ || s.tick.value != (*last_viewed_ + 1) * header_.control_tick_ticks)
    return breach("its tick is {}, that of the KADR_FEED before it is another one", s.tick.value);
  if (s.axis <= last_axis_) return breach("it is of axis {}, the one before it of {}", s.axis, last_axis_);
  last_axis_ = s.axis;
  if (header_.logs_ticks && s.tick.value / header_.control_tick_ticks > next_tick_) axes_.push_back(s);
  return {};
}

Breach LogProof::check(const EventRecord& e) {
  if (e.axis < -1 || e.axis >= static_cast<int>(header_.axis.size()))
    return breach("its axis is {}, -1 to {} are allowed", e.axis, header_.axis.size() - 1);
  if (e.kind == EventKind::alarm) ++alarms_;
  return {};
}

}  // namespace kadr::log
