#include "emulator/cycle/monitor/block_ends.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

TEST_CASE("a block's end tells its own peaks and energies; a block within one control tick has none") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({1, 0.01, 1});
  StraightRun run(path, machine);
  std::vector<BlockEndRecord> records;
  BlockEnds ends(path, 1, records);
  // base follows the command by hand, so that the following error is base + link - command
  const auto tick = [&](double s_u, double base_u, double link_u, double positive_J, double total_J) {
    run.plant[0] = {base_u, 0, link_u, 0, 0};
    run.energy[0].positive_work_J = positive_J;
    run.energy[0].motor_work_J = total_J;
    ends.tick(run.tick(s_u, 10));
  };
  tick(0.5, 0.5, -0.02, 3, 2);
  tick(0.9, 0.8, 0.01, 5, 3);
  CHECK(records.empty());
  tick(1.5, 1.5, 0.5, 6, 3);  // the second block begins and ends in this tick
  REQUIRE(records.size() == 1);
  CHECK(records[0].tick == Ticks{30'000});
  CHECK(records[0].block == 0);
  CHECK(records[0].line == 1);
  CHECK(records[0].peak_link_u == std::vector<double>{0.02});
  CHECK(records[0].peak_following_u.at(0) == doctest::Approx(0.09));
  CHECK(records[0].positive_J == std::vector<double>{5});
  CHECK(records[0].recuperated_J == std::vector<double>{2});
  ends.finish(Ticks{30'000});
  REQUIRE(records.size() == 2);
  CHECK(records[1].block == 2);
  CHECK(records[1].line == 3);
  CHECK(records[1].peak_link_u == std::vector<double>{0.5});
  CHECK(records[1].positive_J == std::vector<double>{1});
  CHECK(records[1].recuperated_J == std::vector<double>{1});
  ends.finish(Ticks{30'000});
  CHECK(records.size() == 2);
}

TEST_CASE("without energies in the log a block's end has none") {
  const machine::MachineModel machine = test_machine(1);
  const planner::Path path = straight_path({1});
  StraightRun run(path, machine);
  std::vector<BlockEndRecord> records;
  BlockEnds ends(path, 1, records);
  TickView view = run.tick(0.5, 10);
  view.energy = nullptr;
  ends.tick(view);
  ends.finish(view.end);
  REQUIRE(records.size() == 1);
  CHECK(records[0].positive_J.empty());
  CHECK(records[0].peak_link_u.size() == 1);
}
