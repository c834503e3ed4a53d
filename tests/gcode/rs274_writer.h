#pragma once
#include <string>
#include <vector>

#include "support.h"

namespace kadr::gcode::test {

/// Writes the pieces of random valid programs that several families share: numbers in all their spellings and
/// expressions that have a value wherever they stand.
class Writer {
 public:
  explicit Writer(Random& source) : random(source) {}

  /// One of the choices.
  std::string pick(const std::vector<std::string>& choices) { return choices[random.below(choices.size())]; }
  /// A plain number with three decimals.
  std::string number(double low, double high) const;
  /// A number as people spell it: 5 5. .5 +5 005.20
  std::string spelled_number(double low, double high) const;
  /// A value as a word takes it: a number, a parameter, a function or an expression in brackets. Its size is
  /// that of a part (below 100), whatever the parameters hold.
  std::string word_value();
  /// An expression without the brackets around it.
  /// @param depth  operators within each other
  std::string expression(int depth);
  /// Something that stands where a value may stand; has a value for every state of the parameters.
  std::string operand(int depth);
  /// A readable parameter: numbered, named, computed, or one of the interpreter's state.
  std::string parameter();
  /// A parameter that may be set: "#31", "#<name>".
  std::string settable_parameter();
  /// The same name in another spelling: letter case, and blanks within.
  std::string respelled(const std::string& text) const;

  Random& random;
  std::vector<std::string> named;  ///< named parameters that have a value by now
};

}  // namespace kadr::gcode::test
