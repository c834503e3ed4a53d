#pragma once
#include <array>
#include <cstdint>

/// Interpolators on the lattice of motor steps, in integers: which axis steps in which clock slot. All
/// numbers are in steps (h in paper 002). Nothing here allocates while it steps, throws, or knows a machine.
namespace kadr::interpolator::lattice {

inline constexpr int kMostAxes = 9;

/// Products that 64 bits don't hold.
__extension__ typedef __int128 Wide;

using Point = std::array<std::int64_t, kMostAxes>;  ///< a lattice node by axis; axes beyond the curve's are 0

/// A node of a plane curve.
struct PlaneNode {
  std::int64_t x = 0;
  std::int64_t y = 0;
  constexpr bool operator==(const PlaneNode&) const = default;
};

constexpr int sign_of(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
constexpr std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }
/// The nearest value that 64 bits hold: decisions are taken in full, a table shows this.
constexpr std::int64_t shown(Wide value) {
  return value > INT64_MAX ? INT64_MAX : value < INT64_MIN ? INT64_MIN : static_cast<std::int64_t>(value);
}

/// One clock slot: the axes that step in it, and the value that decided.
struct Slot {
  std::array<std::int8_t, kMostAxes> step{};  ///< -1, 0 or 1 by axis; all 0: an idle slot of a DDA
  bool forced = false;                        ///< the end decided, not the sign of the tested value
  std::int64_t value = 0;                     ///< F at the node before the slot
  std::int64_t tested = 0;    ///< value whose sign decided; its meaning depends on the method (tested_name)
  std::int64_t tested_y = 0;  ///< extra points: the second point
  double parameter = -1.0;    ///< t of a parametric curve at the crossing, in [0, 1]; else -1
};

/// An interpolator at work on one curve.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// The next clock slot; false when the curve has ended, or can't be followed further.
  virtual bool next(Slot& slot) = 0;
};

}  // namespace kadr::interpolator::lattice
