#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "planner/bezier/bezier.h"

namespace kadr::studies {

/// A t(S) and its errors.
struct LengthTableRow {
  std::string name;
  planner::ReparameterisationError error;
};

/// Properties of one curve of a chain.
struct BezierSegment {
  planner::Bezier curve;
  double length_mm = 0;
  planner::SmallestRadius smallest;
  double slowest_mm = 0, fastest_mm = 0;      ///< of |B'(t)|, sampled at 2001 points
  std::vector<LengthTableRow> length_tables;  ///< paper mode only
  int fitted_parts = 0;                       ///< of the table that keeps the feed to 1e-6
};

struct BezierStudy {
  std::vector<BezierSegment> segments;
  std::vector<planner::JointReport> joints;  ///< [segments - 1]
};

/// Control points as text, "0,0,0 2,2,4 5,-0.5,2", one text per curve.
/// @return the curves, or the error with its text
tl::expected<std::vector<planner::Bezier>, std::string> read_beziers(const std::vector<std::string>& texts);

/// @param paper  with the errors of t(S) by every method of paper 004 and the quintic tables
BezierStudy study_beziers(const std::vector<planner::Bezier>& curves, bool paper);

}  // namespace kadr::studies
