#include <doctest/doctest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "emulator/cli/console.h"
#include "emulator/cli/guard.h"
#include "emulator/cli/progress.h"
#include "machine/base/require.h"
#include "planner/planner.h"
#include "tests/support/run_program.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cli;

TEST_CASE("a broken promise of kadr ends with 70, the world's faults with 2, and all else as the work says") {
  const char* argv[] = {"kadr", "run", "my part.ngc"};
  const auto end_of = [&](auto thrown) { return guarded(3, argv, [&]() -> int { throw thrown; }); };
  CHECK(guarded(3, argv, [] { return 3; }) == 3);
  CHECK(guarded(3, argv, []() -> int {
          require(1 + 1 == 3, "one and one are three");
          return 0;
        }) == 70);
  CHECK(end_of(std::out_of_range("vector::at")) == 70);
  CHECK(end_of(WorldError("x.lcmlog: No space left on device")) == 2);
  CHECK(end_of(std::system_error(2, std::generic_category(), "x.ngc")) == 2);
  CHECK(end_of(std::bad_alloc()) == 2);
}

TEST_CASE("a broken plan ends a command with 70") {
  const char* argv[] = {"kadr", "check", "part.ngc"};
  const auto end_of = [&](const cycle::PlanFunction& plan) {
    return guarded(3, argv, [&] {
      test::TestInputs in = test::make_inputs("G1 X40 F1200\nM2\n", test::test_machine());
      Diagnostics diagnostics;
      return in.prepare(diagnostics, cycle::SoftLimitRule::error, plan) ? 0 : 1;
    });
  };
  CHECK(end_of({}) == 0);
  CHECK(end_of([](const planner::Path& path, const machine::MachineModel& machine,
                  std::span<const planner::Pause> pauses) {
          auto plan = planner::plan(path, machine, pauses);
          plan->law.pieces.pop_back();
          return plan;
        }) == 70);
}

TEST_CASE("the reproduction line can be pasted into a shell") {
  const char* argv[] = {"/usr/bin/kadr", "run", "my part.ngc", "it's.ngc", "--set", "a=1", ""};
  CHECK(shell_line(7, argv) == "kadr run 'my part.ngc' 'it'\\''s.ngc' --set a=1 ''");
  // what a terminal may not be shown, by its bytes
  const char* strange[] = {"kadr", "a\x1b[31m"};
  CHECK(shell_line(2, strange) == "kadr $'\\x61\\x1b\\x5b\\x33\\x31\\x6d'");
}

TEST_CASE("progress: 58.5 % of the path, 12.4 s of machine time in 0.3 s") {
  // 12.4 / 0.3 = 41.3; the rest takes 0.3 * 0.415 / 0.585 = 0.2 s
  CHECK(progress_bar(0.585, 701, 1190, 12.4, 0.3) ==
        "run  ███████░░░░░  58 %  line 701/1190  12.4 s of machine  41x real time  ETA 0:00");
  CHECK(progress_bar(0.5, 1, 2, 36000, 7200) ==
        "run  ██████░░░░░░  50 %  line 1/2  36000.0 s of machine  5.0x real time  ETA 2:00:00");
  CHECK(progress_bar(0, 1, 2, 0, 0) == "run  ░░░░░░░░░░░░   0 %  line 1/2  0.0 s of machine  0.0x real time");
  CHECK(progress_line(0.585, 701, 1190, 12.4) == "kadr: run 58 % line 701/1190 sim 12.4 s");
  CHECK(stage_bar("certified: pass 3", 0.5) == "tube  certified: pass 3  ██████░░░░░░  50 %");
  CHECK(stage_bar("optimum: step 12", -1) == "tube  optimum: step 12");
}
