#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>

#include "tests/emulator/interpolator/lattice_support.h"

using namespace kadr;
using namespace kadr::test;

namespace {

/// F = a y - b x of every node of a line, in coordinates that grow along it.
struct Deviation {
  std::int64_t least = 0, most = 0;
  std::int64_t largest() const { return std::max(-least, most); }
};

Deviation deviation(std::int64_t dx, std::int64_t dy, const Trace& t) {
  const std::int64_t a = std::abs(dx), b = std::abs(dy);
  const int sx = dx < 0 ? -1 : 1, sy = dy < 0 ? -1 : 1;
  Deviation out;
  std::int64_t x = 0, y = 0;
  for (const lattice::Slot& s : t.slots) {
    x += sx * s.step[0];
    y += sy * s.step[1];
    const std::int64_t f = a * y - b * x;
    out.least = std::min(out.least, f);
    out.most = std::max(out.most, f);
  }
  return out;
}

/// Worst distances over the lines of all octants.
struct Sweep {
  double euclid = 0, square = 0;
  std::int64_t wrong_ends = 0, wrong_slots = 0, broken_bounds = 0;
};

template <class Check>
Sweep sweep(Method method, int reach, Check&& check) {
  Sweep s;
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      if (dx == 0 && dy == 0) continue;
      const Trace t = trace(line({dx, dy}), method);
      const std::int64_t a = std::abs(dx), b = std::abs(dy);
      const Deviation d = deviation(dx, dy, t);
      s.wrong_ends += !t.end_reached || t.forced > 0;
      check(a, b, d, static_cast<std::int64_t>(t.slots.size()), s);
      s.euclid = std::max(s.euclid, static_cast<double>(d.largest()) / std::hypot(dx, dy));
      s.square = std::max(s.square, static_cast<double>(d.largest()) / static_cast<double>(a + b));
    }
  return s;
}

int reach() { return full_sweep() ? 128 : 24; }

/// Distance of a run in n axes from its line.
double line_distance(const LineCurve& l, const Trace& t) {
  double dd = 0, worst = 0;
  std::vector<double> p(static_cast<std::size_t>(l.axes));
  for (std::size_t k = 0; k < p.size(); ++k)
    dd += static_cast<double>(l.delta[k]) * static_cast<double>(l.delta[k]);
  for (const lattice::Slot& s : t.slots) {
    double pp = 0, pd = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      p[k] += s.step[k];
      pp += p[k] * p[k];
      pd += p[k] * static_cast<double>(l.delta[k]);
    }
    worst = std::max(worst, std::sqrt(std::max(0.0, pp - pd * pd / dd)));
  }
  return worst;
}

}  // namespace

TEST_CASE("lattice: line 7 x 4 has the step tables of the study bit for bit") {
  const Trace half = trace(line({7, 4}), Method::half_step);
  CHECK(letters(half) == "XYXXYXYXXYX");
  CHECK(tested(half) == std::vector<std::int64_t>{3, -5, 9, 1, -7, 7, -1, 13, 5, -3, 11});
  std::vector<std::int64_t> f;
  for (const lattice::Slot& s : half.slots) f.push_back(s.value);
  CHECK(f == std::vector<std::int64_t>{0, -4, 3, -1, -5, 2, -2, 5, 1, -3, 4});
  const Trace diagonal = trace(line({7, 4}), Method::diagonal);
  CHECK(tested(diagonal) == std::vector<std::int64_t>{1, -5, 3, -3, 5, -1, 7});
  CHECK(letters(diagonal) == "XY X XY X XY X XY");
}

