#pragma once
#include <array>
#include <string_view>

namespace kadr {

/// The nine axis letters of a control program, in the order of every AxisValues.
inline constexpr int kProgramAxes = 9;
inline constexpr std::string_view kAxisLetters = "XYZABCUVW";
/// Values by program axis: mm for X Y Z U V W, degrees for A B C.
using AxisValues = std::array<double, kProgramAxes>;

/// Index of an axis letter in AxisValues, -1 if it is none.
constexpr int axis_index(char letter) {
  const auto at = kAxisLetters.find(letter);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}
constexpr bool is_rotary_letter(char letter) { return letter == 'A' || letter == 'B' || letter == 'C'; }

}  // namespace kadr
