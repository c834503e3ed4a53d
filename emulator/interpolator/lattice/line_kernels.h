#pragma once
#include <algorithm>

#include "emulator/interpolator/lattice/slot.h"

/// The inner loops of the line methods: an addition and a test of a sign per slot. a = |dx|, b = |dy|; the
/// deviation is F = a y - b x in coordinates that grow along the line.
namespace kadr::interpolator::lattice {

/// Basic evaluation function (paper 002, Fig. 1): the sign of F at the node decides. F stays in [-b, a).
struct ClassicLine {
  std::int64_t a, b, left_x, f = 0;
  ClassicLine(std::int64_t ax, std::int64_t by) : a(ax), b(by), left_x(ax) {}
  std::int64_t tested() const { return f; }
  std::int64_t value() const { return f; }
  /// True: X steps; false: Y steps.
  bool next() {
    const bool x = f >= 0 && left_x > 0;
    f += x ? -b : a;
    left_x -= x;
    return x;
  }
};

/// Half-step method (paper 002, Fig. 2): the sign of F' = F(x + 1/2, y + 1/2) decides; G = 2 F', so |F| <=
/// (a + b)/2, and the end is met without a count of axes.
struct HalfStepLine {
  std::int64_t a2, b2, offset, tie, g;
  /// @param tie_to_y  a line through a corner of a dual square steps Y there, like the way back of one that
  ///                  steps X
  HalfStepLine(std::int64_t a, std::int64_t b, bool tie_to_y = false)
      : a2(2 * a), b2(2 * b), offset(a - b), tie(tie_to_y ? 1 : 0), g(offset) {}
  std::int64_t tested() const { return g; }
  std::int64_t value() const { return (g - offset) / 2; }
  bool next() {
    const bool x = g >= tie;
    g += x ? -b2 : a2;
    return x;
  }
};

/// V_i recurrence (paper 002, eq. 2, as corrected in docs/papers.md): the longer axis steps in every slot,
/// the other one where V >= 0; |F| <= max(a, b)/2.
struct DiagonalLine {
  std::int64_t both, single, v;
  DiagonalLine(std::int64_t a, std::int64_t b)
      : both(2 * std::min(a, b) - 2 * std::max(a, b)),
        single(2 * std::min(a, b)),
        v(single - std::max(a, b)) {}
  std::int64_t tested() const { return v; }
  /// True: both axes step; false: the longer one alone.
  bool next() {
    const bool diagonal = v >= 0;
    v += diagonal ? both : single;
    return diagonal;
  }
};

/// Digital differential analyser: a register of an axis is raised by its length in every slot, and the axis
/// steps where it overflows. The modulus is the power of two above the longest axis.
struct DdaRegister {
  std::int64_t increment, modulus, sum;
  DdaRegister(std::int64_t length, std::int64_t register_modulus, bool preloaded)
      : increment(length), modulus(register_modulus), sum(preloaded ? register_modulus / 2 : 0) {}
  bool next() {
    sum += increment;
    const bool over = sum >= modulus;
    sum -= over ? modulus : 0;
    return over;
  }
};
/// @pre 0 <= longest < 2^62
constexpr std::int64_t dda_modulus(std::int64_t longest) {
  std::int64_t modulus = 1;
  while (modulus <= longest) modulus *= 2;
  return modulus;
}

/// Half-step circle within a quadrant, counter-clockwise from (R, 0) to (0, R): N = F' - 1/2 = F - x + y is
/// whole, so F' > 0 just where N >= 0, and there is no tie.
struct QuarterCircle {
  std::int64_t x, y, n;
  explicit QuarterCircle(std::int64_t radius) : x(radius), y(0), n(-radius) {}
  bool done() const { return x == 0; }
  bool next() {
    const bool inward = n >= 0;
    n += inward ? 2 - 2 * x : 2 + 2 * y;
    x -= inward;
    y += !inward;
    return inward;
  }
};

}  // namespace kadr::interpolator::lattice
