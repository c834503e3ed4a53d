#include "emulator/log_tools/diff/log_frames.h"

#include <algorithm>
#include <limits>

namespace kadr::log_tools {

Ticks tick_of(const LogItem& item) {
  return sane_tick(std::visit([](const auto& record) { return record.tick; }, item));
}

Ticks sane_tick(Ticks tick) {
  constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // a damaged log may hold any number
  return std::clamp(tick, Ticks{0}, Ticks{kLatest});
}

tl::expected<LogFrames, log::LogReadError> LogFrames::open(const std::string& path) {
  auto reader = log::LogReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  return LogFrames(std::move(*reader));
}

std::int64_t LogFrames::control_tick_of(const LogItem& item) const {
  return tick_of(item).value / header().control_tick_ticks;
}

bool LogFrames::next(LogFrame& frame) {
  while (ready_.empty() && !ended_) ended_ = !read();
  if (ready_.empty()) return false;
  frame = std::move(ready_.front());
  ready_.pop_front();
  return true;
}

/// Reads one message. Returns false at the end, after turning what is buffered into frames.
bool LogFrames::read() {
  log::LogMessage message;
  if (!reader_.next(message)) {
    const bool whole = log::is_sound(end().state);
    // exact data without their other half, and events after the last whole block, are not complete
    if (whole) {
      flush_block();
      flush_items(std::numeric_limits<std::int64_t>::max());
    }
    return false;
  }
  const bool exact = header().logs_ticks || header().logs_steps;
  const auto add_item = [&](LogItem item) {
    if (!exact) flush_items(control_tick_of(item));
    items_.push_back(std::move(item));
  };
  if (auto* b = std::get_if<log::BlockRecord>(&message)) add_item(std::move(*b));
  if (auto* e = std::get_if<log::EventRecord>(&message)) add_item(std::move(*e));
  if (auto* d = std::get_if<log::LogDiagnostic>(&message)) add_item(std::move(*d));
  if (auto* s = std::get_if<log::LogSummary>(&message)) summary_ = std::move(*s);
  log::for_each_channel(log::TickChannels{}, [&]<class R>() {
    auto* columns = std::get_if<R>(&message);
    if (columns == nullptr) return;
    if constexpr (std::same_as<R, log::TickBlock>)
      take_ticks(std::move(*columns));
    else
      std::get<std::optional<R>>(waiting_) = std::move(*columns);
  });
  if (auto* s = std::get_if<log::StepBlock>(&message)) {
    if (steps_) flush_block();
    steps_ = std::make_shared<const log::StepBlock>(std::move(*s));
    if (!header().logs_ticks || ticks_) flush_block();
  }
  return true;
}

void LogFrames::take_ticks(log::TickBlock ticks) {
  if (ticks_) flush_block();
  auto exact = std::make_shared<ExactTicks>(ExactTicks{std::move(ticks), std::move(waiting_)});
  waiting_ = {};
  log::for_each_channel(log::TickChannels{}, [&]<class R>() {
    auto& columns = std::get<std::optional<R>>(exact->others);
    if (columns && (columns->first != exact->first || columns->size() != exact->size())) columns.reset();
  });
  ticks_ = std::move(exact);
  if (!header().logs_steps) flush_block();
}

/// Frames of the exact data read: the control ticks of either message, ascending.
void LogFrames::flush_block() {
  const std::size_t n_ticks = ticks_ ? ticks_->size() : 0, n_steps = steps_ ? steps_->batches.size() : 0;
  constexpr auto kNone = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0, j = 0; i < n_ticks || j < n_steps;) {
    const auto of_ticks = i < n_ticks ? ticks_->first.value + static_cast<std::int64_t>(i) : kNone;
    const auto of_steps = j < n_steps ? steps_->first.value + static_cast<std::int64_t>(j) : kNone;
    LogFrame frame;
    frame.control_tick = std::min(of_ticks, of_steps);
    if (of_ticks == frame.control_tick) {
      frame.ticks = ticks_;
      frame.tick_index = i++;
    }
    if (of_steps == frame.control_tick) {
      frame.steps = steps_;
      frame.step_index = j++;
    }
    add_frame(std::move(frame));
  }
  ticks_ = nullptr;
  steps_ = nullptr;
}

/// Frames of items alone, of control ticks before `before_tick`.
void LogFrames::flush_items(std::int64_t before_tick) {
  while (!items_.empty() && control_tick_of(items_.front()) < before_tick) {
    LogFrame frame;
    frame.control_tick = control_tick_of(items_.front());
    add_frame(std::move(frame));
  }
}

/// Takes the items of the frame's control tick along.
void LogFrames::add_frame(LogFrame frame) {
  while (!items_.empty() && control_tick_of(items_.front()) <= frame.control_tick) {
    if (const auto* b = std::get_if<log::BlockRecord>(&items_.front()))
      block_ = std::make_shared<const log::BlockRecord>(*b);
    frame.items.push_back(std::move(items_.front()));
    items_.pop_front();
  }
  frame.block = block_;
  ready_.push_back(std::move(frame));
}

}  // namespace kadr::log_tools
