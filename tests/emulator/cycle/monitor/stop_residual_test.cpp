#include "emulator/cycle/monitor/stop_residual.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/straight_run.h"
#include "tests/support/test_machine.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;
using namespace kadr::test;

namespace {

/// Moves along the first of two blocks and stops with the given state of X.
struct StoppedRun {
  machine::MachineModel machine = test_machine(2);
  planner::Path path = straight_path({1, 1}, 2);
  EventList events{path};
  StraightRun run{path, machine};
  StopResidual residual{machine, events};

  StoppedRun(double link_u, double link_u_s) {
    residual.tick(run.tick(0.5, 10));
    run.plant[0].link_u = link_u;
    run.plant[0].link_u_s = link_u_s;
    residual.tick(run.tick(1.0, 0));
  }
  void rest(double link_u) {
    run.plant[0].link_u = link_u;
    residual.tick(run.tick(1.0, 0));
  }
};

}  // namespace

TEST_CASE(
    "the residual after a stop is the free link's envelope, reported with the next motion and its own "
    "block") {
  // w = 100 pi/3, zeta = 0.005: X^2 = x1^2 + ((v1 + zeta w x1)/wd)^2
  StoppedRun r(0.03, 4.0);
  r.rest(0.01);
  CHECK(r.events.list().empty());
  r.events.move_to(1);
  r.residual.tick(r.run.tick(1.1, 10));
  const double w = 104.71975511965977, wd = w * std::sqrt(1 - 0.005 * 0.005);
  const double expected_u = std::hypot(0.03, (4.0 + 0.005 * w * 0.03) / wd);
  REQUIRE(r.events.list().size() == 1);  // Y has a link, too, but did not move
  const EventRecord& e = r.events.list()[0];
  CHECK(e.kind == EventKind::residual);
  CHECK(e.axis == 0);
  CHECK(e.value == doctest::Approx(expected_u).epsilon(1e-12));
  CHECK(e.tick == Ticks{30'000});  // the beginning of the fourth control tick
  CHECK(e.block == 0);
  CHECK(e.span.line == 1);
  CHECK(e.text == "residual vibration of axis X after the stop 48.688 um");
}

TEST_CASE("a larger deflection while the machine stands is the residual; the summary keeps the worst stop") {
  StoppedRun r(0.03, 0);
  r.rest(-0.07);
  r.rest(0.02);
  r.residual.tick(r.run.tick(1.5, 10));
  REQUIRE(r.events.list().size() == 1);
  CHECK(r.events.list()[0].value == 0.07);
  r.run.plant[0].link_u = 0.05;
  r.residual.tick(r.run.tick(2.0, 0));
  r.residual.finish(Ticks{90'000});
  REQUIRE(r.events.list().size() == 2);
  CHECK(r.events.list()[1].tick == Ticks{90'000});
  CHECK(r.events.list()[1].block == 1);
  RunSummary summary;
  summary.axis.resize(2);
  r.residual.summarize(summary);
  CHECK(summary.axis[0].residual_u == 0.07);
  CHECK(summary.axis[1].residual_u == 0);
}
