#include "emulator/cycle/soft_limits.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::test;

namespace {

machine::MachineModel limited(double min_u, double max_u) {
  machine::MachineModel machine = test_machine(1);
  machine.axis[0].soft_min_u = min_u;
  machine.axis[0].soft_max_u = max_u;
  return machine;
}

/// Lines from 0 to each of the positions.
planner::Path path_through(const std::vector<double>& x_u) {
  planner::Path path = straight_path(std::vector<double>(x_u.size(), 1.0));
  for (std::size_t i = 0; i < x_u.size(); ++i) path.nodes_u[i + 1] = x_u[i];
  return path;
}

std::vector<std::uint32_t> lines(const planner::Path& path, const machine::MachineModel& machine) {
  Diagnostics diagnostics;
  check_soft_limits(path, machine, SoftLimitRule::error, diagnostics);
  std::vector<std::uint32_t> list;
  for (const Diagnostic& d : diagnostics.list()) list.push_back(d.span.line);
  return list;
}

}  // namespace

TEST_CASE("a block that leaves the soft limits is reported once, with its worst position") {
  planner::Path path = path_through({40, 55, 60, 10});
  for (planner::PathSegment& s : path.segments) s.block = s.block == 2 ? 1 : s.block;  // 55 and 60: one block
  const machine::MachineModel machine = limited(-5, 50);
  Diagnostics diagnostics;
  check_soft_limits(path, machine, SoftLimitRule::warning, diagnostics);
  REQUIRE(diagnostics.list().size() == 1);
  const Diagnostic& d = diagnostics.list()[0];
  CHECK(d.code == Code::soft_limit);
  CHECK(d.severity == Severity::warning);
  CHECK(d.span.line == 2);
  CHECK(d.label == "X reaches 60.000 mm, 10.000 mm beyond the limit");
  CHECK(d.notes.at(0) == "allowed -5.000 to 50.000 mm (axis X range_mm, machine coordinates)");
  Diagnostics refused;
  check_soft_limits(path, machine, SoftLimitRule::error, refused);
  CHECK(refused.errors() == 1);
}

TEST_CASE("a move that comes back from outside is not reported, one that goes further out is") {
  CHECK(lines(path_through({60, 55, 10}), limited(-5, 50)) == std::vector<std::uint32_t>{1});
  CHECK(lines(path_through({60, 65, 10}), limited(-5, 50)) == std::vector<std::uint32_t>{1, 2});
  CHECK(lines(path_through({-6, -5.5, 0}), limited(-5, 50)) == std::vector<std::uint32_t>{1});
  CHECK(lines(path_through({-5.0000000005, 50.0000000005}), limited(-5, 50)).empty());
}

TEST_CASE("a start outside of the limits belongs to the first block") {
  planner::Path path = path_through({-1, -2});
  CHECK(lines(path, limited(-10, -0.5)) == std::vector<std::uint32_t>{1});
}
