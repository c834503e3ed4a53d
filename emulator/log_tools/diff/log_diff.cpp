#include "emulator/log_tools/diff/log_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "emulator/text/text.h"

namespace kadr::log_tools {
namespace {

struct FramePair {
  LogFrame a, b;
};

bool whole(const log::LogEnd& end) { return log::is_sound(end.state); }
bool exact(const LogFrame& frame) { return frame.ticks || frame.steps; }

/// Runs through both logs once.
class TickDiff {
 public:
  TickDiff(LogFrames& a, LogFrames& b, const DiffOptions& options, const TickDiffSinks& sinks,
           LogDiff& result)
      : a_(a),
        b_(b),
        options_(options),
        sinks_(sinks),
        result_(result),
        compare_(result.a.header, result.b.header, options) {}

  void run() {
    FramePair pair;
    bool more_a = next(a_, pair.a, result_.a), more_b = next(b_, pair.b, result_.b);
    while (more_a && more_b) {
      const std::int64_t at = std::min(pair.a.control_tick, pair.b.control_tick);
      const bool has_a = pair.a.control_tick == at, has_b = pair.b.control_tick == at;
      take({has_a ? std::move(pair.a) : absent(at), has_b ? std::move(pair.b) : absent(at)});
      if (has_a) more_a = next(a_, pair.a, result_.a);
      if (has_b) more_b = next(b_, pair.b, result_.b);
    }
    for (; more_a; more_a = next(a_, pair.a, result_.a))
      if (!exact(pair.a) && whole(b_.end())) take({pair.a, absent(pair.a.control_tick)});
    for (; more_b; more_b = next(b_, pair.b, result_.b))
      if (!exact(pair.b) && whole(a_.end())) take({absent(pair.b.control_tick), pair.b});
    finish();
  }

 private:
  static LogFrame absent(std::int64_t control_tick) {
    LogFrame frame;
    frame.control_tick = control_tick;
    return frame;
  }

  static bool next(LogFrames& log, LogFrame& frame, LogSide& side) {
    if (!log.next(frame)) return false;
    if (exact(frame)) ++side.control_ticks;
    return true;
  }

  void take(FramePair pair) {
    if (exact(pair.a) && exact(pair.b)) ++result_.both;
    const ChannelMask mask = compare_.compare(pair.a, pair.b);
    if (mask != 0) differs(pair, mask);
    if (!result_.first) {
      note_events(pair.a);
      before_.push_back(std::move(pair));
      if (before_.size() > static_cast<std::size_t>(options_.context)) before_.pop_front();
    } else {
      add_row_after(pair);
    }
  }

  void differs(const FramePair& pair, ChannelMask mask) {
    bool wanted = options_.all && sinks_.each;
    for (std::size_t c = 0; c < kDiffChannels; ++c) {
      if ((mask >> c & 1) == 0) continue;
      ++result_.channels[c].differing;
      wanted = wanted || !result_.channels[c].first;
    }
    if (!wanted) return;
    const TickDifference difference = describe(pair);
    for (const FieldDifference& field : difference.fields) {
      ChannelTotals& totals = result_.channels[static_cast<std::size_t>(field.channel)];
      if (totals.first) continue;
      totals.first = field;
      totals.first_control_tick = pair.a.control_tick;
    }
    if (!result_.first) {
      if ((mask & mask_of(DiffChannel::event)) == 0) note_events(pair.a);
      begin_first(pair, difference);
    }
    if (options_.all && sinks_.each) sinks_.each(difference);
  }

  TickDifference describe(const FramePair& pair) {
    TickDifference d;
    d.control_tick = pair.a.control_tick;
    compare_.compare(pair.a, pair.b, &d.fields);
    const LogFrame& named = pair.a.block ? pair.a : pair.b;
    if (named.block) d.block = named.block->block;
    d.place_a = place(pair.a, result_.a.header, place_a_);
    d.place_b = place(pair.b, result_.b.header, place_b_);
    if (d.fields.front().channel == DiffChannel::event) place_event(pair, d);
    return d;
  }

  struct KnownPlace {
    std::shared_ptr<const log::BlockRecord> block;
    ProgramPlace place;
  };
  /// Position of the current block; looked up once per block.
  static ProgramPlace place(const LogFrame& frame, const log::LogHeader& header, KnownPlace& known) {
    if (!frame.block) return {};
    if (known.block != frame.block) known = {frame.block, place_of(header, *frame.block)};
    return known.place;
  }

  /// An event has its own program line, not that of the motion.
  void place_event(const FramePair& pair, TickDifference& d) const {
    const auto line = [&](const LogFrame& frame) {
      for (const LogItem& item : frame.items)
        if (const auto* e = std::get_if<log::EventRecord>(&item); e && e->tick == d.fields.front().tick)
          return e->span.line;
      return std::uint32_t{0};
    };
    if (const auto n = line(pair.a); n > 0) d.place_a = place_of(result_.a.header, n);
    if (const auto n = line(pair.b); n > 0) d.place_b = place_of(result_.b.header, n);
  }

