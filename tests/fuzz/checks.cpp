#include "checks.h"

#include "emulator/text/json.h"
#include "emulator/text/sarif.h"
#include "machine/base/require.h"

namespace kadr::fuzz {
namespace {

// diagnostics of a text that are rendered: that costs more than reading it
constexpr std::size_t kFormatted = 5;

}  // namespace

void check_span(const Span& span, const SourceSet& sources) {
  require(span.file < sources.size(), "a span's file is one of the sources");
  require(span.line > 0 && span.column > 0 && span.length > 0, "a span has line, column and length");
  const SourceText& source = sources[span.file];
  const std::string_view line = source.line(span.line);
  // an empty line, or a text without any, has room for one caret
  require(span.column - 1 + span.length <= line.size() + 1, "a span ends at most one behind its line");
  require(!line.empty() || span.line == 1 || source.line(span.line - 1).data() != nullptr,
          "a span's line is within its text");
}

void check_diagnostics(const Diagnostics& diagnostics, const SourceSet& sources) {
  text::SarifLog sarif("/");
  std::size_t formatted = 0;
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.span.line != 0) check_span(d.span, sources);
    for (const Span& call : d.calls) check_span(call, sources);
    require(!d.message.empty(), "a diagnostic has a headline");
    if (++formatted > kFormatted) continue;
    require(!render_human(d, sources).empty(), "people are told");
    require(!render_human(d, sources, true).empty(), "people are told in colour");
    const std::string gcc = render_gcc(d, sources);
    require(!gcc.empty() && gcc.find('\0') == std::string::npos, "tools are told, without NUL");
    require(!text::json_line(text::json_of(d, sources)).empty(), "JSON is told");
    sarif.add(d, sources);
  }
  if (formatted > 0) require(!text::json_line(sarif.document(1)).empty(), "SARIF is told");
}

}  // namespace kadr::fuzz
