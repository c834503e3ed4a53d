#pragma once
#include <cstdint>
#include <set>
#include <vector>

#include "gcode/interpret/state.h"
#include "gcode/read/report.h"
#include "gcode/read/tree.h"

namespace kadr::gcode {

/// Computes expressions of a line with the parameters as they were before the line.
class Evaluator {
 public:
  /// Value of the tree with nodes [first, root]. Angles in degrees. Functions come from
  /// machine/base/numbers.h, so a program gives the same pulses on every machine.
  /// @return false if there is no value: a division by zero, an argument outside a function's domain, a
  /// parameter that
  ///         does not exist, an overflow. It is reported to `report` unless that is null or the value depends on
  ///         a parameter whose setting failed earlier. Of macro B a value may be vacant (kVacant).
  bool evaluate(const Line& line, std::int32_t first, std::int32_t root, const State& state, Report* report,
                double& value);
  /// True if the last evaluated expression read a parameter that may be wrong after an earlier error.
  bool doubtful() const { return doubtful_; }
  /// From here on the line sets this name: it exists, with the value 0 until the line has been run.
  void declare(std::int32_t name) {
    const auto at = static_cast<std::size_t>(name);
    if (declared_on_.size() <= at) declared_on_.resize(at + 1, 0);
    declared_on_[at] = line_;
  }
  void begin_line() { ++line_; }
  /// ROUND of macro B in a word goes to the places of its letter: so many steps make 1.
  void round_to(double steps_per_unit) { steps_per_unit_ = steps_per_unit; }

 private:
  bool node_value(const Line& line, const ExpressionNode& node, const State& state, double& value);
  bool read(const Line& line, const ExpressionNode& node, const State& state, double index, double& value);
  // evaluate_macro.cpp
  bool evaluate_macro(const Line& line, std::int32_t first, std::int32_t root, const State& state,
                      double& value);
  bool macro_node(const Line& line, const ExpressionNode& node, const State& state, double& value);
  bool read_macro(const Line& line, const ExpressionNode& node, const State& state, double index,
                  double& value);
  bool read_named(const Line& line, const ExpressionNode& node, const State& state, double& value);
  bool tell_not_given(const Line& line, const ExpressionNode& node, const State& state);
  bool fail(Code code, Span span, std::string label);

  bool is_declared(std::int32_t name) const {
    const auto at = static_cast<std::size_t>(name);
    return at < declared_on_.size() && declared_on_[at] == line_;
  }
  void tell_never_set(const Line& line, const ExpressionNode& node, const State& state, int number);

  std::vector<double> values_;              ///< [nodes of the line]
  std::set<int> told_;                      ///< parameters told as never set
  std::vector<std::uint64_t> declared_on_;  ///< [names], the last line that set it; 0: none
  std::uint64_t line_ = 1;                  ///< lines begun
  Report* report_ = nullptr;
  double steps_per_unit_ = 1;
  bool doubtful_ = false;
};

/// A whole number within 1e-4 of the value, as parameter numbers and P, T, H words need.
bool near_integer(double value, int& integer);

}  // namespace kadr::gcode
