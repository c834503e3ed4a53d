#include <doctest/doctest.h>

#include <cmath>

#include "planner/time_law/tube.h"

using namespace kadr::planner;

namespace {

/// Paper 000, figure 2: total time of each pass, and whether "no touches" stands below it.
struct Printed {
  double time_s;
  bool touched;
};
constexpr Printed kFigure2[] = {{8.7468, false}, {7.2171, true}, {6.549, true},  {6.2644, true},
                                {6.1089, true},  {6.0204, true}, {5.9926, true}, {5.9966, false},
                                {5.905, false},  {5.864, false}, {5.8437, false}};
constexpr double kHalfWidths_mm_s[] = {0, 75, 75, 75, 75, 75, 75, 75, 37.5, 18.75, 9.375};

}  // namespace

TEST_CASE("the paper's log, replayed: the loop ends at pass 11 with the falls and half widths printed") {
  LawSolution first;
  first.time_s = first.cost_s = kFigure2[0].time_s;
  TubeControl control(TubeOptions{}, first, 75.0);
  for (std::size_t i = 1; i < 11; ++i) {
    CAPTURE(i + 1);
    CHECK_FALSE(control.ended());
    const TubePass& pass = control.pass(kFigure2[i].time_s, kFigure2[i].time_s, kFigure2[i].touched);
    CHECK(pass.number == i + 1);
    CHECK(pass.half_width_u_s == kHalfWidths_mm_s[i]);
    CHECK(pass.compared == (i + 1 >= 9));
  }
  CHECK(control.ended());
  CHECK_FALSE(control.capped());
  CHECK(control.half_width_u_s() == 4.6875);
  // the printed times have 4 or 5 digits: falls computed from them are off by up to 0.003
  CHECK(std::fabs(control.passes()[8].fall_percent - 1.5261) <= 0.003);
  CHECK(std::fabs(control.passes()[9].fall_percent - 0.69465) <= 0.003);
  CHECK(std::fabs(control.passes()[10].fall_percent - 0.34628) <= 0.003);
}

TEST_CASE("two small falls are no reason to end: passes with a touch are never compared") {
  LawSolution first;
  first.time_s = 10;
  TubeControl control(TubeOptions{}, first, 8.0);
  for (const double time_s : {9.999, 9.998, 9.997}) control.pass(time_s, time_s, true);
  CHECK_FALSE(control.ended());
  control.pass(9.996, 9.996, false);
  CHECK_FALSE(control.ended());
  CHECK(control.half_width_u_s() == 4.0);
  control.pass(9.995, 9.995, false);
  CHECK(control.ended());
}

TEST_CASE("a loop whose touches alternate ends by its least half width or by the number of its passes") {
  LawSolution first;
  first.time_s = 10;
  TubeOptions options;
  options.most_passes = 6;
  TubeControl counted(options, first, 8.0);
  for (int i = 0; !counted.ended(); ++i) counted.pass(9, 9, i % 2 == 0);
  CHECK(counted.capped());
  CHECK(counted.passes().size() == 6);
  options.least_half_width_u_s = 3.0;
  TubeControl narrow(options, first, 8.0);
  for (int i = 0; !narrow.ended(); ++i) narrow.pass(9, 9, i % 2 == 0);
  CHECK_FALSE(narrow.capped());
  CHECK(narrow.half_width_u_s() == 2.0);
}
