#include "machine/machine.h"
#include "planner/time_law/law_methods.h"
#include "verified_plan.h"

namespace kadr::test {

TEST_CASE("every method that a machine can choose plans, and keeps what its row promises") {
  // two corners and an arc; verify() looks at the jerk of a method whose row says that it keeps it
  for (const auto& word : machine::kMachinePlanMethods) {
    CAPTURE(word.word);
    machine::MachineModel machine = plain_machine();
    machine.planner.method = word.value;
    ProgramWriter w(machine);
    w.line(xyz(40), 100.0);
    w.line(xyz(80, 1), 100.0);
    w.arc(gcode::Plane::xy, 80, 16, 1, xyz(80, 31), 100.0);
    CHECK(planned(w.take(), machine).law.duration_s > 0);
  }
}

TEST_CASE("methods have one list: those of machines and those of `kadr tube` are parts of it") {
  CHECK(machine::kMachinePlanMethods.list() == "scheduler, tube, certified, jerk-limited");
  CHECK(machine::kLawMethods.list() == "classical, tube, greedy, optimum, certified, jerk-limited");
  for (const auto& law : machine::kLawMethods) {
    CAPTURE(law.word);
    const planner::LawMethod& method = planner::law_method(law.value);
    CHECK((method.plan != nullptr) == machine::facts(law.value).plans);
    planner::LawSettings settings;
    settings.jerk_u_s3 = 1e4;
    CHECK(method.solver(settings)->name() == law.word);
  }
}

}  // namespace kadr::test
