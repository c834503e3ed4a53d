#include <doctest/doctest.h>

#include "gcode/interpret/interpreter.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// A machine with a block of material below Z-5.
InterpretOptions with_stock() {
  InterpretOptions options;
  options.stock = StockPlane{2, -5, true};
  return options;
}

Probe probe_of(const Outcome& outcome) {
  INFO(outcome.rendered);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  const std::vector<Probe> found = outcome.all<Probe>();
  REQUIRE_FALSE(found.empty());
  return found.back();
}

}  // namespace

TEST_CASE("a probing move ends where it meets the stock, and the program goes on from there") {
  // from (0, 0, 5) towards (8, 6, -15): Z-5 is half of the way
  const Outcome outcome = run("F120\nG0 Z5\nG38.2 X8 Y6 Z-15\nG0 X[#5061] Y[#5062+#5070]\n", with_stock());
  const Probe probe = probe_of(outcome);
  CHECK(probe.end == AxisValues{8, 6, -15});
  CHECK(probe.contact == AxisValues{4, 3, -5});
  CHECK(probe.length_u == doctest::Approx(11.18033988749895));  // sqrt(500) / 2
  CHECK(probe.feed_u_s == 2);
  CHECK(probe.tripped);
  CHECK(outcome.moves().back().end == AxisValues{4, 4, -5});
}

TEST_CASE("the trace tells the programmed point of a probing move") {
  const Outcome outcome = run("F120\nG38.2 Z-15\n", with_stock());
  CHECK(outcome.trace[1] ==
        "STRAIGHT_PROBE 0.000000 0.000000 -15.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000");
}

TEST_CASE("without a stock the probe meets the end of its move") {
  const Outcome outcome = run("F120\nG38.2 Z-5\nG0 Z5\nG38.3 Z-6\nG0 X[#5063] Y[#5070]\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::probe_without_stock});
  CHECK(outcome.moves().back().end == AxisValues{-6, 1, -6});
}

TEST_CASE("results are program coordinates in the units in force") {
  // G54 is at X10 Z20, G92 puts 1 mm upon it, and an inch is 25.4 mm: Z-5 is program (-5 - 20 - z92) / 25.4
  const Outcome outcome =
      run("F100\nG10 L2 P1 X10 Z20\nG92 Z3\nG20\nF4\nG38.2 Z-10\n#1=#5063\nG21\nG0 X[#1] Y[#5063]\n",
          with_stock());
  // G92 Z3 at machine Z0: program Z3 is machine Z0, so machine -5 is program -2 mm
  CHECK(outcome.moves().back().end[0] == doctest::Approx(10 - 2 / 25.4));
  CHECK(outcome.moves().back().end[1] == doctest::Approx(-2 / 25.4));
}

TEST_CASE("the tip meets the stock: the length of the tool is taken into account") {
  const Outcome outcome = run("F100\nG43.1 Z30\nG0 Z10\nG38.2 Z-20\nG0 X[#5063]\n", with_stock());
  CHECK(probe_of(outcome).contact[2] == 25);
  CHECK(outcome.moves().back().end[0] == -5);
}

TEST_CASE("G38.3 that meets nothing goes to its end and says so in #5070") {
  const Outcome outcome = run("F100\nG38.3 X3 Z-4\nG0 X[#5070] Y[#5063]\n", with_stock());
  const Probe probe = probe_of(outcome);
  CHECK_FALSE(probe.tripped);
  CHECK(probe.contact == probe.end);
  CHECK(outcome.moves().back().end == AxisValues{0, -4, -4});
}

TEST_CASE("a probe leaves the stock with G38.5 and may meet it again from there") {
  const Outcome outcome =
      run("F100\nG38.2 Z-9\nG38.5 Z2\nG38.2 Z-9\nG91 G38.4 Z4\nG90\nG0 X[#5063]\n", with_stock());
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.moves().back().end == AxisValues{-5, 0, -5});
  // deep inside, the way out is 3 mm
  const Probe out = probe_of(run("F60\nG0 Z-8\nG38.4 Z2\n", with_stock()));
  CHECK(out.contact[2] == -5);
  CHECK(out.length_u == doctest::Approx(3));
}

TEST_CASE("material above a plane is met from below") {
  InterpretOptions options;
  options.stock = StockPlane{0, 20, false};
  const Probe probe = probe_of(run("F100\nG38.2 X30\n", options));
  CHECK(probe.contact[0] == 20);
}

TEST_CASE("under G93 a probing move goes on at the feed of the move before it") {
  // 10 mm in 60/6 s; the probe ignores its own F, half of its way is 10 mm
  const Probe probe = probe_of(run("G93\nG0 Z15\nG1 Z5 F6\nG38.2 Z-15 F2\n", with_stock()));
  CHECK(probe.feed_u_s == doctest::Approx(1));
  CHECK(probe.duration_s == 0);
  CHECK(probe.length_u == doctest::Approx(10));
  // or at the last F before G93
  CHECK(probe_of(run("F120\nG93\nG0 Z5\nG38.2 Z-15\n", with_stock())).feed_u_s == doctest::Approx(2));
  CHECK(only_code("G93\nG38.2 Z-15 F6\n", with_stock()) == Code::feed_missing);
}

TEST_CASE("G38.2 is modal, and a repeated line without retracting is an error") {
  const Outcome outcome = run("F100\nG38.2 Z-9\nZ-10\n", with_stock());
  CHECK(outcome.codes() == std::vector<Code>{Code::probe_already_there});
}
