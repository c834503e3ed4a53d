#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "emulator/interpolator/lattice/curve.h"
#include "emulator/interpolator/lattice/steppers.h"
#include "machine/step_method.h"

/// All that is said of a method of paper 002 beside its word: a row of methods.cpp.
namespace kadr::interpolator::lattice {

/// One enumeration for machines and laboratory; words and meanings: machine::kStepMethods.
using Method = machine::StepMethod;

struct MethodOptions {
  bool tie_to_y = false;         ///< half_step on a line: a line through a corner steps Y
  int fraction_bits = 16;        ///< progression, newton: 1 to 60
  double chord_tolerance = 0.1;  ///< chords: steps, > 0
};

/// What Slot's three numbers are called in a step table; empty: not shown.
struct Columns {
  std::string_view value = "F", tested = {}, tested_y = {};
};

/// The points whose F decides, for pictures.
enum class TestedAt : std::uint8_t {
  nowhere,
  node,
  half_step,      ///< half a step ahead in both coordinates
  beside_longer,  ///< between the neighbour along the longer axis and the diagonal one
  beside_both,    ///< the same beside each neighbour
  neighbours,     ///< both neighbours
};

template <class OneCurve>
using Maker = MadeStepper (*)(const OneCurve& curve, const MethodOptions& options);

struct MethodEntry {
  Method method;

  // makers by kind of curve; null: the method doesn't know it
  Maker<LineCurve> plane_line = nullptr;
  Maker<LineCurve> line = nullptr;  ///< of three axes or more
  Maker<ArcCurve> arc = nullptr;
  Maker<ParabolaCurve> parabola = nullptr;
  Maker<ImplicitCurve> graph = nullptr;  ///< F = c v + P(u) (explicit_axis)
  Maker<BezierCurve> bezier = nullptr;
  /// Follows any F(x, y) = 0 by this rule where there is no maker of its own: parabolas, conics, polynomials.
  std::optional<CurveRule> rule = {};

  // step tables and pictures
  Columns plane_line_columns = {};
  Columns line_columns = {};
  Columns arc_columns = {};
  Columns curve_columns = {};
  bool scaled = false;  ///< on curves F = 0 the table shows 2^degree times what is tested
  TestedAt tested_at = TestedAt::nowhere;

  /// The methods that follow lines and arcs on a machine that asks for this one: itself, or a similar one. Of
  /// every method of a machine.
  struct Followers {
    Method line, arc;
  };
  std::optional<Followers> on_machine = {};

  std::string_view name() const { return machine::kStepMethods.word(method); }
  std::string_view meaning() const { return machine::kStepMethods.sentence(method); }
};

/// Every method once, in the order of teaching; sweeps draw from it in this order.
std::span<const MethodEntry> methods();
std::optional<Method> method_of(std::string_view name);
const MethodEntry& entry_of(Method method);

}  // namespace kadr::interpolator::lattice
