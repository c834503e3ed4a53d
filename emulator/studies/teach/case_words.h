#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/interpolator/lattice/curve.h"
#include "machine/base/vocabulary.h"

/// The curve to interpolate, as words: `line 7 4`. Shared by `kadr teach` and its page, so nothing here throws.
namespace kadr::studies {

/// How a path of several lines is followed: the axes together along it, or each at its own rate from node to
/// node (paper 002: CP and PTP).
enum class TeachMode : std::uint8_t { continuous, point_to_point };
inline constexpr Vocabulary<TeachMode, 2> kTeachModes{{
    {TeachMode::continuous, "cp", "the axes together along the path"},
    {TeachMode::point_to_point, "ptp", "each axis at its own rate from node to node"},
}};
static_assert(kTeachModes.complete());

enum class CaseKind : std::uint8_t { line, polyline, arc, circle, ellipse, parabola, curve, bezier };
inline constexpr Vocabulary<CaseKind, 8> kCaseKinds{{
    {CaseKind::line, "line", "straight from the origin, 2 to 9 axes"},
    {CaseKind::polyline, "polyline", "lines from node to node; --axes, --mode ptp"},
    {CaseKind::arc, "arc", "about the origin; a full turn where both ends coincide"},
    {CaseKind::circle, "circle", "a full turn from (R, 0)"},
    {CaseKind::ellipse, "ellipse", "once around from (A, 0)"},
    {CaseKind::parabola, "parabola", "y^2 = 2 P x from Y0 to Y1"},
    {CaseKind::curve, "curve", "F = 0; ccw: F < 0 to the left of travel"},
    {CaseKind::bezier, "bezier", "from the origin, degree 1 to 3; --axes"},
}};
static_assert(kCaseKinds.complete());

/// The numbers that a kind of case takes, for the help: "DX DY [DZ ...]".
std::string_view case_numbers(CaseKind kind);

/// The curve to interpolate: curves end to end, each given from its own beginning. Steps throughout.
struct TeachCase {
  std::string title;  ///< "line 7 4"
  CaseKind kind = CaseKind::line;
  std::vector<interpolator::lattice::Curve> legs;
  interpolator::lattice::Point begin{};  ///< of the first leg
  int axes = 2;
};

/// Errors in the words of a case.
enum class CaseFault : std::uint8_t {
  none,
  kind,          ///< no such kind
  number,        ///< `word` is not a whole number of steps
  beyond,        ///< `word` is beyond kMostGiven_steps
  turn,          ///< the kind takes no ccw or cw
  count,         ///< `place` numbers are too few, too many or no whole number of points
  polynomial,    ///< `word` can't be read from character `place` on (from 1)
  degree,        ///< `word` is of degree `place`
  half_axes,     ///< of an ellipse: 1 to kMostHalfAxis_steps
  far_parabola,  ///< `word` is beyond kMostParabola_steps
  flat_parabola  ///< P is 0
};

inline constexpr std::int64_t kMostGiven_steps = std::int64_t{1} << 61;  ///< differences of two still fit
inline constexpr std::int64_t kMostHalfAxis_steps = 10'000;
inline constexpr std::int64_t kMostParabola_steps = std::int64_t{1} << 29;
inline constexpr int kMostPolynomialDegree = 6;

/// A case, or the error with its word.
struct CaseReading {
  TeachCase subject;
  CaseFault fault = CaseFault::none;
  std::string word;
  std::size_t place = 0;
};

/// Reads the words of a case: the kind and its numbers, in steps.
/// @param axes  of Beziers and polylines, whose words are taken in groups of this size
CaseReading read_case(const std::vector<std::string>& words, int axes);

/// "6400 y - x^3": whole coefficients, powers of x and y, degree kMostPolynomialDegree at most.
struct PolynomialReading {
  std::vector<interpolator::lattice::Term> terms;
  CaseFault fault = CaseFault::none;  ///< none, polynomial or degree
  std::size_t place = 0;
};
PolynomialReading read_terms(const std::string& text);

}  // namespace kadr::studies