TEST_CASE("lattice: on every line of all octants each method keeps its bound in integers and meets the end") {
  // classic: F in [-b, a); half-step: |F| <= (a + b)/2; V_i and extra points: |F| <= max/2
  const Sweep classic =
      sweep(Method::classic, reach(), [](auto a, auto b, Deviation d, auto slots, Sweep& s) {
        s.broken_bounds += !(d.least >= -b && (d.most < a || (a == 0 && d.most == 0)));
        s.wrong_slots += slots != a + b;
      });
  const Sweep half = sweep(Method::half_step, reach(), [](auto a, auto b, Deviation d, auto slots, Sweep& s) {
    s.broken_bounds += 2 * d.largest() > a + b;
    s.wrong_slots += slots != a + b;
  });
  const auto diagonal_bound = [](auto a, auto b, Deviation d, auto slots, Sweep& s) {
    s.broken_bounds += 2 * d.largest() > std::max(a, b);
    s.wrong_slots += slots != std::max(a, b);
  };
  const Sweep diagonal = sweep(Method::diagonal, reach(), diagonal_bound);
  const Sweep extra = sweep(Method::extra_points, reach(), diagonal_bound);
  for (const Sweep* s : {&classic, &half, &diagonal, &extra}) {
    CHECK(s->wrong_ends == 0);
    CHECK(s->wrong_slots == 0);
    CHECK(s->broken_bounds == 0);
  }
  CHECK(classic.euclid < 1.0);
  CHECK(half.euclid <= std::sqrt(0.5) * (1 + 1e-15));
  CHECK(half.euclid > 0.70710);
  CHECK(half.square <= 0.5);
  CHECK(diagonal.euclid < 0.5);
  if (!full_sweep()) return;
  // section 3.1 of the study, to the digits printed there
  CHECK(classic.euclid == doctest::Approx(0.99997).epsilon(1e-5));
  CHECK(diagonal.euclid == doctest::Approx(0.49998).epsilon(1e-5));
  CHECK(extra.euclid == diagonal.euclid);
  const auto none = [](auto, auto, Deviation, auto, Sweep&) {};
  CHECK(sweep(Method::dda, 128, none).euclid == doctest::Approx(0.99216).epsilon(1e-5));
  CHECK(sweep(Method::dda_preloaded, 128, none).euclid == doctest::Approx(0.70433).epsilon(1e-5));
}

TEST_CASE("lattice: the worst lines are those that the bounds name") {
  // classic: F = -b just before the first Y step of 1 x 128: 128/hypot(1, 128)
  CHECK(deviation(1, 128, trace(line({1, 128}), Method::classic)).least == -128);
  // half-step: at 45 degrees (a + b)/2L = sqrt(2)/2 is reached
  CHECK(deviation(3, 3, trace(line({3, 3}), Method::half_step)).largest() == 3);
  // V_i: a tie at (400, 1)
  CHECK(deviation(400, 1, trace(line({400, 1}), Method::diagonal)).largest() == 200);
}

TEST_CASE("lattice: extra points and V_i make the same path of a line") {
  for (int dx = -20; dx <= 20; ++dx)
    for (int dy = -20; dy <= 20; ++dy) {
      if (dx == 0 && dy == 0) continue;
      CHECK(trace(line({dx, dy}), Method::extra_points).hash == trace(line({dx, dy}), Method::diagonal).hash);
    }
}

TEST_CASE("lattice: the half-step path of the way back is the same nodes where the tie is mirrored") {
  for (int dx = -12; dx <= 12; ++dx)
    for (int dy = -12; dy <= 12; ++dy) {
      if (dx == 0 && dy == 0) continue;
      std::vector<PlaneNode> there = nodes(trace(line({dx, dy}), Method::half_step));
      lattice::MethodOptions mirrored;
      mirrored.tie_to_y = true;
      std::vector<PlaneNode> back = nodes(trace(line({-dx, -dy}), Method::half_step, mirrored));
      std::reverse(back.begin(), back.end());
      for (PlaneNode& n : back) n = {n.x + dx, n.y + dy};
      CHECK(there == back);
      if (std::abs(dx) != std::abs(dy)) continue;
      // through corners: without the mirror the way back differs
      std::vector<PlaneNode> same_tie = nodes(trace(line({-dx, -dy}), Method::half_step));
      std::reverse(same_tie.begin(), same_tie.end());
      for (PlaneNode& n : same_tie) n = {n.x + dx, n.y + dy};
      CHECK_FALSE(there == same_tie);
    }
}

