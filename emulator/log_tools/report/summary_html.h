#pragma once
#include <string>

#include "emulator/log_tools/report/page_data.h"

namespace kadr::log_tools {

/// The run in tables of HTML, numbers as in the log's summary: time and what it went into, axes against their
/// limits, vibration and work, alarms and messages with their line. Rows with a place carry `data-t` (s) and
/// `data-line`, so that a script can jump there. Text from programs is escaped.
std::string summary_html(const PageData& data);

/// Drawings as SVG that need no script: path, feed, path error.
std::string chart_html(const PageData& data);

/// "part.ngc on mill3", for title and heading; not escaped.
std::string page_title(const PageData& data);

/// How the log ends, if not as it should; empty: it is complete.
std::string end_note(const PageData& data);

}  // namespace kadr::log_tools
