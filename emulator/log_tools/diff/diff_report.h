#pragma once
#include <string>

#include "emulator/log_tools/diff/log_diff.h"
#include "emulator/log_tools/diff/path_diff.h"
#include "emulator/text/json.h"

/// The output of `kadr diff`; lines end in '\n'.
namespace kadr::log_tools {

/// "inputs differ:" with a line for each that does; empty if all are the same.
std::string render_input_differences(const std::vector<InputDifference>& inputs);

/// One line per field, for --all.
std::string render_tick_difference(const TickDifference& difference, const LogDiff& logs);
/// First difference with its surroundings, inputs, totals.
std::string render_log_diff(const LogDiff& diff);

std::string render_block_difference(const BlockDifference& difference, const log::LogHeader& header);
std::string render_feed_span(const FeedSpan& span, const PathDiff& diff);
std::string render_path_diff(const PathDiff& diff);

/// The same for programs; keys carry units, `_u` is mm or deg, as its "unit" says.
text::Json json_of(const std::vector<InputDifference>& inputs);
text::Json json_of(const LogSide& side);
text::Json json_of(const TickDifference& difference, const log::LogHeader& header);
text::Json json_of(const BlockDifference& difference, const log::LogHeader& header);
text::Json json_of(const FeedSpan& span, const log::LogHeader& header);
/// "differ", "first", "totals" ...: all but the logs and their inputs.
text::Json json_of(const LogDiff& diff);
text::Json json_of(const PathDiff& diff);

/// How a log ends, one line; empty if it is complete.
std::string end_text(const LogSide& side);

}  // namespace kadr::log_tools
