#pragma once
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "gcode/gcode.h"

namespace kadr::gcode::test {

/// A line or an arc, laid out flat for checks; an arc's own members are 0 for a line.
struct LineOrArc : Arc {
  BlockKind kind{};
  Span span;
};

/// What a program text comes to.
struct Outcome {
  std::vector<Block> blocks;
  std::vector<std::string> trace;  ///< canonical lines without " @LINE"
  Diagnostics diagnostics;
  std::string rendered;  ///< diagnostics as people see them

  std::vector<Code> codes() const {
    std::vector<Code> codes;
    for (const Diagnostic& d : diagnostics.list()) codes.push_back(d.code);
    return codes;
  }
  std::vector<LineOrArc> moves() const {
    std::vector<LineOrArc> out;
    for (const Block& b : blocks) {
      if (!is<Traverse, Feed, Arc>(b)) continue;
      const Arc* arc = std::get_if<Arc>(&b.action);
      out.push_back({arc != nullptr ? *arc : Arc{*move_of(b)}, b.kind(), b.span});
    }
    return out;
  }
  /// The actions of one kind, in program order.
  template <class A>
  std::vector<A> all() const {
    std::vector<A> out;
    for (const Block& b : blocks)
      if (const A* action = std::get_if<A>(&b.action)) out.push_back(*action);
    return out;
  }
};

inline Outcome run(const std::string& text, const InterpretOptions& options = {},
                   const std::string& name = "part.ngc") {
  Outcome outcome;
  SourceSet sources;
  const std::uint32_t file = sources.add(SourceText(name, text));
  interpret(
      sources, file, options,
      [&](const Block& block) {
        outcome.blocks.push_back(block);
        std::string line;
        append_canon(line, block);
        if (!line.empty()) outcome.trace.push_back(line.substr(0, line.rfind(" @")));
      },
      outcome.diagnostics);
  for (const Diagnostic& d : outcome.diagnostics.list()) outcome.rendered += render_human(d, sources);
  return outcome;
}

/// End of the last move of an error-free program.
inline AxisValues last_point(const std::string& text, const InterpretOptions& options = {}) {
  const Outcome outcome = run(text, options);
  if (outcome.diagnostics.has_errors() || outcome.moves().empty()) return {-777, -777, -777};
  return outcome.moves().back().end;
}

/// X of the last move: the value of an expression in "G0 X[...]".
inline double evaluated(const std::string& expression) { return last_point("G0 X" + expression + "\n")[0]; }

/// The only code that a program is refused with, warnings aside; of one that is not refused, the code of its
/// only warning; broken_promise if there is none or several.
inline Code only_code(const std::string& text, const InterpretOptions& options = {}) {
  std::vector<Code> errors, warnings;
  const Outcome outcome = run(text, options);
  for (const Diagnostic& d : outcome.diagnostics.list())
    (d.severity == Severity::error ? errors : warnings).push_back(d.code);
  const std::vector<Code>& told = errors.empty() ? warnings : errors;
  return told.size() == 1 ? told[0] : Code::broken_promise;
}

inline std::uint64_t environment(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : fallback;
}
inline std::uint64_t seed() { return environment("KADR_SEED", 1); }
inline std::uint64_t count(std::uint64_t fallback) { return environment("KADR_COUNT", fallback); }

/// A small generator with the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) {}
  std::uint64_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return state_ * 0x2545F4914F6CDD1DULL >> 11;
  }
  std::uint64_t below(std::uint64_t n) { return bits() % n; }
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(bits()) / static_cast<double>(1ULL << 53);
  }
  bool chance(double p) { return real(0, 1) < p; }

 private:
  std::uint64_t state_;
};

}  // namespace kadr::gcode::test
