#pragma once
#include <cstddef>
#include <string>

#include "gcode/tree.h"
#include "machine/base/diagnostic.h"

namespace kadr::gcode {

/// Hands mistakes of a program to the caller's list, a bounded number of them: a broken file of a million
/// lines must neither fill memory nor the screen.
class Report {
 public:
  static constexpr std::size_t kMaxErrors = 1000;
  static constexpr std::size_t kMaxWarnings = 1000;

  explicit Report(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// Adds an error; beyond kMaxErrors it is dropped.
  void error(Diagnostic d);
  void warning(Diagnostic d);

  std::size_t errors() const { return errors_; }
  /// True as soon as reading on is of no use.
  bool full() const { return errors_ >= kMaxErrors; }
  /// Says what the bounds left out.
  void close(Span end);

 private:
  Diagnostics& diagnostics_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
};

/// A diagnostic with the code's title as its headline.
Diagnostic problem(Code code, Span span, std::string label, std::string help = {});

/// A length or angle for a message: shortest form within `decimals`, at least one digit: "5.6", "0.0283".
std::string figure(double value, int decimals = 4);

}  // namespace kadr::gcode
