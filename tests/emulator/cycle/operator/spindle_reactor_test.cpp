#include "emulator/cycle/operator/spindle_reactor.h"

#include <doctest/doctest.h>

using namespace kadr;
using namespace kadr::cycle;

namespace {

// down by 10 % above a load of 110 % for 20 ticks and each 100 more, to 30 %; up by 5 % below 90 % for 500,
// each 200 more
const machine::SpindleReaction kRule{};

double after(SpindleReactor& reactor, double load, int ticks) {
  double override_ratio = 0;
  for (int i = 0; i < ticks; ++i) override_ratio = reactor.advance(load);
  return override_ratio;
}

}  // namespace

TEST_CASE("a high load takes the feed down by steps, after its time, and never below the least") {
  SpindleReactor reactor(kRule, 1e-3);
  CHECK(after(reactor, 1.2, 19) == 1.0);
  CHECK(after(reactor, 1.2, 1) == 0.9);
  CHECK(after(reactor, 1.2, 99) == 0.9);
  CHECK(after(reactor, 1.2, 1) == 0.8);
  CHECK(reactor.unsettled(1.2));
  CHECK(after(reactor, 1.2, 500) == 0.3);
  CHECK(after(reactor, 1.2, 1000) == 0.3);
  CHECK_FALSE(reactor.unsettled(1.2));
}

TEST_CASE(
    "a low load brings the feed back to 100 %; a load between the two changes nothing and restarts the "
    "count") {
  SpindleReactor reactor(kRule, 1e-3);
  CHECK(after(reactor, 1.2, 20) == 0.9);
  CHECK(after(reactor, 1.0, 2000) == 0.9);
  CHECK_FALSE(reactor.unsettled(1.0));
  CHECK(reactor.unsettled(0.5));
  CHECK(after(reactor, 0.5, 499) == 0.9);
  CHECK(after(reactor, 1.0, 1) == 0.9);
  CHECK(after(reactor, 0.5, 499) == 0.9);
  CHECK(after(reactor, 0.5, 1) == doctest::Approx(0.95));
  CHECK(after(reactor, 0.5, 200) == 1.0);
  CHECK(after(reactor, 0.5, 1000) == 1.0);
  CHECK_FALSE(reactor.unsettled(0.5));
}

TEST_CASE("a reaction faster than a control tick takes one control tick") {
  machine::SpindleReaction rule;
  rule.high_ms = rule.down_ms = 0.1;
  SpindleReactor reactor(rule, 1e-3);
  CHECK(reactor.advance(1.2) == 0.9);
  CHECK(reactor.advance(1.2) == 0.8);
}
