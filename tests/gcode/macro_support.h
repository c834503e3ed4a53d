#pragma once
#include <string>
#include <vector>

#include "support.h"

namespace kadr::gcode::test {

inline InterpretOptions of_fanuc() {
  InterpretOptions options;
  options.dialect = Dialect::fanuc;
  return options;
}
inline InterpretOptions of_haas() {
  InterpretOptions options;
  options.dialect = Dialect::haas;
  return options;
}

/// X of every move of a program without errors; {-777} if there are some.
inline std::vector<double> macro_xs(const std::string& text, const InterpretOptions& options = of_fanuc()) {
  const Outcome outcome = run(text, options);
  if (outcome.diagnostics.has_errors()) return {-777};
  std::vector<double> values;
  for (const LineOrArc& move : outcome.moves()) values.push_back(move.end[0]);
  return values;
}

/// The value of a right side: X of "#100=...".
inline double macro_value(const std::string& right_side, const InterpretOptions& options = of_fanuc()) {
  const std::vector<double> values = macro_xs("#100=" + right_side + "\nG0 X#100\n", options);
  return values.size() == 1 ? values[0] : -777;
}

/// The only error of a program and the line that it names.
struct MacroError {
  Code code = Code::broken_promise;
  std::uint32_t line = 0;
  bool operator==(const MacroError&) const = default;
};
inline MacroError macro_error(const std::string& text, const InterpretOptions& options = of_fanuc()) {
  MacroError found;
  const Outcome outcome = run(text, options);
  for (const Diagnostic& d : outcome.diagnostics.list()) {
    if (d.severity != Severity::error) continue;
    if (found.line != 0) return {};
    found = {d.code, d.span.line};
  }
  return found;
}

}  // namespace kadr::gcode::test
