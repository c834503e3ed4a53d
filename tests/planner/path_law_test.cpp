#include <doctest/doctest.h>
#include <fmt/format.h>

#include "machine/machine.h"
#include "planner/limits/limits.h"
#include "planner/time_law/law_methods.h"
#include "planner_support.h"

namespace kadr::test {

using machine::PlanMethod;

namespace {

void check_law_plan(const planner::Path& path, const planner::FeedPlan& plan,
                    const machine::MachineModel& machine) {
  for (const planner::Violation& v : planner::verify(path, plan, machine))
    FAIL_CHECK(fmt::format("{} at {} s, segment {}, axis {}: {} (limit {})", v.what, v.time_s, v.segment,
                           v.axis, v.value, v.limit));
}

}  // namespace

TEST_CASE("random programs on random machines under a time law break no limit") {
  const std::uint64_t seed = environment("KADR_SEED", 1);
  const std::uint64_t count = environment("KADR_COUNT", 60);
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed + i);
    machine::MachineModel machine = random_machine(random);
    AxisValues end{};
    const planner::Path path = random_path(random, machine, end);
    machine.planner.method = random.chance(0.7) ? PlanMethod::certified : PlanMethod::tube;
    machine.planner.node_mm = random.decades(0.2, 5.0);
    CAPTURE(seed + i);
    CAPTURE(static_cast<int>(machine.planner.method));
    const auto plan = planner::plan(path, machine);
    CHECK_MESSAGE(plan.has_value(), plan.error().diagnostic.label);
    if (plan) check_law_plan(path, *plan, machine);
  }
}

TEST_CASE("on one line a certified law is the trapezoid but for one interval") {
  machine::MachineModel machine = trapezoid_machine();
  ProgramWriter program(machine);
  program.line(xyz(100), 100.0);
  const planner::Path path = program.take();
  const auto trapezoid = planner::plan(path, machine);
  machine.planner.method = PlanMethod::certified;
  const auto law = planner::plan(path, machine);
  REQUIRE(trapezoid);
  REQUIRE(law);
  CHECK(law->law.duration_s >= trapezoid->law.duration_s);
  CHECK(law->law.duration_s <= trapezoid->law.duration_s * 1.001);
}

TEST_CASE("a run that has no time law is K4008 with its place") {
  machine::MachineModel machine = plain_machine();
  machine.planner.method = PlanMethod::tube;
  ProgramWriter program(machine);
  program.line(xyz(100), 100.0);
  const planner::Path path = program.take();
  auto table = planner::limit_table(path, machine);
  REQUIRE(table);
  table->accel_u_s2[0] = 0.0;
  planner::PlannedRun out;
  const auto planned = planner::law_method(machine.planner.method)
                           .plan({planner::DirectJoints(path), *table, machine}, {0, 0}, out);
  REQUIRE(!planned);
  CHECK(planned.error().diagnostic.code == Code::law_not_found);
  CHECK(planned.error().diagnostic.label.find("acceleration limit of 0") != std::string::npos);
  CHECK(out.elements.empty());
}

}  // namespace kadr::test
