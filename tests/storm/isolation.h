#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/storm/check_case.h"

/// Cases are looked at in processes of their own: a crash, a hang or too much memory is the finding of one seed, and the
/// storm goes on.
namespace kadr::storm {

struct SeedResult {
  std::uint64_t seed = 0;
  Checked checked;
  std::vector<std::string> features;
};

/// A case in a process of its own.
Checked isolated_check(const StormCase& storm_case, std::uint64_t seed, const CheckOptions& options);

struct StormOptions {
  std::uint64_t first = 1, last = 0;
  int jobs = 1;
  double minutes = 0;       ///< 0: no bound
  int world_per_mille = 0;  ///< share of the seeds to which the world does something
  CheckOptions check;       ///< scratch: a folder for the jobs' own ones
};

/// Whether the world does something to the case of a seed.
bool has_fault(std::uint64_t seed, const StormOptions& options);

/// Looks at the cases of all seeds, and hands on each result, in no order.
void storm(const StormOptions& options, const std::function<void(const SeedResult&)>& take);

}  // namespace kadr::storm
