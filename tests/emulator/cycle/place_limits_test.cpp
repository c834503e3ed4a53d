#include "emulator/cycle/place_limits.h"

#include <doctest/doctest.h>

#include "tests/support/straight_run.h"

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::test;

namespace {

PlaceLimit point(double at_u, double max_u_s) {
  PlaceLimit p;
  p.at_u = at_u;
  p.max_u_s = max_u_s;
  p.span.line = 12;
  return p;
}

}  // namespace

TEST_CASE(
    "a technology point cuts the path at its length, limits the speed there, and moves the events behind "
    "it") {
  ReadProgram read{straight_path({100, 100}), {}, 2, {}};
  for (const std::size_t joint : {0, 1, 2}) {
    read.events.emplace_back();
    read.events.back().after_segment = joint;
  }
  read.path.segments[0].feed_length_u = 50;  // its feed measures half of the path
  Diagnostics diagnostics;
  limit_places({point(75, 20)}, read, diagnostics);
  CHECK(diagnostics.list().empty());
  CHECK(read.path.start_s_u == std::vector<double>{0, 75, 100, 200});
  CHECK(read.path.segments[1].begin_limit_u_s == doctest::Approx(40));  // of s
  CHECK(read.path.segments[1].block == 0);
  CHECK(read.path.segments[0].begin_limit_u_s == machine::kInfinity);
  CHECK(read.events[0].after_segment == 0);
  CHECK(read.events[1].after_segment == 2);
  CHECK(read.events[2].after_segment == 3);

  // at a joint nothing is cut; the lower of two points counts; the end is at rest anyway
  limit_places({point(75, 30), point(100, 7), point(200, 1)}, read, diagnostics);
  CHECK(read.path.size() == 3);
  CHECK(read.path.segments[1].begin_limit_u_s == doctest::Approx(40));
  CHECK(read.path.segments[2].begin_limit_u_s == 7);
  CHECK(read.events[2].after_segment == 3);
}

TEST_CASE("a technology point beyond the path is refused, each one, with what is allowed") {
  ReadProgram read{straight_path({100}), {}, 1, {}};
  Diagnostics diagnostics;
  limit_places({point(100.5, 20), point(50, 20), point(300, 20)}, read, diagnostics);
  REQUIRE(diagnostics.errors() == 2);
  const Diagnostic& d = diagnostics.list()[0];
  CHECK(d.code == Code::scenario_technology);
  CHECK(d.span.line == 12);
  CHECK(d.label == "is at 100.5 mm of the path");
  CHECK(d.notes.at(0) == "allowed: 0 to 100 mm, its length");
  CHECK(read.path.size() == 2);
  ReadProgram empty{planner::Path(1), {}, 0, {}};
  Diagnostics nothing;
  limit_places({point(0, 20)}, empty, nothing);
  CHECK(nothing.errors() == 1);
}
