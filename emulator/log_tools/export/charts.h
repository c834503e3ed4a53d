#pragma once
#include <string>
#include <vector>

#include "emulator/log_tools/export/envelope.h"
#include "emulator/log_tools/export/log_samples.h"
#include "emulator/text/line_chart.h"

namespace kadr::log_tools {

/// Reads the chosen signals to their end, each into at most `most` pieces of time.
std::vector<Envelope> read_envelopes(LogSamples& log, double from_s, std::size_t most);

/// A chart for each unit of the signals, in the order in which the units first come; signals of a chart that
/// are alike (axis.X.speed, axis.Y.speed) get lines of their own.
/// @param pieces  [signals]
std::vector<text::LineChart> charts_of(const std::vector<Signal>& signals,
                                       const std::vector<std::vector<Envelope::Piece>>& pieces);

/// One SVG document of charts one below the other, with its style sheet.
std::string svg_document(const std::string& title, const std::vector<text::LineChart>& charts);

}  // namespace kadr::log_tools
