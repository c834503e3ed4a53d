#include "emulator/cycle/operator/place_on_path.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::test;

namespace {

using Kind = PathPlace::Kind;

OperatorStep step_on(PathPlace place) {
  OperatorStep step;
  step.place = place;
  return step;
}

}  // namespace

TEST_CASE("a place is a length of path, or a distance behind the beginning of a line's pass or of a block") {
  planner::Path path = straight_path({10, 20, 30});
  path.segments[2].span.line = 2;       // the second pass of line 2
  path.segments[1].feed_length_u = 10;  // its feed measures half of the way
  OperatorStep timed;
  timed.tick = ControlTicks{5};
  const std::vector<OperatorStep> steps = {step_on({Kind::length, 12.5}),    timed,
                                           step_on({Kind::line, 2, 1, 2.5}), step_on({Kind::line, 2, 2, 0}),
                                           step_on({Kind::block, 0, 1, 7}),  step_on({Kind::block, 1, 1, 15}),
                                           step_on({Kind::length, 50, 1, 0})};
  Diagnostics diagnostics;
  // feeds measure 10 + 10 + 30: a length of 12.5 lies 2.5 of 10 into the second line, which is 20 long
  CHECK(place_on_path(steps, path, 3, 0, diagnostics) == std::vector<double>{15, 0, 15, 30, 7, 35, 60});
  CHECK(diagnostics.list().empty());
}

TEST_CASE("a place beyond the path, a line and a block without motion are errors of the step") {
  const planner::Path path = straight_path({10, 20});
  const std::vector<OperatorStep> steps = {step_on({Kind::length, 30.5}), step_on({Kind::line, 9}),
                                           step_on({Kind::line, 1, 2}), step_on({Kind::block, 2}),
                                           step_on({Kind::block, 1, 1, 21})};
  Diagnostics diagnostics;
  place_on_path(steps, path, 2, 0, diagnostics);
  std::vector<std::string> labels;
  for (const Diagnostic& d : diagnostics.list()) {
    CHECK(d.code == Code::scenario_step);
    CHECK(d.notes.at(0) == "the program has 2 motion blocks and a path of 30");
    labels.push_back(d.label);
  }
  CHECK(labels == std::vector<std::string>{"path length 30.5 and 0 after it is beyond the path",
                                           "line 9 of the program starts no motion",
                                           "pass 2 of line 1 of the program starts no motion",
                                           "block 2 of the program starts no motion",
                                           "block 1 and 21 after it is beyond the path"});
  // a line of another file is not the program's
  Diagnostics other;
  place_on_path({step_on({Kind::line, 1})}, path, 2, 1, other);
  CHECK(other.errors() == 1);
}
