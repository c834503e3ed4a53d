#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "emulator/log_tools/export/log_samples.h"

/// Logs in the forms that other tools read. Everything is written as it is read, so a log may be of any size,
/// and the same log gives the same bytes.
namespace kadr::log_tools {

/// Takes the next piece of text.
using Sink = std::function<void(std::string_view)>;

/// A head line with names and units, then a line a sample: `t_s` and the chosen signals, as many digits as
/// read back to the same number. An empty cell: nothing to tell.
void write_csv(LogSamples& log, CsvForm form, const Sink& sink);

/// An object a line, "channel" first: KADR_RUN, then blocks, events, diagnostics and samples (KADR_TICKS) as
/// they come, KADR_SUMMARY last.
void write_json_lines(LogSamples& log, const Sink& sink);

/// A value change dump (IEEE 1364): `X_step` and `X_dir` of every axis, `moving`, `accelerating`, `braking`,
/// `hold` and `alarm` as wires, the chosen signals as reals. A pulse is high for less than one base tick;
/// pulses of an axis in one base tick are separate within it.
void write_vcd(LogSamples& log, const Sink& sink);

/// One SVG document: a chart for each unit of the chosen signals, over time; each line keeps its lowest and
/// highest value of every pixel column.
void write_svg(LogSamples& log, const std::string& title, const Sink& sink);

/// A picture for each chosen signal over time, lowest and highest value of every column.
std::string render_plot(LogSamples& log, const PlotForm& form);
/// The commanded path seen along Z (of the first two linear axes), in true proportion.
std::string render_path_plot(LogSamples& log, const PlotForm& form);

}  // namespace kadr::log_tools