TEST_CASE("lattice: in n axes the half-step stays within sqrt(n)/2, V_i within sqrt(n - 1)/2") {
  for (const int n : {2, 3, 4, 6}) {
    std::mt19937 random(static_cast<unsigned>(n));
    double half = 0, diagonal = 0, lag = 0;
    for (int i = 0; i < (full_sweep() ? 4000 : 150); ++i) {
      LineCurve l{n, {}};
      for (int k = 0; k < n; ++k) l.delta[static_cast<std::size_t>(k)] = static_cast<int>(random() % 81) - 40;
      // the worst: all equal
      if (i == 0)
        for (int k = 0; k < n; ++k) l.delta[static_cast<std::size_t>(k)] = k % 2 == 0 ? 40 : -40;
      if (l.delta == lattice::Point{}) continue;
      const Trace h = trace(l, Method::half_step), v = trace(l, Method::diagonal),
                  c = trace(l, Method::classic);
      CHECK((h.end_reached && v.end_reached && c.end_reached));
      half = std::max(half, line_distance(l, h));
      diagonal = std::max(diagonal, line_distance(l, v));
      lag = std::max(lag, line_distance(l, c));
      // each axis on its own: at the moment (2 i + 1)/2d of its step the others are within half a step
      lattice::Point done{};
      for (const lattice::Slot& s : h.slots) {
        std::size_t axis = 0;
        while (s.step[axis] == 0) ++axis;
        const std::int64_t num = 2 * done[axis] + 1, den = 2 * std::abs(l.delta[axis]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k)
          // |done_k - d_k num/den| <= 1/2
          REQUIRE(2 * std::abs(done[k] * den - std::abs(l.delta[k]) * num) <= den);
        ++done[axis];
      }
      // V_i: after slot j each axis is within half a step of its share j/longest
      lattice::Point at{};
      std::int64_t longest = 0;
      for (const std::int64_t d : l.delta) longest = std::max(longest, std::abs(d));
      for (std::size_t j = 0; j < v.slots.size(); ++j)
        for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
          at[k] += std::abs(v.slots[j].step[k]);
          REQUIRE(2 * std::abs(at[k] * longest - std::abs(l.delta[k]) * static_cast<std::int64_t>(j + 1)) <=
                  longest);
        }
    }
    CHECK(half <= std::sqrt(n) / 2 + 1e-12);
    CHECK(diagonal <= std::sqrt(n - 1.0) / 2 + 1e-12);
    CHECK(half > 0.9 * std::sqrt(n) / 2);
    CHECK(lag > half);
  }
}

TEST_CASE("lattice: with two axes the half-crossing order is the half-step path") {
  for (int dx = 1; dx <= 30; ++dx)
    for (int dy = 1; dy <= 30; ++dy) {
      const Trace plane = trace(line({dx, dy}), Method::half_step);
      const Trace space = trace(line({dx, dy, 0}), Method::half_step);
      REQUIRE(plane.slots.size() == space.slots.size());
      for (std::size_t i = 0; i < plane.slots.size(); ++i) CHECK(plane.slots[i].step == space.slots[i].step);
    }
}

TEST_CASE("lattice: a DDA idles where its modulus is longer than the line") {
  // 7 x 4 in registers of 8: nothing overflows in the first of 8 slots, then X always and Y in every second one
  const Trace t = trace(line({7, 4}), Method::dda);
  CHECK(t.slots.size() == 8);
  CHECK(t.idle == 1);
  CHECK(t.slots.front().step == lattice::Slot{}.step);
  CHECK(letters(t) == "XY X XY X XY X XY");
  CHECK(trace(line({7, 4}), Method::dda_preloaded).end_reached);
}

