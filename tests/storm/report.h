#pragma once
#include <string>

#include "tests/storm/isolation.h"

namespace kadr::storm {

/// Counts what the cases of a storm had in them and how they ended.
class Report {
 public:
  void add(const SeedResult& result);
  std::uint64_t seeds() const { return seeds_; }
  /// The counts for people: how cases ended, which checks had something to look at, how often each feature was there.
  std::string text() const;

 private:
  std::uint64_t seeds_ = 0, findings_ = 0;
  Tally ends_, met_, features_;
  double cpu_s_ = 0, slowest_s_ = 0;
  std::uint64_t slowest_seed_ = 0;
};

}  // namespace kadr::storm
