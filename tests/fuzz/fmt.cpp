#include <algorithm>
#include <string>

#include "checks.h"
#include "gcode/gcode.h"
#include "machine/base/require.h"

/// kadr fmt: whatever the text, its form is final, keeps its lines, and means the same where it meant anything.
namespace {

using namespace kadr;
using namespace kadr::gcode;

constexpr std::size_t kMaxText_bytes = 16384;

struct Formed {
  std::string text;
  bool good = false;
};

/// What a program that begins with ";!" chooses, as for the target `program`: fanuc, haas, or linuxcnc.
Dialect dialect_of(const std::string& text) {
  if (text.size() < 3 || text.substr(0, 2) != ";!") return Dialect::linuxcnc;
  return text[2] == '(' ? Dialect::fanuc : text[2] == '!' ? Dialect::haas : Dialect::linuxcnc;
}

Formed form(const std::string& text) {
  SourceSet sources;
  const auto file = sources.add(SourceText("fuzz.ngc", text));
  Diagnostics diagnostics;
  Formed formed;
  formed.good = format_program(sources, file, diagnostics, formed.text, {}, dialect_of(text));
  require(formed.good == !diagnostics.has_errors(), "the result says whether there was a mistake");
  fuzz::check_diagnostics(diagnostics, sources);
  return formed;
}

/// The trace of a program, nothing if it is refused.
std::string trace(const std::string& text) {
  SourceSet sources;
  const auto file = sources.add(SourceText("/nowhere/fuzz.ngc", text));
  InterpretOptions options;
  options.dialect = dialect_of(text);
  options.bounds = {.blocks = 1000,
                    .lines = 50'000,
                    .messages = 1000,
                    .call_depth = 20,
                    .loop_passes = 1000,
                    .file_bytes = 1 << 20,
                    .line_bytes = 0};
  Diagnostics diagnostics;
  std::string out;
  interpret(
      sources, file, options,
      [&](const Block& block) {
        append_canon(out, block);
        out += '\n';
      },
      diagnostics);
  return diagnostics.has_errors() ? std::string() : out;
}

std::ptrdiff_t lines_of(const std::string& text) {
  const bool open = !text.empty() && text.back() != '\n';
  return std::count(text.begin(), text.end(), '\n') + (open ? 1 : 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kMaxText_bytes) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const Formed once = form(text);
  require(lines_of(once.text) == lines_of(text), "a form has the lines of its program");
  const Formed twice = form(once.text);
  require(twice.text == once.text, "a form is final");
  require(twice.good == once.good, "a form has mistakes where its program has");
  require(trace(once.text) == trace(text), "a form means the same");
  return 0;
}
