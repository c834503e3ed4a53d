#pragma once
#include <string>
#include <string_view>

namespace kadr::text {

/// Beginning of an HTML page of charts, up to <body>: no script, light and dark, the colours of line_chart.h.
/// @param style  rules of CSS for the page's own lines
std::string chart_page_head(std::string_view title, std::string_view style);

}  // namespace kadr::text
