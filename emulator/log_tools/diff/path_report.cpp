#include <fmt/format.h>

#include <algorithm>

#include "emulator/log_tools/diff/diff_report.h"
#include "emulator/text/text.h"
#include "emulator/text/units.h"
#include "machine/base/parse_number.h"
#include "machine/base/terminal_text.h"
#include "machine/tick_motion.h"

namespace kadr::log_tools {
namespace {

constexpr std::size_t kTextWidth = 64;
constexpr int kPathDecimals = 3;

std::string reason(const FeedPoint& p) {
  const auto reason = kLimitedBy.at(p.limited_by);
  return fmt::format("override {:.4g} %, limited by {}", 100 * p.override_used,
                     reason ? kLimitedBy.word(*reason) : "unknown");
}

std::string place_text(const std::shared_ptr<const log::BlockRecord>& block, const log::LogHeader& header) {
  if (!block) return "before the first block";
  return fmt::format("block {}, {}", block->block, place_of(header, *block).name());
}

std::string steps_text(const PathDiff& d) {
  if (!d.steps_compared) return "steps: not compared\n";
  std::string text;
  if (d.blocks_differing == 0)
    text = fmt::format("steps: the same sequence in {} of {}\n", text::grouped(d.blocks),
                       text::counted(d.blocks, "block"));
  else
    text = fmt::format("steps: {} of {} differ, first {}", text::grouped(d.blocks_differing),
                       text::counted(d.blocks, "block"), render_block_difference(*d.first_block, d.a.header));
  if (d.given_up) text += "steps: not compared after that: the logs are too far apart on the path\n";
  return text;
}

std::string feed_text(const PathDiff& d) {
  if (!d.feed_compared) return "feed: not compared\n";
  const std::string unit = text::speed_unit(d.unit);
  if (d.spans == 0)
    return fmt::format("feed: the same at every position of the path, within {} {}\n",
                       number_text(d.tolerance_u_s), unit);
  std::string text = fmt::format("feed: differs on {} {} of the path in {}; they diverge at\n",
                                 text::fixed(d.span_length_u, kPathDecimals), d.unit,
                                 text::counted(d.spans, "stretch", "stretches"));
  text += render_feed_span(*d.first_span, d);
  if (d.largest_span)
    text +=
        fmt::format("  largest difference {} {} at {} {}\n", text::significant(d.largest_span->largest_u_s),
                    unit, text::fixed(d.largest_span->largest_at_u, kPathDecimals), d.unit);
  return text;
}

std::string events_text(const PathDiff& d) {
  if (!d.events_compared) return "program's events: not compared\n";
  if (!d.event)
    return fmt::format("program's events: the same {}, in the same order\n", text::grouped(d.events));
  return fmt::format("program's events: differ from number {} on, {}: {} | {}\n",
                     text::grouped(d.event->number), d.event->place.name(),
                     text::one_line(d.event->a, kTextWidth), text::one_line(d.event->b, kTextWidth));
}

std::string time_text(const LogSide& side) {
  if (side.summary) return text::duration_text(side.header.seconds(side.summary->run.ticks));
  return text::duration_text(side.header.seconds(Ticks{side.control_ticks * side.header.control_tick_ticks}));
}

}  // namespace

std::string render_block_difference(const BlockDifference& d, const log::LogHeader& header) {
  std::string text = fmt::format("block {}, {}", d.a.block, place_of(header, d.a).name());
  if (!d.a.text.empty()) text += ": " + text::one_line(d.a.text, kTextWidth);
  text += '\n';
  if (!d.geometry.empty()) text += fmt::format("  not the same move: {}\n", displayable(d.geometry));
  for (const auto& count : d.counts)
    text += fmt::format("  {} pulses {} | {} ({:+d})\n", displayable(count.axis), text::grouped(count.a),
                        text::grouped(count.b), count.b - count.a);
  if (!d.order.empty()) text += fmt::format("  {}\n", displayable(d.order));
  return text;
}

std::string render_feed_span(const FeedSpan& span, const PathDiff& d) {
  const log::LogHeader& header = d.a.header;
  std::string text =
      fmt::format("  path {} to {} {}, {}", text::fixed(span.from_u, kPathDecimals),
                  text::fixed(span.to_u, kPathDecimals), d.unit, place_text(span.a.block, header));
  if (span.a.block && !span.a.block->text.empty())
    text += ": " + text::one_line(span.a.block->text, kTextWidth);
  text += '\n';
  const std::string unit = text::speed_unit(d.unit);
  for (const auto& [side, point] : {std::pair{&d.a, &span.a}, std::pair{&d.b, &span.b}})
    text += fmt::format("    {} {} at {:.6f} s, {}: {}\n", text::significant(point->feed_u_s), unit,
                        side->header.seconds(point->tick), reason(*point), displayable(side->path));
  return text;
}

std::string render_path_diff(const PathDiff& d) {
  const bool whole = log::is_sound(d.a.end.state) && log::is_sound(d.b.end.state);
  std::string text = d.differ() ? "logs differ, aligned by path length\n"
                     : whole    ? "no difference, aligned by path length\n"
                                : "no difference before a log breaks off, aligned by path length\n";
  text += steps_text(d) + events_text(d) + feed_text(d);
  text += fmt::format("path: {}\n",
                      d.paths_differ()
                          ? fmt::format("{} | {} {}", text::fixed(d.path_a_u, kPathDecimals),
                                        text::fixed(d.path_b_u, kPathDecimals), d.unit)
                          : fmt::format("{} {} in both", text::fixed(d.path_a_u, kPathDecimals), d.unit));
  text += fmt::format("time: {} | {}\n", time_text(d.a), time_text(d.b));
  for (const LogSide* side : {&d.a, &d.b})
    if (const std::string end = end_text(*side); !end.empty()) text += end + "\n";
  return text;
}

}  // namespace kadr::log_tools
