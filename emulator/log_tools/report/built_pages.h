#pragma once
#include <array>
#include <string>
#include <string_view>

namespace kadr::log_tools {

/// A page with script that kadr can write, if its tools were there when kadr was built.
struct BuiltPage {
  std::string_view name;     ///< "report", "compare", "teaching"
  std::string_view missing;  ///< why this build is without it and how to get it, one line; empty: built in
};

/// Made by cmake/pages.cmake and emulator/pages/report/template.cmake at configure time.
std::array<BuiltPage, 3> built_pages();

/// Why this build is without a page of built_pages(), as there; empty: built in.
std::string_view page_missing(std::string_view name);

/// At the foot of a page without script, as HTML: the reason; empty if it was requested, since this build
/// has the other one, too.
std::string plain_note(std::string_view name);

/// "report, compare, teaching", or "report, compare; without teaching: why; how to get it".
std::string pages_text();

}  // namespace kadr::log_tools
