#include "emulator/cycle/lost_time.h"

#include <doctest/doctest.h>

using namespace kadr;
using namespace kadr::cycle;
using namespace kadr::log;

namespace {

/// 0.1 s at 100 mm/s, a pause of 0.5 s, 0.1 s at 50 mm/s.
planner::MotionLaw law_with_pause() {
  planner::MotionLaw law;
  const auto piece = [&](double begin_s, double duration_s, double s_u, double speed_u_s) {
    planner::JerkPiece p;
    p.begin_s = begin_s;
    p.duration_s = duration_s;
    p.s_u = s_u;
    p.speed_u_s = speed_u_s;
    law.pieces.push_back(p);
  };
  piece(0, 0.1, 0, 100);
  piece(0.1, 0.5, 10, 0);
  piece(0.6, 0.1, 10, 50);
  law.duration_s = 0.7;
  law.length_u = 15;
  return law;
}

planner::TickMotion motion(double begin_u, double end_u) {
  planner::TickMotion m;
  m.s_begin_u = begin_u;
  m.s_end_u = end_u;
  return m;
}

}  // namespace

TEST_CASE(
    "time is lost to a reason by the tick's length less the planned time of its path, pauses left out") {
  const planner::MotionLaw law = law_with_pause();
  LostTime lost(law, 0.01);
  lost.add(motion(0, 1), LostReason::feed_override);    // as planned
  lost.add(motion(1, 1.5), LostReason::feed_override);  // half of it: 5 ms
  lost.add(motion(1.5, 1.5), LostReason::hold);         // nothing: 10 ms
  lost.add(motion(1.5, 3.5), LostReason::deferral);     // twice as much: -10 ms
  // across the pause: 65 ms before it and 10 ms behind it are planned
  lost.add(motion(3.5, 10.5), LostReason::limiter);
  const std::vector<LimitShare> shares = lost.shares();
  REQUIRE(shares.size() == 4);
  CHECK(shares[0].limited_by == "hold");
  CHECK(shares[0].time_s == doctest::Approx(0.010));
  CHECK(shares[1].limited_by == "override");
  CHECK(shares[1].time_s == doctest::Approx(0.005));
  CHECK(shares[2].limited_by == "deferral");
  CHECK(shares[2].time_s == doctest::Approx(-0.010));
  CHECK(shares[3].limited_by == "limiter");
  CHECK(shares[3].time_s == doctest::Approx(0.010 - 0.075));
}

TEST_CASE("a reason that cost less than a microsecond is left out") {
  const planner::MotionLaw law = law_with_pause();
  LostTime lost(law, 0.01);
  lost.add(motion(0, 1 - 0.9e-4), LostReason::limiter);  // 0.9 us
  CHECK(lost.shares().empty());
  lost.add(motion(1 - 0.9e-4, 2 - 2e-4), LostReason::limiter);  // 2 us in all
  CHECK(lost.shares().size() == 1);
}
