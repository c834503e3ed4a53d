#pragma once
#include "planner/time_law/formula_path.h"

namespace kadr::planner {

/// The seven-axis laying path on which the methods of paper 000 are measured: six rotary axes in rad and a
/// linear one in mm, 2846.9 mm in 893 nodes, two technology points. Closed form, made for this purpose; it
/// has the paper's limits.
struct ReferenceLaw {
  std::vector<FormulaAxis> axes;
  LawProblem problem;

  explicit ReferenceLaw(std::size_t nodes = 893);
  /// Another path of the kind, for runs over many: amplitudes, phases and steps drawn by a seed.
  static ReferenceLaw random(std::uint32_t seed, std::size_t nodes = 893);

 private:
  void place(std::size_t nodes);
};

/// As it stands in the paper: limits at end nodes, levels uniform, penalty by node.
ReferenceLaw paper_law(std::size_t nodes = 893);

}  // namespace kadr::planner
