#include "gcode/flow/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gcode/flow/arithmetic.h"
#include "gcode/interpret/predefined.h"
#include "gcode/interpret/words.h"
#include "gcode/read/scanner.h"

namespace kadr::gcode {
namespace {

constexpr double kIntegerTolerance = 1e-4;  // RS-274/NGC
constexpr double kLargestInteger = 1e9;

}  // namespace

bool near_integer(double value, int& integer) {
  if (!(std::fabs(value) <= kLargestInteger)) return false;
  const double nearest = std::floor(value + 0.5);
  if (std::fabs(value - nearest) > kIntegerTolerance) return false;
  integer = static_cast<int>(nearest);
  return true;
}

bool Evaluator::evaluate(const Line& line, std::int32_t first, std::int32_t root, const State& state,
                         Report* report, double& value) {
  if (values_.size() < line.nodes.size()) values_.resize(line.nodes.size());
  report_ = report;
  doubtful_ = false;
  if (state.macros.on) return evaluate_macro(line, first, root, state, value);
  // operands stand before their node
  for (std::int32_t i = first; i <= root; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!node_value(line, line.nodes[at], state, values_[at])) return false;
    if (!std::isfinite(values_[at])) {
      return fail(Code::value_too_large, line.span(line.nodes[at].own),
                  "the result here is not a finite number");
    }
  }
  value = values_[static_cast<std::size_t>(root)];
  return true;
}

bool Evaluator::node_value(const Line& line, const ExpressionNode& node, const State& state, double& value) {
  const auto operand = [&](std::int32_t i) { return values_[static_cast<std::size_t>(i)]; };
  Arithmetic result;
  switch (node.kind) {
    case NodeKind::number:
      value = node.value;
      return true;
    case NodeKind::named:
      return read_named(line, node, state, value);
    case NodeKind::exists: {
      int number = 0;
      value = near_integer(operand(node.left), number) && number >= parameter::kFirst &&
                      number <= parameter::kLast
                  ? 1
                  : 0;
      return true;
    }
    case NodeKind::exists_named:
      value = is_predefined(node.left) || find_named(state, node.left) != nullptr || is_declared(node.left);
      return true;
    case NodeKind::parameter:
      return read(line, node, state, operand(node.left), value);
    case NodeKind::negate:
      value = -operand(node.left);
      return true;
    case NodeKind::plus:
    case NodeKind::group:
      value = operand(node.left);
      return true;
    case NodeKind::comma:
    case NodeKind::power:
      break;  // of macro B alone
    case NodeKind::atan:
      value = atan_deg(operand(node.left), operand(node.right));
      return true;
    case NodeKind::binary:
      result = apply(node.operation, operand(node.left), operand(node.right));
      break;
    case NodeKind::function:
      result = apply(node.operation, operand(node.left));
      break;
  }
  value = result.value;
  if (result.refusal.empty()) return true;
  const Code code = result.divided_by_zero ? Code::division_by_zero : Code::function_domain;
  return fail(code, line.span(node.own), std::move(result.refusal));
}

bool Evaluator::read(const Line& line, const ExpressionNode& node, const State& state, double index,
                     double& value) {
  if (state.uncertain.parameters) doubtful_ = true;
  int number = 0;
  if (!near_integer(index, number) || number < parameter::kFirst || number > parameter::kLast) {
    return fail(Code::parameter_range, line.span(node.own),
                fmt::format("parameter {}, allowed: whole numbers from {} to {}", index, parameter::kFirst,
                            parameter::kLast));
  }
  const bool position = (number >= parameter::kPosition && number <= parameter::kPositionLast) ||
                        (number >= parameter::kMachine && number <= parameter::kMachineLast);
  if (position && state.compensating()) {
    return fail(Code::compensation_conflict, line.span(node.own),
                fmt::format("#{} tells where the tool is, which the next move decides", number));
  }
  value = read_parameter(state, number);
  const bool own = number >= parameter::kOwnFirst && number <= parameter::kOwnLast;
  if (own && !state.parameters_set[static_cast<std::size_t>(number)])
    tell_never_set(line, node, state, number);
  return true;
}

void Evaluator::tell_never_set(const Line& line, const ExpressionNode& node, const State& state, int number) {
  if (report_ == nullptr || state.uncertain.parameters || !told_.insert(number).second) return;
  report_->warning(problem(Code::parameter_never_set, line.span(node.own),
                           fmt::format("#{} is 0, because nothing has set it", number),
                           "set it at the beginning of the program, or correct the number"));
}

bool Evaluator::read_named(const Line& line, const ExpressionNode& node, const State& state, double& value) {
  if (is_predefined(node.left)) {
    value = read_predefined(state, node.left, line.number);
    return true;
  }
  const bool of_machine = is_machine_value(state.names[node.left]);
  if (state.uncertain.parameters && !of_machine) doubtful_ = true;
  if (const double* found = find_named(state, node.left)) {
    value = *found;
    return true;
  }
  if (is_declared(node.left)) {
    value = 0;
    if (report_ != nullptr) {
      report_->warning(
          problem(Code::parameter_never_set, line.span(node.own),
                  fmt::format("#<{}> is 0 here, because its first value takes effect after this line",
                              state.names[node.left]),
                  "set it on an earlier line"));
    }
    return true;
  }
  if (of_machine) return tell_not_given(line, node, state);
  return fail(Code::name_not_set, line.span(node.own),
              fmt::format("#<{}> has no value here", state.names[node.left]));
}

/// #<_ini[SECTION]NAME> or #<_hal[NAME]> without a value.
bool Evaluator::tell_not_given(const Line& line, const ExpressionNode& node, const State& state) {
  const std::string& name = state.names[node.left];
  const Span span = line.span(node.own);
  const std::size_t close = name.find(']');
  const auto tell = [&](std::string label, std::string help) {
    if (report_ != nullptr && !doubtful_)
      report_->error(problem(Code::value_not_given, span, std::move(label), std::move(help)));
    return false;
  };
  const bool hal = name.starts_with("_hal[");
  const std::string inside = name.substr(5, close == std::string::npos ? close : close - 5);
  if (hal)
    return tell(fmt::format("nothing gives the value of {}", inside),
                fmt::format("give it: --hal {}=VALUE", inside));
  if (state.ini == nullptr)
    return tell("no INI file is given, which this name asks", "name the machine's file: --ini FILE");
  std::string section = inside, key = close == std::string::npos ? "" : name.substr(close + 1);
  for (std::string* text : {&section, &key}) std::transform(text->begin(), text->end(), text->begin(), upper);
  const std::string wanted = fmt::format("[{}]{}", section, key);
  for (const IniValue& value : state.ini->values) {
    if (!same_letters(value.section, section) || !same_letters(value.name, key)) continue;
    if (value.section == section && value.name == key)
      return tell(fmt::format("{} of {} is '{}', which is no number", wanted, state.ini->name, value.text),
                  {});
    return tell(fmt::format("{} writes it [{}]{}", state.ini->name, value.section, value.name),
                fmt::format("write {} there: LinuxCNC asks for names in capitals", wanted));
  }
  return tell(fmt::format("{} has no {}", state.ini->name, wanted), {});
}

bool Evaluator::fail(Code code, Span span, std::string label) {
  if (report_ != nullptr && !doubtful_) report_->error(problem(code, span, std::move(label)));
  return false;
}

}  // namespace kadr::gcode
