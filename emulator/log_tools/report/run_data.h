#pragma once
#include <string>

#include "emulator/log_tools/report/page_data.h"

/// A run as a page's script reads it (emulator/pages/report/src/data.ts).
namespace kadr::log_tools {

/// Elements of a page that hold the run: JSON of its data, and packed arrays.
/// @param prefix     of the elements' ids, so that a page can hold several runs
/// @param with_path  the length of path at each piece too
std::string run_scripts(const PageData& data, const std::string& prefix, bool with_path);

/// JSON on one line as an element of HTML: no `<` in it can end the element.
std::string json_script(const std::string& id, const std::string& json);

}  // namespace kadr::log_tools
