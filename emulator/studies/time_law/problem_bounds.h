#pragma once
#include "machine/file/table_reader.h"
#include "planner/time_law/time_law.h"

/// Ranges of keys of a problem file that more than one reader uses. The outer ends are far
/// beyond any path: they keep squares, products and angles of the values within reach.
namespace kadr::studies {

inline constexpr machine::Bounds kSpeed{1e-6, 1e9};
inline constexpr machine::Bounds kAcceleration{1e-6, 1e12};
inline constexpr machine::Bounds kPlace{-1e9, 1e9};
inline constexpr machine::Bounds kLength{1e-3, 1e9};

/// Key `ends` of [path]: end conditions of a spline.
inline planner::SplineEnds read_spline_ends(machine::TableReader& keys) {
  return keys.choice("ends", planner::kSplineEnds, planner::SplineEnds::not_a_knot).value;
}

}  // namespace kadr::studies
