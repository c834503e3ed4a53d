#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/log_tools/report/page_data.h"

namespace kadr::log_tools {

/// The page's frame with script and style, made from emulator/pages/report at build time; empty where
/// page_missing("report") says why.
std::string_view report_template();

/// Reads stretches of the run's log once more (read_full_rate); empty: there is none to read.
using ReadFullRate = std::function<FullRate(const PageData& data, const std::vector<Stretch>& stretches)>;

/// One self-contained HTML page of a run: a pure function of the log. Without a template the plain form:
/// tables and SVG charts, no script.
/// @param max_bytes  the page's size; a longer run is shown by the lowest and highest value of several
///                   control ticks (data.every grows), and by each control tick round what matters
std::string render_report_page(PageData data, std::size_t max_bytes, const ReadFullRate& again);

/// A run's data as elements of a page, brought to a size: data.every grows until it fits.
/// @param prefix, with_path  as of run_scripts
std::string fitted_run(PageData& data, std::size_t most_bytes, const std::string& prefix, bool with_path,
                       const ReadFullRate& again);

/// The template with its marks filled; title as XML text, the others as HTML.
std::string filled_template(const std::string& title, const std::string& summary, const std::string& charts,
                            const std::string& data);

/// The plain form, whatever the build: tables and drawings, no script.
std::string render_plain_page(const PageData& data);

}  // namespace kadr::log_tools
