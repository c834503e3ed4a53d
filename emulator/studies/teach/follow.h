#pragma once
#include <string>
#include <vector>

#include "emulator/interpolator/lattice/lattice.h"
#include "emulator/studies/teach/case_words.h"

/// A case followed by a method. Shared by `kadr teach` and its page, so nothing here throws.
namespace kadr::studies {

/// A row of a step table: the node, its values, and the step in the slot that follows.
struct StepRow {
  interpolator::lattice::Point node{};
  interpolator::lattice::Slot slot;
  double deviation_steps = 0;  ///< of the node from the curve; with a sign where the curve has two sides
};

/// A case followed by a method to its end.
struct StepTable {
  interpolator::lattice::Method method = interpolator::lattice::Method::half_step;
  std::string value_name;   ///< meaning of Slot::value, empty: none
  std::string tested_name;  ///< meaning of Slot::tested
  std::string tested_y_name;
  int axes = 2;
  std::vector<StepRow> rows;  ///< one per slot; the node after the last slot is `last`
  StepRow last;
  interpolator::lattice::Point end{};  ///< where the case ends
  bool end_reached = false;
  std::int64_t pulses = 0, diagonals = 0, forced = 0, idle = 0;
  double worst_steps = 0;  ///< largest deviation, Euclidean distance
  double rms_steps = 0;
  double worst_square_steps = -1;  ///< largest deviation in the larger axis; -1: not measured on this curve
  std::uint64_t hash = 0;          ///< of the steps in order
  double length_steps = 0;         ///< of the ideal path
  /// Place on the ideal path at which each slot's axis crosses, [slots]; of half_step and crossing alone.
  std::vector<double> crossings_steps;
};

struct TeachOptions {
  interpolator::lattice::MethodOptions method;
  TeachMode mode = TeachMode::continuous;
  std::int64_t most_slots = 100'000;
};

/// A step table, or the reason why there is none.
struct Followed {
  StepTable table;
  interpolator::lattice::Refusal refusal = interpolator::lattice::Refusal::none;
  std::size_t leg = 0;    ///< that was refused
  bool complete = false;  ///< false and no refusal: more slots than allowed
};
Followed follow(const TeachCase& subject, interpolator::lattice::Method method, const TeachOptions& options);

}  // namespace kadr::studies
