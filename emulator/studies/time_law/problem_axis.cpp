#include "emulator/studies/time_law/problem_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "emulator/studies/time_law/problem_bounds.h"
#include "emulator/studies/time_law/problem_machine.h"
#include "machine/base/numbers.h"

namespace kadr::studies {
namespace {

using machine::Bounds;
using machine::Node;
using machine::TableReader;

constexpr Bounds kValue{-1e8, 1e8};
constexpr Bounds kTurns{0, 1e5};
constexpr Bounds kPhase{-1e3, 1e3};
constexpr std::size_t kMostTerms = 64;  ///< waves, or steps, of an axis
constexpr std::size_t kMostNameLength = 32;
constexpr std::string_view kUnits[] = {"deg", "mm", "rad"};

class AxisReader {
 public:
  AxisReader(machine::MachineModel* machine, TimeLawProblem& out, machine::ReadContext& context)
      : machine_(machine), out_(out), context_(context) {}

  void read(const Node& node, bool by_table) {
    const machine::Entry* given = node.find("name");
    const bool named = given && given->value.kind == Node::Kind::text;
    TableReader keys(&node, named ? "axis." + given->value.text : "axis", node.span, context_);
    const auto name = read_name(keys);
    const std::string unit = read_limits(keys, name);
    if (by_table)
      refuse_formula(keys, unit);
    else
      read_formula(keys, unit);
    keys.finish();
    out_.axes.push_back({name.value, unit});
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
    auto name = keys.text("name");
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
  std::string read_limits(TableReader& keys, const machine::Reading<std::string>& name) {
    const machine::AxisModel* model = nullptr;
    if (machine_ && name.valid) model = find_problem_axis(*machine_, name, context_);
    const bool rotary = model && model->kind == machine::AxisKind::rotary;
    std::optional<std::size_t> otherwise;
    if (model) otherwise = rotary ? 0 : 1;
    const auto chosen = keys.word("unit", kUnits, otherwise);
    std::string unit(kUnits[chosen.value]);
    if (model && rotary == (unit == "mm"))
      tell(Code::problem_program, chosen.span,
           fmt::format("is {}, axis {} of machine {} is {}", unit, model->letter, machine_->name,
                       rotary ? "rotary" : "linear"));
    const double per_unit = unit == "rad" ? kPi / 180 : 1;
    const auto limit = [&](const std::string& key, const Bounds& bounds, double machine::AxisModel::*of) {
      std::optional<double> given;
      if (model) given = model->*of * per_unit;
      return keys.number(key, bounds, given).value;
    };
    out_.law.max_feed_u_s.push_back(
        limit(fmt::format("max_{}_s", unit), kSpeed, &machine::AxisModel::max_feed_u_s));
    out_.law.max_accel_u_s2.push_back(limit(fmt::format("max_acceleration_{}_s2", unit), kAcceleration,
                                            &machine::AxisModel::max_accel_u_s2));
    return unit;
  }

  void refuse_formula(TableReader& keys, const std::string& unit) {
    for (const std::string& key : {"offset_" + unit, "slope_" + unit}) {
      if (!keys.has(key)) continue;
      tell(Code::problem_path, keys.number(key, kValue).span, "the table already gives the axis's values",
           "keep one of the table and the formula");
    }
    for (const char* key : {"waves", "steps"}) {
      if (!keys.has(key)) continue;
      const std::vector<Node>& terms = keys.tables(key);
      tell(Code::problem_path, terms.empty() ? keys.header() : terms.front().span,
           "the table already gives the axis's values", "keep one of the table and the formula");
    }
  }

  void read_formula(TableReader& keys, const std::string& unit) {
    planner::FormulaAxis axis;
    axis.offset = keys.number("offset_" + unit, kValue, 0.0).value;
    axis.slope = keys.number("slope_" + unit, kValue, 0.0).value;
    const auto each = [&](const char* key, auto&& read) {
      const std::vector<Node>& terms = keys.tables(key);
      if (terms.size() > kMostTerms)
        tell(Code::problem_path, terms[kMostTerms].span,
             fmt::format("{} {}, at most {} are allowed", terms.size(), key, kMostTerms));
      for (const Node& term : terms) {
        TableReader of_term(&term, keys.path_of(key), term.span, context_);
        read(of_term);
        of_term.finish();
      }
    };
    each("waves", [&](TableReader& wave) {
      const double amplitude = wave.number("amplitude_" + unit, kValue).value;
      const double turns = wave.number("turns", kTurns).value;
      axis.waves.push_back({amplitude, turns, wave.number("phase_rad", kPhase, 0.0).value});
    });
    each("steps", [&](TableReader& step) {
      const double height = step.number("height_" + unit, kValue).value;
      const double at = step.number("at_mm", kPlace).value;
      axis.steps.push_back({height, at, step.number("width_mm", kLength).value});
    });
    out_.formulas.push_back(std::move(axis));
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