TEST_CASE("lattice: a slope cut to q bits drifts by at most N 2^-(q+1)") {
  // 10007 x 3001: |round(2^q b/a) a - 2^q b| / 2^q
  const std::map<int, double> study = {{8, 8.917969}, {12, 0.854492}, {16, 0.061676}, {24, 0.000240}};
  for (const auto& [bits, drift] : study) {
    lattice::MethodOptions options;
    options.fraction_bits = bits;
    const Trace t = trace(line({10'007, 3'001}), Method::progression, options);
    CHECK(t.slots.size() == 10'007);
    CHECK(std::abs(static_cast<double>(std::abs(t.end[1] - 3'001)) - drift) <= 0.5);
    CHECK(drift <= 10'007 * std::pow(2.0, -(bits + 1)));
    CHECK(t.end_reached == (drift < 0.5));
  }
}

TEST_CASE("lattice: point to point meets only its ends, each axis at its own rate") {
  const Trace t = trace(line({2, -5, 3}), Method::ptp);
  CHECK(t.slots.size() == 5);
  CHECK(t.end_reached);
  CHECK(t.slots[1].step[0] == 1);
  CHECK(t.slots[1].step[1] == -1);
  CHECK(t.slots[2].step[0] == 0);
  CHECK(t.slots[4].step[2] == 0);
}

TEST_CASE("lattice: the difference as printed never steps Y; that of the magnitudes is right") {
  // section 1: ends at (137, 0), 47.5 steps off the line of 100 x 37
  const Trace printed = trace(line({100, 37}), Method::printed_difference);
  CHECK(printed.end[0] == 137);
  CHECK(printed.end[1] == 0);
  CHECK(static_cast<double>(deviation(100, 37, printed).largest()) / std::hypot(100, 37) ==
        doctest::Approx(47.54).epsilon(1e-4));
  const Trace meant = trace(line({100, 37}), Method::magnitudes);
  CHECK(meant.end_reached);
  CHECK(static_cast<double>(deviation(100, 37, meant).largest()) / std::hypot(100, 37) ==
        doctest::Approx(0.6377).epsilon(1e-4));
}

TEST_CASE("lattice: the nearer of the two neighbours is what the half-step rule chooses") {
  for (int dx = -25; dx <= 25; ++dx)
    for (int dy = -25; dy <= 25; ++dy) {
      if (dx == 0 || dy == 0) continue;
      CHECK(trace(line({dx, dy}), Method::magnitudes).hash == trace(line({dx, dy}), Method::half_step).hash);
    }
}

TEST_CASE("lattice: lines up to 2^60 steps are followed, beyond they are refused") {
  const std::int64_t most = std::int64_t{1} << 60;
  for (const Method m : {Method::classic, Method::half_step, Method::diagonal, Method::dda_preloaded})
    for (const Curve& c : {Curve(line({most, most - 1})), Curve(line({most, 1, -most}))}) {
      const Trace t = trace(c, m, {}, 1000);
      CHECK(t.slots.size() == 1000);
      CHECK_FALSE(t.complete);
    }
  // along the equal axes of the second one neither runs ahead by more than a step
  const Trace t = trace(line({most, 1, -most}), Method::half_step, {}, 1001);
  CHECK(std::abs(t.end[0] + t.end[2]) == 1);
  CHECK(t.end[1] == 0);
  CHECK(lattice::make_stepper(line({most + 1, 1}), Method::half_step).refusal == lattice::Refusal::range);
  CHECK(lattice::make_stepper(line({INT64_MIN, 1}), Method::half_step).refusal == lattice::Refusal::range);
  CHECK(lattice::make_stepper(line({0, 0}), Method::half_step).refusal == lattice::Refusal::no_length);
  CHECK(lattice::make_stepper(line({1, 1}), Method::chords).refusal == lattice::Refusal::other_curve);
}

TEST_CASE("lattice: every method has a name of its own, and knows() says what make_stepper() makes") {
  const std::vector<Curve> curves = {line({3, 2}),
                                     line({3, 2, 1}),
                                     ArcCurve{{3, 0}, {0, 3}, Turn::ccw},
                                     lattice::ParabolaCurve{1, 2, -2},
                                     lattice::ellipse(5, 3),
                                     lattice::BezierCurve{2, 2, {{{0, 0}, {4, 0}, {4, 4}}}}};
  for (const lattice::MethodEntry& m : lattice::methods()) {
    CHECK(lattice::method_of(m.name()) == m.method);
    CHECK(&lattice::entry_of(m.method) == &m);
    for (const Curve& c : curves) {
      const lattice::Made made = lattice::make_stepper(c, m.method);
      CAPTURE(m.name());
      CHECK((made.refusal == lattice::Refusal::other_curve) == !lattice::knows(m.method, c));
      CHECK((made.stepper != nullptr) == lattice::knows(m.method, c));
    }
  }
  CHECK_FALSE(lattice::method_of("half-step"));
}
