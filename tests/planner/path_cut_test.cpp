#include <doctest/doctest.h>

#include <cmath>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner_support.h"

namespace kadr::test {

using namespace kadr::planner;

TEST_CASE("a path that is cut anywhere is the same path: places, tangents, curvatures, lengths") {
  const std::uint64_t count = environment("KADR_COUNT", 40);
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const machine::MachineModel machine = random_machine(random);
    AxisValues end{};
    const Path whole = random_path(random, machine, end);
    Path cut = whole;
    for (int k = 0; k < 6; ++k) {
      const double at = random.unit() * whole.length_u();
      const std::size_t before = cut.size(), segment = cut_path(cut, at);
      if (segment == cut.size()) continue;
      CHECK(cut.start_s_u[segment] == doctest::Approx(at).epsilon(1e-8));
      CHECK(cut.size() <= before + 1);
      CHECK(cut_path(cut, cut.start_s_u[segment]) == segment);  // it is there already
    }
    CHECK(cut.length_u() == whole.length_u());
    CHECK(cut.nodes_u.size() == (cut.size() + 1) * static_cast<std::size_t>(cut.axes()));
    double feed_whole = 0.0, feed_cut = 0.0;
    for (const PathSegment& s : whole.segments) feed_whole += s.feed_length_u;
    std::size_t from = 0;
    for (std::size_t i = 0; i < cut.size(); ++i) {
      const PathSegment& s = cut.segments[i];
      feed_cut += s.feed_length_u;
      CHECK(s.length_u > 0.0);
      CHECK(cut.start_s_u[i + 1] - cut.start_s_u[i] == doctest::Approx(s.length_u).epsilon(1e-6));
      const double middle = cut.start_s_u[i] + 0.5 * s.length_u;
      while (whole.start_s_u[from + 1] <= middle) ++from;
      CHECK(s.block == whole.segments[from].block);
      CHECK(s.feed_u_s == whole.segments[from].feed_u_s);
      const JointPlace here(cut, i, 0.5 * s.length_u);
      const JointPlace there(whole, from, middle - whole.start_s_u[from]);
      for (const auto values : {&JointPlace::x, &JointPlace::d1, &JointPlace::d2})
        for (std::size_t c = 0; c < kProgramAxes; ++c)
          CHECK(std::fabs((here.*values)[c] - (there.*values)[c]) <=
                1e-6 * (1.0 + std::fabs((there.*values)[c])));
      CHECK(s.stop_at_end ==
            (whole.segments[from].stop_at_end && cut.start_s_u[i + 1] == whole.start_s_u[from + 1]));
    }
    CHECK(feed_cut == doctest::Approx(feed_whole).epsilon(1e-9));
  }
}

TEST_CASE("both halves of an arc end on its circle, and a law through the joint goes on as before") {
  machine::MachineModel machine = trapezoid_machine("XY");
  ProgramWriter program(machine, xyz(50));
  program.arc(gcode::Plane::xy, 0, 0, 1, xyz(0, 50), 60.0);
  Path path = program.take();
  const auto whole = plan(path, machine);
  REQUIRE(whole);
  // a third of a quarter: 30 degrees
  CHECK(cut_path(path, path.length_u() / 3.0) == 1);
  CHECK(path.node(1)[0] == doctest::Approx(50.0 * std::cos(kPi / 6.0)).epsilon(1e-12));
  CHECK(path.node(1)[1] == doctest::Approx(25.0).epsilon(1e-12));
  const auto halves = plan(path, machine);
  REQUIRE(halves);
  CHECK(halves->law.duration_s == doctest::Approx(whole->law.duration_s).epsilon(1e-9));
}

}  // namespace kadr::test
