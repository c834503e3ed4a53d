#include <cmath>
#include <string>

#include "checks.h"
#include "gcode/gcode.h"
#include "machine/base/require.h"

/// INI files: whatever the text, names are not empty, numbers are finite, diagnostics can be printed, and a program that
/// reads each value ends.
namespace {

using namespace kadr;
using namespace kadr::gcode;

constexpr std::size_t kMaxText_bytes = 16384;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxText_bytes) return 0;
  SourceSet sources;
  const auto file = sources.add(SourceText("machine.ini", {reinterpret_cast<const char*>(data), size}));
  Diagnostics diagnostics;
  InterpretOptions options;
  options.ini = read_ini_file(sources, file, diagnostics);
  std::string program;
  for (const IniValue& value : options.ini->values) {
    require(!value.name.empty(), "a value has a name");
    const auto number = ini_number(value.text);
    require(!number || std::isfinite(*number), "a number of an INI file is finite");
    if (program.size() < kMaxText_bytes) program += "#1=#<_ini[" + value.section + "]" + value.name + ">\n";
  }
  const auto reads = sources.add(SourceText("program.ngc", program));
  interpret(
      sources, reads, options, [](const Block&) {}, diagnostics);
  fuzz::check_diagnostics(diagnostics, sources);
  return 0;
}
