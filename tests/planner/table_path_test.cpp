#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "planner/time_law/table_path.h"

using namespace kadr::planner;

namespace {

/// Rows at s = 0, then steps that alternate between 0.7 and 1.3 of the mean one.
std::vector<double> uneven_rows(std::size_t rows, double length) {
  std::vector<double> s(rows);
  for (std::size_t i = 1; i < rows; ++i) s[i] = s[i - 1] + (i % 2 == 0 ? 0.7 : 1.3);
  for (double& at : s) at *= length / s.back();
  return s;
}

template <class Function>
TablePath table_of(const std::vector<double>& s, Function&& f) {
  std::vector<double> values;
  for (const double at : s) values.push_back(f(at));
  return TablePath(s, values, 1);
}

struct Errors {
  double slope = 0, curvature = 0;
};
/// Largest errors against sin(s), 20 places an interval.
Errors against_sine(std::size_t rows) {
  const std::vector<double> s = uneven_rows(rows, 6.0);
  const TablePath path = table_of(s, [](double at) { return std::sin(at); });
  Errors e;
  for (int i = 0; i <= 20 * static_cast<int>(rows); ++i) {
    const double at = 6.0 * i / (20.0 * static_cast<double>(rows));
    const AxisPoint p = path.eval(0, at);
    e.slope = std::max(e.slope, std::fabs(p.slope - std::cos(at)));
    e.curvature = std::max(e.curvature, std::fabs(p.curvature + std::sin(at)));
  }
  return e;
}

}  // namespace

TEST_CASE("a cubic is met exactly by a table of it, from 4 uneven rows on and up to both ends") {
  const auto cubic = [](double s) { return ((0.5 * s - 2.0) * s + 3.0) * s - 1.0; };
  for (const std::size_t rows : {4u, 5u, 6u, 17u}) {
    CAPTURE(rows);
    const TablePath path = table_of(uneven_rows(rows, 5.0), cubic);
    for (int i = 0; i <= 100; ++i) {
      const double s = 0.05 * i;
      const AxisPoint p = path.eval(0, s);
      CHECK(std::fabs(p.value - cubic(s)) <= 1e-12);
      CHECK(std::fabs(p.slope - ((1.5 * s - 4.0) * s + 3.0)) <= 1e-12);
      CHECK(std::fabs(p.curvature - (3.0 * s - 4.0)) <= 1e-11);
    }
  }
}

TEST_CASE("value, X' and X'' are continuous at every row, and the values are those of the table") {
  const std::vector<double> s = uneven_rows(12, 3.0);
  const TablePath path = table_of(s, [](double at) { return std::sin(5.0 * at) * at; });
  for (std::size_t i = 1; i + 1 < s.size(); ++i) {
    const double h = 1e-9;
    const AxisPoint before = path.eval(0, s[i] - h), here = path.eval(0, s[i]),
                    behind = path.eval(0, s[i] + h);
    CHECK(here.value == doctest::Approx(std::sin(5.0 * s[i]) * s[i]).epsilon(1e-14));
    // of a jump nothing but the derivative times 2 h may be left; X''' is below 2000 here
    CHECK(std::fabs(behind.value - before.value) <= 1e-7);
    CHECK(std::fabs(behind.slope - before.slope) <= 1e-6);
    CHECK(std::fabs(behind.curvature - before.curvature) <= 1e-5);
  }
}

TEST_CASE("a sine from 61 uneven rows over 6 rad: X' within 1e-4, X'' within 1e-2, ends included") {
  const Errors coarse = against_sine(61), fine = against_sine(121);
  CHECK(coarse.slope <= 1e-4);
  CHECK(coarse.curvature <= 1e-2);
  // half the step: X' falls by 8 in between and at the ends, X'' by 4
  CHECK(coarse.slope / fine.slope >= 6.0);
  CHECK(coarse.curvature / fine.curvature >= 3.5);
}

TEST_CASE("nodes at the rows or evenly between the ends, derivatives of several axes side by side") {
  const std::vector<double> s = uneven_rows(9, 4.0);
  std::vector<double> values;
  for (const double at : s) {
    values.push_back(2.0 * at);
    values.push_back(at * at);
  }
  const TablePath path(s, values, 2);
  LawProblem rows, even;
  path.place_rows(rows);
  path.sample(6, even);
  CHECK(rows.s_u == s);
  CHECK(rows.axes == 2);
  REQUIRE(even.s_u.size() == 6);
  CHECK(even.s_u[3] == doctest::Approx(2.4));
  CHECK(even.s_u.back() == s.back());
  for (const LawProblem* p : {&rows, &even})
    for (std::size_t i = 0; i < p->nodes(); ++i) {
      CHECK(p->slope[2 * i] == doctest::Approx(2.0));
      CHECK(p->slope[2 * i + 1] == doctest::Approx(2.0 * p->s_u[i]));
      CHECK(std::fabs(p->curvature[2 * i]) <= 1e-12);
      CHECK(p->curvature[2 * i + 1] == doctest::Approx(2.0));
    }
  double slope[2], curvature[2];
  path.derivatives()(1.7, slope, curvature);
  CHECK(slope[1] == doctest::Approx(3.4));
}
