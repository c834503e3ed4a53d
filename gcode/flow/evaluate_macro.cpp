#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "gcode/constants.h"
#include "gcode/flow/arithmetic.h"
#include "gcode/flow/evaluate.h"
#include "gcode/interpret/macro_variables.h"

/// Expressions of macro B. A vacant variable is passed on by brackets and signs; everything that calculates takes it
/// for 0, and EQ and NE tell it from 0.
namespace kadr::gcode {
namespace {

constexpr double kLargestBits = 2147483647;  // AND OR XOR: whole numbers of 32 bits

double or_zero(double value) { return is_vacant(value) ? 0 : value; }

bool equal_or_vacant(double a, double b) {
  return is_vacant(a) || is_vacant(b) ? is_vacant(a) && is_vacant(b) : a == b;
}

/// To the nearest whole number, half away from 0.
double to_nearest(double value) { return value < 0 ? -std::floor(0.5 - value) : std::floor(value + 0.5); }

/// MOD of whole numbers, with the sign of the dividend.
Arithmetic macro_modulo(double a, double b) {
  const double divisor = to_nearest(b);
  if (divisor == 0) return {0, "the divisor is 0", true};
  return {std::fmod(to_nearest(a), divisor), {}, false};
}

Arithmetic bitwise(Operation operation, double a, double b) {
  if (!(std::fabs(a) <= kLargestBits && std::fabs(b) <= kLargestBits))
    return {0, fmt::format("bits of {} and {}: allowed up to {:.0f}", a, b, kLargestBits), false};
  const auto x = static_cast<std::int64_t>(to_nearest(a));
  const auto y = static_cast<std::int64_t>(to_nearest(b));
  const std::int64_t bits = operation == Operation::logical_and  ? x & y
                            : operation == Operation::logical_or ? x | y
                                                                 : x ^ y;
  return {static_cast<double>(bits), {}, false};
}

Arithmetic macro_binary(Operation operation, double a, double b) {
  using enum Operation;
  if (operation == Operation::equal) return {equal_or_vacant(a, b) ? 1.0 : 0.0, {}, false};
  if (operation == not_equal) return {equal_or_vacant(a, b) ? 0.0 : 1.0, {}, false};
  if (operation == modulo) return macro_modulo(or_zero(a), or_zero(b));
  if (operation == logical_and || operation == logical_or || operation == logical_xor)
    return bitwise(operation, or_zero(a), or_zero(b));
  return apply(operation, or_zero(a), or_zero(b));
}

/// [0, 360)
double in_turn(double angle_deg) { return angle_deg < 0 ? angle_deg + kFullTurn_deg : angle_deg + 0.0; }

Arithmetic macro_function(Operation operation, double a, const MacroRules& rules) {
  if (operation == Operation::fix) return {std::trunc(a) + 0.0, {}, false};
  if (operation == Operation::fup) return {(a < 0 ? std::floor(a) : std::ceil(a)) + 0.0, {}, false};
  Arithmetic result = apply(operation, a);
  if (operation == Operation::asin && rules.angles_to_360) result.value = in_turn(result.value);
  return result;
}

double macro_atan(double y, double x, const MacroRules& rules) {
  // a zero has no sign here
  const double angle_deg = atan_deg(y + 0.0, x + 0.0);
  return rules.angles_to_360 ? in_turn(angle_deg) : angle_deg;
}

}  // namespace

bool Evaluator::evaluate_macro(const Line& line, std::int32_t first, std::int32_t root, const State& state,
                               double& value) {
  double* const values = values_.data();
  const ExpressionNode* const nodes = line.nodes.data();
  if (state.uncertain.parameters) doubtful_ = true;
  for (std::int32_t i = first; i <= root; ++i) {
    const ExpressionNode& node = nodes[i];
    double& result = values[i];
    // the operations of most loops come first, without a call
    if (node.kind == NodeKind::number) {
      result = node.value;
      continue;
    }
    if (node.kind == NodeKind::parameter) {
      const double index = values[node.left];
      const auto number = index >= 0 && index <= parameter::kLast ? static_cast<int>(index) : -1;
      if (is_macro_variable(number) && number == index)
        result = state.parameters[static_cast<std::size_t>(number)];
      else if (!read_macro(line, node, state, index, result))
        return false;
      continue;
    }
    if (!macro_node(line, node, state, result)) return false;
  }
  value = values[root];
  return true;
}

bool Evaluator::macro_node(const Line& line, const ExpressionNode& node, const State& state, double& value) {
  const auto operand = [&](std::int32_t i) { return values_[static_cast<std::size_t>(i)]; };
  Arithmetic result;
  switch (node.kind) {
    case NodeKind::number:
    case NodeKind::parameter:
    case NodeKind::exists:
    case NodeKind::exists_named:
    case NodeKind::named:
      return node_value(line, node, state, value);
    case NodeKind::negate:
      value = -operand(node.left);
      return true;
    case NodeKind::plus:
    case NodeKind::group:
      value = operand(node.left);
      return true;
    case NodeKind::comma:
      value = 0;
      return true;
    case NodeKind::atan:
      value = macro_atan(or_zero(operand(node.left)), or_zero(operand(node.right)), state.macros);
      return true;
    case NodeKind::power:
      result = apply(Operation::power, or_zero(operand(node.left)), or_zero(operand(node.right)));
      break;
    case NodeKind::binary: {
      const double a = operand(node.left), b = operand(node.right);
      const bool plain = a == a && b == b;
      if (plain && node.operation == Operation::add) {
        value = a + b;
        if (std::isfinite(value)) return true;
      } else if (plain && node.operation == Operation::subtract) {
        value = a - b;
        if (std::isfinite(value)) return true;
      } else if (plain && node.operation == Operation::less) {
        value = a < b ? 1 : 0;
        return true;
      }
      result = macro_binary(node.operation, a, b);
      break;
    }
    case NodeKind::function:
      if (node.operation == Operation::round) {
        result.value = to_nearest(or_zero(operand(node.left)) * steps_per_unit_) / steps_per_unit_ + 0.0;
        break;
      }
      result = macro_function(node.operation, or_zero(operand(node.left)), state.macros);
      break;
  }
  value = result.value;
  if (!result.refusal.empty()) {
    const Code code = result.divided_by_zero ? Code::division_by_zero : Code::function_domain;
    return fail(code, line.span(node.own), std::move(result.refusal));
  }
  if (std::isfinite(value)) return true;
  return fail(Code::value_too_large, line.span(node.own), "the result here is not a finite number");
}

/// A variable that is no plain storage.
bool Evaluator::read_macro(const Line& line, const ExpressionNode& node, const State& state, double index,
                           double& value) {
  int number = 0;
  if (!near_integer(index, number) || number < 0) {
    return fail(Code::parameter_range, line.span(node.own),
                is_vacant(index) ? "the number of this variable is vacant"
                                 : fmt::format("there is no variable {}", index));
  }
  if (is_macro_variable(number)) {
    value = state.parameters[static_cast<std::size_t>(number)];
    return true;
  }
  const bool computed = line.nodes[static_cast<std::size_t>(node.left)].kind != NodeKind::number;
  if (computed && is_input_variable(number)) {
    return fail(Code::system_variable, line.span(node.own),
                fmt::format("#{} is an input: write its number without an expression", number));
  }
  if (tells_position(number) && state.compensating()) {
    return fail(Code::compensation_conflict, line.span(node.own),
                fmt::format("#{} tells where the tool is, which the next move decides", number));
  }
  const std::optional<double> known = read_system_variable(state, number);
  if (!known) return fail(Code::system_variable, line.span(node.own), system_variable_text(number));
  value = *known;
  return true;
}

}  // namespace kadr::gcode
