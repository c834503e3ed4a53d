#include <fmt/format.h>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/log_notes.h"
#include "emulator/log_tools/diff/diff_report.h"

namespace kadr::cli {
namespace {

using log_tools::DiffAlign;
using log_tools::DiffOptions;
using text::Json;

/// One JSON document, written piece by piece so that the list of `--all` is never held: the logs and their
/// inputs, the list, the rest.
class StreamedDocument {
 public:
  explicit StreamedDocument(Console& console) : console_(console) {}

  void begin(const Json& head) {
    const std::string text = text::json_text(head);
    console_.data(text.substr(0, text.size() - 2));  // without "\n}"
  }
  void begin_list(const char* name) { console_.data(fmt::format(",\n  \"{}\": [", name)); }
  void entry(const Json& entry) {
    console_.data((first_ ? "\n    " : ",\n    ") + text::json_line(entry));
    first_ = false;
  }
  void end_list() { console_.data(first_ ? "]" : "\n  ]"); }
  void end(const Json& tail) { console_.data("," + text::json_text(tail).substr(1) + '\n'); }

 private:
  Console& console_;
  bool first_ = true;
};

template <class Diff>
Json head(const Diff& diff, const char* align) {
  return {{"align", align}, {"a", json_of(diff.a)}, {"b", json_of(diff.b)}, {"inputs", json_of(diff.inputs)}};
}

/// Exit code of a comparison: inputs count only with --strict. A log whose messages contradict each other is
/// never the same as another one.
template <class Diff>
int answer(const Diff& diff, const Arguments& arguments, Console& console) {
  note_passed_over(diff.a.path, diff.a.end, console);
  note_passed_over(diff.b.path, diff.b.end, console);
  bool denied = false;
  for (const log_tools::LogSide* side : {&diff.a, &diff.b}) {
    const bool contradicts =
        side->end.state == log::LogState::damaged || side->end.state == log::LogState::altered;
    // the table says that a log was cut off
    if (contradicts || (console.options().quiet && !log::is_sound(side->end.state)))
      console.error(fmt::format("{}: {}", side->path, side->end.detail));
    denied = denied || contradicts;
  }
  return denied || diff.differ() || (arguments.strict && diff.inputs_differ()) ? kNo : kYes;
}

int by_tick(const Arguments& arguments, Console& console) {
  const DiffOptions& options = arguments.diff;
  const bool json = console.options().json, text = !json && !console.options().quiet;
  StreamedDocument document(console);
  const log_tools::LogDiff* logs = nullptr;
  log_tools::TickDiffSinks sinks;
  sinks.begin = [&](const log_tools::LogDiff& diff) {
    logs = &diff;
    if (text) console.data(log_tools::render_input_differences(diff.inputs));
    if (json) document.begin(head(diff, "tick"));
    if (json && options.all) document.begin_list("differences");
  };
  sinks.each = [&](const log_tools::TickDifference& d) {
    if (text) console.data(log_tools::render_tick_difference(d, *logs));
    if (json) document.entry(log_tools::json_of(d, logs->a.header));
  };
  const auto diff = log_tools::diff_logs(arguments.files[0], arguments.files[1], options, sinks);
  if (!diff) return unreadable_log(diff.error(), console);
  if (json && options.all) document.end_list();
  if (json) document.end(log_tools::json_of(*diff));
  if (text) console.data(log_tools::render_log_diff(*diff));
  return answer(*diff, arguments, console);
}

int by_path(const Arguments& arguments, Console& console) {
  const DiffOptions& options = arguments.diff;
  const bool json = console.options().json, text = !json && !console.options().quiet;
  StreamedDocument document(console);
  const log_tools::PathDiff* logs = nullptr;
  log_tools::PathDiffSinks sinks;
  sinks.begin = [&](const log_tools::PathDiff& diff) {
    logs = &diff;
    if (text) console.data(log_tools::render_input_differences(diff.inputs));
    if (json) document.begin(head(diff, "path"));
    if (json && options.all) document.begin_list("differences");
  };
  sinks.block = [&](const log_tools::BlockDifference& d) {
    if (text) console.data(log_tools::render_block_difference(d, logs->a.header));
    if (json) document.entry(log_tools::json_of(d, logs->a.header));
  };
  sinks.span = [&](const log_tools::FeedSpan& span) {
    if (text) console.data(log_tools::render_feed_span(span, *logs));
    if (json) document.entry(log_tools::json_of(span, logs->a.header));
  };
  const auto diff = log_tools::diff_paths(arguments.files[0], arguments.files[1], options, sinks);
  if (!diff) return unreadable_log(diff.error(), console);
  if (json && options.all) document.end_list();
  if (json) document.end(log_tools::json_of(*diff));
  if (text) console.data(log_tools::render_path_diff(*diff));
  return answer(*diff, arguments, console);
}

}  // namespace

int diff_logs(const Arguments& arguments, Console& console) {
  return arguments.diff.align == DiffAlign::path ? by_path(arguments, console) : by_tick(arguments, console);
}

}  // namespace kadr::cli
