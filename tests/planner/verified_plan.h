#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "planner_support.h"

/// Plans that verify() has looked at, and what it finds.
namespace kadr::test {

/// A plan without a broken limit.
inline planner::FeedPlan planned(const planner::Path& path, const machine::MachineModel& machine) {
  auto plan = planner::plan(path, machine);
  REQUIRE(plan);
  for (const auto& v : planner::verify(path, *plan, machine))
    FAIL_CHECK(v.what << " " << v.value << " " << v.limit << " at " << v.time_s);
  return std::move(*plan);
}

/// Whether verify() names a violation, however many there are.
inline bool finds(const planner::Path& path, const planner::FeedPlan& plan,
                  const machine::MachineModel& machine, const std::string& what) {
  planner::VerifyOptions options;
  options.most = 1'000'000;
  const auto found = planner::verify(path, plan, machine, options);
  return std::any_of(found.begin(), found.end(), [&](const auto& v) { return v.what == what; });
}

/// A straight line at 100 mm/s in equal blocks.
inline planner::Path straight(double length_mm, int blocks, const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  for (int i = 1; i <= blocks; ++i) w.line(xyz(length_mm * i / blocks), 100.0);
  return w.take();
}

/// 20 mm, then 20 blocks of 0.03 mm, each shorter than a control tick, then 20 mm.
inline planner::Path tiny_blocks(const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  w.line(xyz(20), 100.0);
  for (int i = 1; i <= 20; ++i) w.line(xyz(20 + 0.03 * i), 100.0);
  w.line(xyz(40.6), 100.0);
  return w.take();
}

inline doctest::Approx near(double x) { return doctest::Approx(x).epsilon(1e-9); }

}  // namespace kadr::test
