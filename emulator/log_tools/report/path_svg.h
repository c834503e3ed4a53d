#pragma once
#include <string>

#include "emulator/log_tools/report/page_data.h"

namespace kadr::log_tools {

/// The commanded path as SVG that needs no script, to scale: the first two linear axes that move, rapids
/// apart from feed moves. Empty for a machine with fewer than two linear axes.
std::string path_svg(const PageData& data);

}  // namespace kadr::log_tools
