#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "gcode/reading_bounds.h"
#include "machine/base/diagnostic.h"
#include "planner/time_law/time_law.h"

/// Problems of time along a path, as files state them, and the laws that solve them (docs/time_law.md).
namespace kadr::studies {

inline constexpr double kMostNodes = 2'000'000;
inline constexpr std::size_t kMostPathAxes = 32;

struct PathAxis {
  std::string name;
  std::string unit;  ///< "deg", "mm" or "rad"
};

/// A path that is a stretch of a control program on a machine.
struct ProgramPath {
  std::string program;  ///< its file, as the problem names it
  std::string machine;
  std::uint32_t first_line = 0, last_line = 0;  ///< of the first and the last move
  planner::Path path{0};                        ///< of the whole program
  planner::Run run;                             ///< the stretch
  std::optional<planner::SplineFit> fit;        ///< instead of the lines
  double tolerance_mm = 0;                      ///< of the fit
  std::vector<std::uint32_t> line;              // [nodes], of the program
  std::vector<std::string> reasons;             ///< reasons of caps: "program", "junction X" ...
  std::vector<std::uint16_t> held_by;           // [nodes], index of a reason
};

/// A problem file as read.
struct TimeLawProblem {
  std::string name;
  std::vector<PathAxis> axes;
  std::vector<planner::FormulaAxis> formulas;  // [axes], of a path by formula
  std::optional<planner::TablePath> table;     ///< of a path by table
  std::optional<ProgramPath> program;          ///< of a path by program
  planner::LawProblem law;                     ///< units are mm along the path, those of `axes` else
  planner::TubeOptions tube;
  std::int32_t classical_levels = 1100;
  std::optional<double> jerk_mm_s3;
  Span size_span;        ///< where the number of nodes is stated
  Diagnostics warnings;  ///< of the program

  /// X' and X'' between nodes; this problem outlives it.
  planner::PathDerivatives path() const {
    if (program)
      return program->fit ? program->fit->path.derivatives()
                          : planner::derivatives(program->path, program->run);
    return table ? table->derivatives() : planner::derivatives(formulas, law.s_u.back());
  }
  /// The limit along the path, or the highest cap of a node if there is none; speeds are scaled by it.
  double scale_mm_s() const;
};

/// Reads sources[file] as a problem; a table, or a program and its machine, are in its folder or below, and are added to
/// the sources.
/// @param allowed  folders below which they may lie, too (--allow)
/// @return the problem, which passes check_problem(), or all mistakes found
/// @param bounds  of the program
/// @throws std::system_error for a table that is there and can't be read
tl::expected<TimeLawProblem, Diagnostics> read_time_law_problem(SourceSet& sources, std::uint32_t file,
                                                                const std::vector<std::string>& allowed = {},
                                                                const gcode::ReadingBounds& bounds = {});

}  // namespace kadr::studies
