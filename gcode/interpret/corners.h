#pragma once
#include <optional>

#include "gcode/arc.h"
#include "gcode/block.h"

namespace kadr::gcode {

/// ,R or ,C behind a move: the corner that it makes with the next one.
struct CornerWish {
  bool rounded = true;  ///< ,R; else ,C: cut off
  double size_mm = 0;   ///< the radius, or what is cut off either move, > 0
  Span span;
};

/// What becomes of two moves and the corner between them.
struct CornerMoves {
  Block first;   ///< ends where the corner begins
  Block corner;  ///< an arc or a line
  Block second;  ///< begins where the corner ends
  AxisValues corner_end{};
};

/// Why there is no corner.
enum class CornerFault : std::uint8_t {
  none,
  too_large,    ///< it takes more of a move than there is
  other_axis,   ///< a move leaves the plane, or moves an axis beside it
  chamfer_arc,  ///< ,C at an arc
  straight,     ///< the moves go on in one direction: nothing to cut
};

/// Rounds or cuts the corner between two moves of a plane, each a line or an arc.
///
/// A rounding is the circle of radius R that touches both: its centre lies where the moves, shifted by R to the side
/// to which the corner turns, meet. A chamfer leaves out C of each line.
///
/// @param start  of the first move, machine coordinates, as `first` and `second` have them
CornerFault make_corner(const CornerWish& wish, Plane plane, const AxisValues& start, const Block& first,
                        const Block& second, CornerMoves& made);

}  // namespace kadr::gcode
