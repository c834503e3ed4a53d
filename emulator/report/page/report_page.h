#pragma once
#include <string>
#include <string_view>

#include "emulator/report/page/page_data.h"

namespace kadr::emulator {

/// The page's frame with script and style, made from emulator/report/web at build time; empty in a build with
/// KADR_WEB=OFF.
std::string_view report_template();

/// One self-contained HTML page of a run: a pure function of the log. Without a template the plain form:
/// tables and SVG charts, no script.
/// @param max_bytes  the page's size; a longer run is shown by the lowest and highest value of several
/// control
///                   ticks (data.every grows)
std::string render_report_page(PageData data, std::size_t max_bytes);

/// The plain form, whatever the build.
std::string render_plain_page(const PageData& data);

}  // namespace kadr::emulator
