#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace kadr::studies {

/// The teaching page with script, style and the core in WebAssembly, made from emulator/pages/teach at build
/// time; empty where page_missing("teaching") says why.
std::string_view teach_template();

/// What the page opens with, as its address has it: "line,7,4,half_step",
/// "compare,arc,7,0,0,7,ccw,classic,half_step".
/// @param words    of the case; empty: the page's own
/// @param methods  one: step by step, several: side by side
std::string teach_address(const std::vector<std::string>& words, const std::vector<std::string>& methods);

/// One self-contained HTML page. An address in the browser's own line goes before `address`.
/// @pre teach_template() is not empty
std::string render_teach_page(const std::string& address);

}  // namespace kadr::studies
