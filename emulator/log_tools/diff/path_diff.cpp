#include "emulator/log_tools/diff/path_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <string_view>

#include "machine/base/parse_number.h"

namespace kadr::log_tools {
namespace {

/// Actions of the program at a position of its path, under any override: the kinds of its events.
bool is_program_event(const log::EventRecord& e) {
  return e.span.line > 0 && e.kind.value() && log::is_of_program(*e.kind.value());
}

class PathCompare {
 public:
  PathCompare(LogFrames& a, LogFrames& b, const DiffOptions& options, const PathDiffSinks& sinks,
              PathDiff& result)
      : log_{&a, &b},
        side_{&result.a, &result.b},
        options_(options),
        sinks_(sinks),
        result_(result),
        axes_(common_axes(result.a.header, result.b.header)),
        feed_(result.tolerance_u_s),
        steps_(axes_, result.a.header.control_tick_ticks, result.b.header.control_tick_ticks) {}

  void run() {
    // the log that is behind on the path is read on; at the same position, A
    while (more_[0] || more_[1]) {
      const int side = !more_[1] || (more_[0] && path_u_[0] <= path_u_[1]) ? 0 : 1;
      if (!log_[side]->next(frame_)) {
        more_[side] = false;
        continue;
      }
      take(side);
      collect();
    }
    for (int side = 0; side < 2; ++side) {
      side_[side]->end = log_[side]->end();
      side_[side]->summary = log_[side]->summary();
    }
    result_.path_a_u = path_u_[0];
    result_.path_b_u = path_u_[1];
    feed_.finish();
    steps_.finish(!result_.paths_differ());
    collect();
    finish_events();
    result_.blocks = steps_.blocks();
    result_.blocks_differing = steps_.differing();
    result_.given_up = steps_.given_up();
    result_.spans = feed_.spans();
    result_.span_length_u = feed_.length_u();
    result_.largest_span = feed_.largest();
  }

 private:
  void take(int side) {
    if (result_.events_compared)
      for (const LogItem& item : frame_.items)
        if (const auto* e = std::get_if<log::EventRecord>(&item); e && is_program_event(*e))
          events_[side].push_back(*e);
    if (result_.steps_compared) steps_.add(side, frame_);
    if (!frame_.ticks) return;
    ++side_[side]->control_ticks;
    const log::TickBlock& t = *frame_.ticks;
    const std::size_t i = frame_.tick_index;
    // a damaged log may hold any number: the path never runs back
    if (t.path_u[i] > path_u_[side]) path_u_[side] = t.path_u[i];
    if (!result_.feed_compared) return;
    const log::LogHeader& header = side_[side]->header;
    FeedPoint point;
    point.path_u = t.path_u[i];
    point.feed_u_s = t.feed_u_s[i];
    point.accel_u_s2 = t.accel_u_s2[i];
    point.tick = Ticks{(frame_.control_tick + 1) * header.control_tick_ticks};
    point.tau_s = header.seconds(Ticks{header.control_tick_ticks});
    point.override_used = t.override_used[i];
    point.limited_by = t.limited_by[i];
    point.block = frame_.block;
    feed_.add(side, point);
  }

  void collect() {
    for (BlockDifference& block : steps_.take()) {
      if (options_.all && sinks_.block) sinks_.block(block);
      if (!result_.first_block) result_.first_block = std::move(block);
    }
    for (FeedSpan& span : feed_.take()) {
      if (options_.all && sinks_.span) sinks_.span(span);
      if (!result_.first_span) result_.first_span = std::move(span);
    }
    while (!events_[0].empty() && !events_[1].empty()) {
      ++result_.events;
      compare_events(&events_[0].front(), &events_[1].front());
      events_[0].pop_front();
      events_[1].pop_front();
    }
    for (int side = 0; side < 2; ++side) {
      auto& list = events_[side];
      if (list.size() > StepSequence::kMostAhead)
        compare_events(side == 0 ? &list[0] : nullptr, side == 0 ? nullptr : &list[0]);
    }
    if (result_.event)
      for (auto& list : events_) list.clear();
  }

  /// @param a, b  null: that log has no more events
  void compare_events(const log::EventRecord* a, const log::EventRecord* b) {
    if (result_.event) return;
    const auto differs = [&](std::string_view name) {
      if (options_.ignores(DiffChannel::event, name)) return false;
      for (const auto& field : event_fields())
        if (field.name == name) return !same_value(field.get(*a), field.get(*b));
      return false;
    };
    if (a && b && !differs("kind") && !differs("source_line") && !differs("block") && !differs("value"))
      return;
    const auto text = [](const log::EventRecord* e) {
      if (e == nullptr) return std::string("-");
      return fmt::format("{} {}, line {}, after block {}", e->kind.text(), number_text(e->value),
                         e->span.line, e->block);
    };
    const log::LogHeader& header = a ? result_.a.header : result_.b.header;
    result_.event = {std::max<std::int64_t>(result_.events, 1), place_of(header, (a ? a : b)->span.line),
                     text(a), text(b)};
  }

  /// Events that only one log has are reported only if both ran to the same end.
  void finish_events() {
    if (result_.paths_differ() || result_.event) return;
    for (int side = 0; side < 2; ++side) {
      if (events_[side].empty()) continue;
      ++result_.events;
      const log::EventRecord* e = &events_[side].front();
      compare_events(side == 0 ? e : nullptr, side == 0 ? nullptr : e);
    }
  }

  LogFrames* log_[2];
  LogSide* side_[2];
  const DiffOptions& options_;
  const PathDiffSinks& sinks_;
  PathDiff& result_;
  std::vector<AxisPair> axes_;
  FeedCompare feed_;
  StepSequence steps_;
  LogFrame frame_;
  bool more_[2] = {true, true};
  double path_u_[2] = {0, 0};
  std::deque<log::EventRecord> events_[2];
};

}  // namespace

bool PathDiff::inputs_differ() const {
  return std::any_of(inputs.begin(), inputs.end(), [](const InputDifference& input) { return !input.same; });
}

tl::expected<PathDiff, log::LogReadError> diff_paths(const std::string& a, const std::string& b,
                                                     const DiffOptions& options, const PathDiffSinks& sinks) {
  auto of_a = LogFrames::open(a);
  if (!of_a) return tl::unexpected(of_a.error());
  auto of_b = LogFrames::open(b);
  if (!of_b) return tl::unexpected(of_b.error());
  PathDiff result;
  result.a.path = a;
  result.b.path = b;
  result.a.header = of_a->header();
  result.b.header = of_b->header();
  for (const LogSide* side : {&result.a, &result.b})
    if (!side->header.logs_ticks)
      return tl::unexpected(
          log::LogReadError{log::LogReadFault::other_log, side->path,
                            "has no path to align by: it was written with log.ticks = false"});
  result.inputs = compare_inputs(result.a.header, result.b.header);
  result.unit = path_unit(result.a.header);
  const bool rotary = result.unit == "deg";
  result.tolerance_u_s = options.tolerance.of(log::ToleranceKey::feed, rotary).value_or(kFeedTolerance_u_s);
  result.steps_compared = result.a.header.logs_steps && result.b.header.logs_steps &&
                          !options.ignores(DiffChannel::steps, "pulses");
  result.feed_compared = !options.ignores(DiffChannel::command, "feed_u_s");
  result.events_compared = !options.ignores(DiffChannel::event, "kind");
  if (sinks.begin) sinks.begin(result);
  PathCompare(*of_a, *of_b, options, sinks, result).run();
  return result;
}

}  // namespace kadr::log_tools
