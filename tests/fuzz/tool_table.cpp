#include <cmath>
#include <string>

#include "checks.h"
#include "gcode/read/tool_table.h"
#include "machine/base/require.h"

/// Tool tables: whatever the text, tools are finite and within their ranges, diagnostics can be printed, and a
/// table reads back from its own text.
namespace {

using namespace kadr;
using namespace kadr::gcode;

constexpr std::size_t kMaxText_bytes = 16384;

void check_tool(const Tool& tool) {
  require(tool.number >= 0 && tool.pocket >= 0, "numbers of tool and pocket are not negative");
  require(tool.orientation >= 0 && tool.orientation <= 9, "an orientation is a digit");
  for (const double v : tool.offset) require(std::isfinite(v), "offsets are finite");
  for (const double v : {tool.diameter_mm, tool.front_angle_deg, tool.back_angle_deg}) {
    require(std::isfinite(v), "diameters and angles are finite");
  }
}

bool same(const Tool& a, const Tool& b) {
  return a.number == b.number && a.pocket == b.pocket && a.offset == b.offset &&
         a.diameter_mm == b.diameter_mm && a.front_angle_deg == b.front_angle_deg &&
         a.back_angle_deg == b.back_angle_deg && a.orientation == b.orientation;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxText_bytes) return 0;
  SourceSet sources;
  const auto file = sources.add(SourceText("tools.tbl", {reinterpret_cast<const char*>(data), size}));
  Diagnostics diagnostics;
  const ToolTable table = read_tool_table(sources, file, diagnostics);
  for (const Tool& tool : table.tools) {
    check_tool(tool);
    require(table.find(tool.number) != nullptr, "a tool of the table is found");
  }
  fuzz::check_diagnostics(diagnostics, sources);

  const auto copy = sources.add(SourceText("copy.tbl", render_tool_table(table)));
  Diagnostics none;
  const ToolTable again = read_tool_table(sources, copy, none);
  require(!none.has_errors() && again.tools.size() == table.tools.size(), "a table reads back from its text");
  for (std::size_t i = 0; i < table.tools.size(); ++i) {
    require(same(table.tools[i], again.tools[i]), "a tool reads back from its text");
  }
  return 0;
}
