#include <doctest/doctest.h>

#include <cmath>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/time_law/certified.h"
#include "planner/time_law/stretch.h"
#include "planner_support.h"

namespace kadr::test {

using namespace kadr::planner;
using machine::PlanMethod;

namespace {

machine::MachineModel law_machine(const std::string& letters = "XYZ") {
  machine::MachineModel machine = trapezoid_machine(letters);
  machine.planner.method = PlanMethod::certified;
  return machine;
}

/// A line, a quarter circle, a line at an angle to it.
Path bent(const machine::MachineModel& machine) {
  ProgramWriter program(machine);
  program.line(xyz(40), 100.0);
  program.arc(gcode::Plane::xy, 40.0, 20.0, 1, xyz(60, 20), 100.0);
  program.line(xyz(70, 60), 60.0);
  return program.take();
}

}  // namespace

TEST_CASE("a whole path as a stretch has the time that a run by a time law has") {
  const machine::MachineModel machine = law_machine();
  const Path path = bent(machine);
  const auto table = limit_table(path, machine);
  REQUIRE(table);
  const Stretch stretch = state_stretch(path, *table, {0, path.size() - 1}, machine);
  REQUIRE(!check_problem(stretch.problem));
  const LawResult law = CertifiedLaw().solve(stretch.problem);
  REQUIRE(law);
  const auto run = plan(path, machine);
  REQUIRE(run);
  CHECK(law->time_s == doctest::Approx(run->law.duration_s).epsilon(1e-9));
  CHECK(stretch.problem.s_u.front() == 0.0);
  CHECK(stretch.problem.length_u() == doctest::Approx(path.length_u()).epsilon(1e-12));
  const LawCheck check = verify_law(stretch.problem, *law, derivatives(path, {0, path.size() - 1}));
  CHECK(check.broken.empty());
  CHECK(check.dense_excess <= 1e-6);
}

TEST_CASE("a stretch within a path begins at s = 0 with the speeds of its joints") {
  const machine::MachineModel machine = law_machine();
  const Path path = bent(machine);
  const auto table = limit_table(path, machine);
  REQUIRE(table);
  const Stretch arc = state_stretch(path, *table, {1, 1}, machine);
  CHECK(arc.problem.s_u.front() == 0.0);
  CHECK(arc.problem.length_u() == doctest::Approx(10.0 * kPi).epsilon(1e-9));
  CHECK(arc.problem.cap_u_s.front() == table->cap_u_s[2]);
  CHECK(arc.problem.cap_u_s.back() == table->cap_u_s[4]);
  CHECK(arc.problem.cap_u_s.front() > 0.0);
  CHECK(arc.held_by.front().reason == table->signature[2].reason);
  CHECK(arc.held_by.back().reason == LimitedBy::junction);
  for (const std::size_t segment : arc.segment) CHECK(segment == 1);
}

TEST_CASE("derivatives of a stretch are those of its segments, at a joint those behind it") {
  const machine::MachineModel machine = law_machine();
  const Path path = bent(machine);
  const PathDerivatives at = derivatives(path, {1, 2});
  double slope[3], curvature[3];
  // the arc from (40, 0) round (40, 20): X' = cos(s/20), Y' = sin(s/20), X'' = -sin(s/20)/20, Y'' = cos(s/20)/20
  for (const double s : {0.0, 7.0, 31.0}) {
    at(s, slope, curvature);
    CHECK(slope[0] == doctest::Approx(std::cos(s / 20.0)).epsilon(1e-12));
    CHECK(slope[1] == doctest::Approx(std::sin(s / 20.0)).epsilon(1e-12));
    CHECK(curvature[0] == doctest::Approx(-std::sin(s / 20.0) / 20.0).epsilon(1e-12));
    CHECK(curvature[1] == doctest::Approx(std::cos(s / 20.0) / 20.0).epsilon(1e-12));
  }
  at(path.start_s_u[2] - path.start_s_u[1], slope, curvature);
  CHECK(slope[0] == doctest::Approx(10.0 / std::sqrt(1700.0)).epsilon(1e-12));
  CHECK(curvature[1] == 0.0);
  at(1e6, slope, curvature);  // past the end its last segment continues
  CHECK(slope[1] == doctest::Approx(40.0 / std::sqrt(1700.0)).epsilon(1e-12));
}

TEST_CASE("random programs as stretches: the law keeps its limits, between nodes too but for 0.1 %") {
  const std::uint64_t count = environment("KADR_COUNT", 15);
  double worst = -1.0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    machine::MachineModel machine = random_machine(random);
    machine.planner.method = PlanMethod::certified;
    AxisValues end{};
    const Path path = random_path(random, machine, end);
    const auto table = limit_table(path, machine);
    REQUIRE(table);
    for (std::size_t first = 0, last = 0; first < path.size(); first = ++last) {
      while (table->cap_u_s[2 * last + 2] > 0.0) ++last;
      const Stretch stretch = state_stretch(path, *table, {first, last}, machine);
      REQUIRE(!check_problem(stretch.problem));
      const LawResult law = CertifiedLaw().solve(stretch.problem);
      REQUIRE(law);
      const LawCheck check = verify_law(stretch.problem, *law, derivatives(path, {first, last}));
      for (const LawViolation& b : check.broken)
        FAIL_CHECK(b.what, " at ", b.s_u, ": ", b.value, " > ", b.limit);
      if (machine.planner.axis_limits == machine::AxisLimitRule::enforce)
        worst = std::max(worst, check.dense_excess);
    }
  }
  MESSAGE("between nodes: ", worst);
  CHECK(worst <= 1e-3);
}

}  // namespace kadr::test
