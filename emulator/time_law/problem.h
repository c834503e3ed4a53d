#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "machine/base/diagnostic.h"
#include "planner/time_law/time_law.h"

/// Problems of time along a path, as files state them, and the laws that solve them (docs/time_law.md).
namespace kadr::emulator {

inline constexpr double kMostNodes = 2'000'000;
inline constexpr std::size_t kMostPathAxes = 32;

struct PathAxis {
  std::string name;
  std::string unit;  ///< "deg", "mm" or "rad"
};

/// A problem file as read.
struct TimeLawProblem {
  std::string name;
  std::vector<PathAxis> axes;
  std::vector<planner::FormulaAxis> formulas;  // [axes], of a path by formula
  std::optional<planner::TablePath> table;     ///< of a path by table
  planner::LawProblem law;                     ///< units are mm along the path, those of `axes` else
  planner::TubeOptions tube;
  std::int32_t classical_levels = 1100;
  std::optional<double> jerk_mm_s3;
  Span size_span;  ///< what the number of nodes comes from

  /// X' and X'' between nodes; this problem outlives it.
  planner::PathDerivatives path() const {
    return table ? table->derivatives() : planner::derivatives(formulas, law.s_u.back());
  }
};

/// Reads sources[file] as a problem; a table lies beside it and is added to the sources.
/// @return the problem, which check_problem() finds nothing wrong with, or all mistakes found
/// @throws std::system_error for a table that is there and can't be read
tl::expected<TimeLawProblem, Diagnostics> read_time_law_problem(SourceSet& sources, std::uint32_t file);

}  // namespace kadr::emulator
