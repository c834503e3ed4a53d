#pragma once
#include <memory>
#include <vector>

#include "emulator/interpolator/lattice/bezier_events.h"
#include "emulator/interpolator/lattice/curve.h"
#include "emulator/interpolator/lattice/line_kernels.h"
#include "emulator/interpolator/lattice/methods.h"
#include "emulator/interpolator/lattice/newton.h"
#include "emulator/interpolator/lattice/slot.h"

/// One door to all interpolators of paper 002: a curve and a method make a Stepper.
namespace kadr::interpolator::lattice {

enum class Refusal : std::uint8_t {
  none,
  no_length,     ///< both ends are the same node and the curve is no full turn
  range,         ///< coordinates beyond the range of the method's integers: most_steps()
  other_curve,   ///< the method doesn't know this kind of curve
  off_curve,     ///< an end is more than half a step off the curve
  one_quadrant,  ///< printed_half_step: begin and end lie in different quadrants
  in_line,       ///< a quadratic Bezier whose control points are in line is no conic
};

/// Largest coordinate for a method and kind of curve, in steps:
///   lines 2^60 (products of n axes in 128 bits), arcs and parabolas 2^29, Beziers by events 2^40, as conics
///   2^29; F(x, y) = 0: coordinates that keep 2^degree F below 2^125.
std::int64_t most_steps(const Curve& curve);

struct Made {
  std::unique_ptr<Stepper> stepper;  ///< null if refused
  Refusal refusal = Refusal::none;
};
Made make_stepper(const Curve& curve, Method method, const MethodOptions& options = {});
bool knows(Method method, const Curve& curve);

/// A whole run of a stepper.
struct Trace {
  int axes = 2;
  Point begin{};
  Point end{};               ///< node reached
  bool end_reached = false;  ///< it is the curve's end
  bool complete = false;     ///< the stepper ended by itself, not by the limit
  std::vector<Slot> slots;
  std::int64_t forced = 0;  ///< slots the end decided
  std::int64_t idle = 0;    ///< slots without a pulse
  std::uint64_t hash = 0;   ///< of the steps of all slots, in order (FNV-1a, a byte an axis)
};
Trace run(Stepper& stepper, const Curve& curve, std::int64_t most_slots);

}  // namespace kadr::interpolator::lattice
