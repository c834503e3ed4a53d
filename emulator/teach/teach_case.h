#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "emulator/interpolator/lattice/lattice.h"

/// `kadr teach`: interpolators step by step, for people who learn how they work.
namespace kadr::emulator {

/// How a path of several lines is followed: the axes together along it, or each at its own rate from node to
/// node (paper 002: CP and PTP).
enum class TeachMode : std::uint8_t { continuous, point_to_point };

/// What is to be interpolated: curves end to end, each given from its own beginning. Steps throughout.
struct TeachCase {
  std::string title;  ///< "line 7 4"
  std::string kind;   ///< "line"
  std::vector<lattice::Curve> legs;
  lattice::Point begin{};  ///< of the first leg
  int axes = 2;
};

/// The kinds of case with their words, for the help: "line DX DY [DZ ...]", ...
struct TeachKind {
  const char* name;
  const char* words;
  const char* meaning;
};
const std::vector<TeachKind>& teach_kinds();

/// Reads the words of a case: the kind and its numbers, in steps.
/// @param axes  of Beziers and polylines, whose words are taken in groups of so many
/// @return the case, or what is wrong with its words
tl::expected<TeachCase, std::string> read_teach_case(const std::vector<std::string>& words, int axes);

/// "6400 y - x^3": whole coefficients, powers of x and y, degree 6 at most.
tl::expected<lattice::Polynomial, std::string> read_polynomial(const std::string& text);

}  // namespace kadr::emulator
