#include "emulator/studies/time_law/problem_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "emulator/studies/time_law/problem_keys.h"
#include "emulator/studies/time_law/problem_machine.h"
#include "machine/base/numbers.h"

namespace kadr::studies {
namespace {

using machine::Node;
using machine::read_key;
using machine::TableReader;

constexpr std::size_t kMostTerms = 64;  ///< waves, or steps, of an axis
constexpr std::size_t kMostNameLength = 32;

class AxisReader {
 public:
  AxisReader(machine::MachineModel* machine, TimeLawProblem& out, machine::ReadContext& context)
      : machine_(machine), out_(out), context_(context) {}

  void read(const Node& node, bool by_table) {
    const machine::Entry* given = node.find(kPathAxisName.name);
    const bool named = given && given->value.kind == Node::Kind::text;
    TableReader keys(&node, named ? "axis." + given->value.text : "axis", node.span, context_);
    const auto name = read_name(keys);
    const PathUnit unit = read_limits(keys, name);
    if (by_table)
      refuse_formula(keys, unit);
    else
      read_formula(keys, unit);
    keys.finish();
    out_.axes.push_back({name.value, std::string(kPathUnits.word(unit))});
    if (out_.axes.size() == kMostPathAxes + 1)
      tell(Code::problem_path, node.span,
           fmt::format("is axis {}, at most {} are allowed", out_.axes.size(), kMostPathAxes));
  }

 private:
  void tell(Code code, const Span& span, std::string label, std::string help = "") {
    Diagnostic d = machine::file_diagnostic(code, span, std::move(label));
    d.help = std::move(help);
    context_.diagnostics.add(std::move(d));
  }

  machine::Reading<std::string> read_name(TableReader& keys) {
    auto name = keys.text(kPathAxisName.name);
    if (!name.valid) return {};
    const bool plain =
        !name.value.empty() && name.value.size() <= kMostNameLength && name.value != "s" &&
        std::all_of(name.value.begin(), name.value.end(), [](char c) {
          return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        });
    if (!plain)
      tell(Code::problem_path, name.span,
           fmt::format("a name has 1 to {} letters, digits and _, and is not s", kMostNameLength));
    if (std::any_of(out_.axes.begin(), out_.axes.end(),
                    [&](const PathAxis& axis) { return axis.name == name.value; }))
      tell(Code::problem_path, name.span, "another axis has this name");
    return name;
  }

  /// Speed and acceleration, of the machine if it is named and they are not given. @return the unit
  PathUnit read_limits(TableReader& keys, const machine::Reading<std::string>& name) {
    const machine::AxisModel* model = nullptr;
    if (machine_ && name.valid) model = find_problem_axis(*machine_, name, context_);
    const bool rotary = model && model->kind == machine::AxisKind::rotary;
    AxisWords words{rotary ? PathUnit::deg : PathUnit::mm};
    const auto chosen = read_key(keys, words, kPathAxisUnit, machine::AxisKind::linear, !model);
    const PathUnit unit = chosen.value;
    if (model && rotary == (unit == PathUnit::mm))
      tell(Code::problem_program, chosen.span,
           fmt::format("is {}, axis {} of machine {} is {}", kPathUnits.word(unit), model->letter,
                       machine_->name, rotary ? "rotary" : "linear"));
    const double per_unit = unit == PathUnit::rad ? kPi / 180 : 1;
    const auto limit = [&](const machine::NumberKey& key, double machine::AxisModel::*of) {
      std::optional<double> given;
      if (model) given = model->*of * per_unit;
      return read_axis_key(keys, key, unit, given).value;
    };
    out_.law.max_feed_u_s.push_back(limit(kPathAxisSpeed, &machine::AxisModel::max_feed_u_s));
    out_.law.max_accel_u_s2.push_back(limit(kPathAxisAcceleration, &machine::AxisModel::max_accel_u_s2));
    return unit;
  }

  void refuse_formula(TableReader& keys, PathUnit unit) {
    planner::FormulaAxis ignored;
    const auto refuse = [&](const auto& key) {
      if (!keys.has(in_unit(key.name, unit))) return;
      tell(Code::problem_path, read_axis_key(keys, ignored, key, unit).span,
           "the table already gives the axis's values", "keep one of the table and the formula");
    };
    std::apply([&](const auto&... key) { (refuse(key), ...); }, kFormulaKeys);
    for (const std::string_view key : {kAxisWaves.name, kAxisSteps.name}) {
      if (!keys.has(key)) continue;
      const std::vector<Node>& terms = keys.tables(key);
      tell(Code::problem_path, terms.empty() ? keys.header() : terms.front().span,
           "the table already gives the axis's values", "keep one of the table and the formula");
    }
  }

  void read_formula(TableReader& keys, PathUnit unit) {
    planner::FormulaAxis axis;
    read_axis_keys(keys, axis, kFormulaKeys, unit);
    read_terms(keys, kAxisWaves.name, kWaveKeys, unit, axis.waves);
    read_terms(keys, kAxisSteps.name, kStepKeys, unit, axis.steps);
    out_.formulas.push_back(std::move(axis));
  }

  /// The tables of one kind of term.
  template <class Term, class Keys>
  void read_terms(TableReader& keys, std::string_view name, const Keys& of_term, PathUnit unit,
                  std::vector<Term>& out) {
    const std::vector<Node>& terms = keys.tables(name);
    if (terms.size() > kMostTerms)
      tell(Code::problem_path, terms[kMostTerms].span,
           fmt::format("{} {}, at most {} are allowed", terms.size(), name, kMostTerms));
    for (const Node& term : terms) {
      TableReader table(&term, keys.path_of(name), term.span, context_);
      read_axis_keys(table, out.emplace_back(), of_term, unit);
      table.finish();
    }
  }

  machine::MachineModel* machine_;
  TimeLawProblem& out_;
  machine::ReadContext& context_;
};

}  // namespace

void read_problem_axis(const Node& node, bool by_table, machine::MachineModel* machine, TimeLawProblem& out,
                       machine::ReadContext& context) {
  AxisReader(machine, out, context).read(node, by_table);
}

}  // namespace kadr::studies
