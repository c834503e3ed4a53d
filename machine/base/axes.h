#pragma once
#include <array>
#include <string_view>

namespace kadr {

/// The nine axis letters of a control program, in the order of every AxisValues.
inline constexpr int kProgramAxes = 9;
inline constexpr std::string_view kAxisLetters = "XYZABCUVW";
/// Values by program axis: mm for X Y Z U V W, degrees for A B C.
using AxisValues = std::array<double, kProgramAxes>;

/// Two positions closer than this are the same, mm or deg: the residue of rounding decimals, offsets and sums
/// (a coordinate of 1e5 mm carries 1.5e-11), and a hundredth of the finest step (1e-7).
inline constexpr double kSamePoint_u = 1e-9;

/// Index of an axis letter in AxisValues, -1 if it is none.
constexpr int axis_index(char letter) {
  const auto at = kAxisLetters.find(letter);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}
constexpr bool is_rotary_letter(char letter) { return letter == 'A' || letter == 'B' || letter == 'C'; }

}  // namespace kadr