  void begin_first(const FramePair& pair, const TickDifference& difference) {
    FirstDifference first;
    first.tick = difference;
    if (difference.fields.front().channel >= DiffChannel::command)
      first.same = compare_.same_fields(pair.a, pair.b);
    context_field_ = "feed_u_s";
    for (const FieldDifference& field : difference.fields) {
      const bool of_ticks = field.channel == DiffChannel::command || field.channel == DiffChannel::load;
      if (!of_ticks || field.field == "control tick") continue;
      context_field_ = field.field;
      context_axis_ = field.axis;
      first.context_unit = field.unit;
      break;
    }
    if (first.context_unit.empty() && context_field_ == "feed_u_s")
      first.context_unit = unit_text(log::FieldUnit::path_speed, path_unit(result_.a.header), "");
    first.context_name = context_axis_.empty() ? context_field_ : context_axis_ + " " + context_field_;
    first.input = input_;
    first.event = event_;
    result_.first = std::move(first);
    for (const FramePair& before : before_) add_row(before);
    before_.clear();
    add_row(pair);
    at_first_ = true;
  }

  void add_row(const FramePair& pair) {
    ContextRow row;
    row.control_tick = pair.a.control_tick;
    const LogFrame& named = pair.a.block ? pair.a : pair.b;
    const log::LogHeader& header = pair.a.block ? result_.a.header : result_.b.header;
    if (named.block) row.place = place_of(header, *named.block).name();
    row.a = compare_.value(pair.a, true, context_field_, context_axis_);
    row.b = compare_.value(pair.b, false, context_field_, context_axis_);
    result_.first->rows.push_back(std::move(row));
  }

  void add_row_after(const FramePair& pair) {
    if (at_first_) {
      at_first_ = false;
      return;
    }
    if (after_ >= options_.context) return;
    ++after_;
    add_row(pair);
  }

  void note_events(const LogFrame& frame) {
    for (const LogItem& item : frame.items) {
      const auto* e = std::get_if<log::EventRecord>(&item);
      if (e == nullptr) continue;
      const std::string text =
          fmt::format("base tick {} ({:.6f} s): {}{}", text::grouped(e->tick.value),
                      result_.a.header.seconds(e->tick), e->text.empty() ? e->kind.text() : e->text,
                      e->span.line > 0 ? ", " + place_of(result_.a.header, e->span.line).name() : "");
      // actions of the operator or the scenario have no position in the program
      const bool found_by_kadr = e->kind == log::EventKind::alarm || e->kind == log::EventKind::residual;
      if (e->kind == log::EventKind::input || (e->span.line == 0 && !found_by_kadr))
        input_ = text;
      else
        event_ = text;
    }
  }

  void finish() {
    const auto side = [](const LogFrames& log, LogSide& s) {
      s.end = log.end();
      s.summary = log.summary();
    };
    side(a_, result_.a);
    side(b_, result_.b);
    result_.load_peaks = compare_.load_peaks();
    if (result_.a.summary && result_.b.summary)
      compare_.compare_summaries(*result_.a.summary, *result_.b.summary, result_.summary);
  }

  LogFrames &a_, &b_;
  const DiffOptions& options_;
  const TickDiffSinks& sinks_;
  LogDiff& result_;
  FrameCompare compare_;
  std::deque<FramePair> before_;  // the last equal control ticks
  std::string context_field_, context_axis_;
  KnownPlace place_a_, place_b_;
  int after_ = 0;
  bool at_first_ = false;
  std::string input_, event_;
};

}  // namespace

bool LogDiff::lengths_differ() const {
  const auto exact_data = [](const log::LogHeader& h) { return h.logs_ticks || h.logs_steps; };
  return exact_data(a.header) && exact_data(b.header) && a.control_ticks != b.control_ticks;
}

bool LogDiff::inputs_differ() const {
  return std::any_of(inputs.begin(), inputs.end(), [](const InputDifference& input) { return !input.same; });
}

tl::expected<LogDiff, log::LogReadError> diff_logs(const std::string& a, const std::string& b,
                                                   const DiffOptions& options, const TickDiffSinks& sinks) {
  auto of_a = LogFrames::open(a);
  if (!of_a) return tl::unexpected(of_a.error());
  auto of_b = LogFrames::open(b);
  if (!of_b) return tl::unexpected(of_b.error());
  LogDiff result;
  result.a.path = a;
  result.b.path = b;
  result.a.header = of_a->header();
  result.b.header = of_b->header();
  result.inputs = compare_inputs(result.a.header, result.b.header);
  result.compared = same_clock(result.a.header, result.b.header);
  if (sinks.begin) sinks.begin(result);
  if (result.compared) TickDiff(*of_a, *of_b, options, sinks, result).run();
  return result;
}

}  // namespace kadr::log_tools
