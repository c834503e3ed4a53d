#pragma once
#include <string>

#include "tests/storm/invariants.h"
#include "tests/storm/storm_case.h"

namespace kadr::storm {

/// A defect that the self-test puts into the storm's own checks, never into kadr.
enum class Planted : std::uint8_t { nothing, arc, crash, hang };

struct CheckOptions {
  std::string scratch;        ///< a folder for what a case writes; emptied before each
  std::string program;        ///< path of kadr, for what the world does to it; empty: nothing is done
  std::string failing_calls;  ///< path of the library for LD_PRELOAD
  Planted planted = Planted::nothing;
  int most_cpu_s = 20;  ///< of processor time for a case; the system ends what takes more
};

/// What came of a case.
struct Checked {
  std::string end;         ///< "complete", another outcome, or "refused: plan K4008"
  Verdict finding;         ///< the first invariant that does not hold
  Tally met;               ///< which checks had something to look at
  double cpu_s = 0;        ///< all runs of the case together
  std::int64_t ticks = 0;  ///< control ticks of its run
};

/// Looks at every invariant of a case, in this process. A crash, a hang and too much memory are for isolated_check().
/// @param seed  of what is drawn besides the case
Checked check_case(const StormCase& storm_case, std::uint64_t seed, const CheckOptions& options);

}  // namespace kadr::storm
