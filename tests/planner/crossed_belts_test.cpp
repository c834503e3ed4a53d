#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "gcode/block.h"
#include "machine/machine.h"
#include "planner/limits/limits.h"
#include "planner/path/joints.h"
#include "verified_plan.h"

// A machine whose joints are not its axes: two motors whose belts both move X and Y, and a screw with a gear of
// three on Z.
namespace kadr::test {
namespace {

using planner::FeedPlan;
using planner::JointBounds;
using planner::JointCourse;
using planner::Joints;
using planner::JointValues;
using planner::LimitedBy;
using planner::Path;
using planner::SegmentBounds;

constexpr double kGear = 3.0;

///   q0 = x + y,   q1 = x - y,   q2 = 3 z
class CrossedBelts final : public Joints {
 public:
  explicit CrossedBelts(const Path& path) : Joints(path, 3), axes_(path) {}
  const Joints& axes() const override { return axes_; }

  void at(std::size_t segment, double s_u, const JointValues& out) const override {
    axes_.at(segment, s_u, out);
    for (const std::span<double> q : {out.position_u, out.d1, out.d2_per_u, out.d3_per_u2}) {
      if (q.empty()) continue;
      const double x = q[0], y = q[1];
      q[0] = x + y;
      q[1] = x - y;
      q[2] *= kGear;
    }
  }

  void bound(std::size_t segment, SegmentBounds& out) const override {
    axes_.bound(segment, out);
    JointBounds& z = out.joint[2];
    for (double* value : {&z.slope, &z.tangent, &z.curvature_per_u, &z.third_per_u2}) *value *= kGear;
    if (out.straight) {
      const JointPlace begin(*this, segment, 0.0);
      out.joint[0].slope = std::fabs(begin.d1[0]);
      out.joint[1].slope = std::fabs(begin.d1[1]);
    } else {
      out.joint[0] = out.joint[1] = sum(out.joint[0], out.joint[1]);
    }
  }

  std::pair<double, double> extent_u(std::size_t segment, std::size_t joint) const override {
    const auto [low, high] = axes_.extent_u(segment, joint);
    if (joint == 2) return {kGear * low, kGear * high};
    const auto x = axes_.extent_u(segment, 0), y = axes_.extent_u(segment, 1);
    return joint == 0 ? std::pair(x.first + y.first, x.second + y.second)
                      : std::pair(x.first - y.second, x.second - y.first);
  }

  bool moves(std::size_t segment, std::size_t joint) const override {
    return joint == 2 ? axes_.moves(segment, 2) : axes_.moves(segment, 0) || axes_.moves(segment, 1);
  }
  double turn_rad(std::size_t segment) const override { return axes_.turn_rad(segment); }

 private:
  /// Of x + y and x - y: lengths of sums are at most sums of lengths.
  static JointBounds sum(const JointBounds& x, const JointBounds& y) {
    JointBounds q{std::max(x.course, y.course)};
    for (const JointBounds* b : {&x, &y}) {
      const bool turns = b->course != JointCourse::straight;
      q.slope += b->slope;
      q.tangent += turns ? b->skew * b->tangent : b->slope;
      q.curvature_per_u += turns ? b->skew * b->curvature_per_u : 0.0;
      // a circle's third derivative is shared with its tangent, under the same skew
      if (turns) q.third_per_u2 += (b->course == JointCourse::circle ? b->skew : 1.0) * b->third_per_u2;
    }
    return q;
  }

  planner::DirectJoints axes_;
};

/// The same with bounds that are too low for the first belt.
class WrongBelts final : public Joints {
 public:
  explicit WrongBelts(const Path& path) : Joints(path, 3), right_(path) {}
  const Joints& axes() const override { return right_.axes(); }
  void at(std::size_t segment, double s_u, const JointValues& out) const override {
    right_.at(segment, s_u, out);
  }
  void bound(std::size_t segment, SegmentBounds& out) const override {
    right_.bound(segment, out);
    out.joint[0].slope *= 0.99;
  }
  std::pair<double, double> extent_u(std::size_t segment, std::size_t joint) const override {
    return right_.extent_u(segment, joint);
  }
  bool moves(std::size_t segment, std::size_t joint) const override { return right_.moves(segment, joint); }
  double turn_rad(std::size_t segment) const override { return right_.turn_rad(segment); }

 private:
  CrossedBelts right_;
};

std::vector<planner::Violation> all_found(const Joints& joints, const FeedPlan& plan,
                                          const machine::MachineModel& machine) {
  planner::VerifyOptions options;
  options.most = 1'000'000;
  return planner::verify(joints, plan, machine, options);
}

bool names(const std::vector<planner::Violation>& found, const std::string& what, int joint) {
  return std::any_of(found.begin(), found.end(),
                     [&](const auto& v) { return v.what == what && v.axis == joint; });
}

/// A line for each belt alone, arcs, a helix, a climb and a rapid.
Path program(const machine::MachineModel& machine) {
  ProgramWriter w(machine);
  w.line(xyz(40, 40), 200);
  w.line(xyz(80, 0), 200);
  w.arc(gcode::Plane::xy, 80, 20, 1, xyz(100, 20), 200);
  w.arc(gcode::Plane::xy, 60, 20, 2, xyz(60, 60, 20), 200);
  w.arc(gcode::Plane::zx, 30, 60, 1, xyz(70, 60, 30), 200);
  w.line(xyz(70, 60, 0), 200);
  w.rapid(xyz(0, 0));
  return w.take();
}

}  // namespace

TEST_CASE("limits are limits of joints: caps of belts and a gear by hand") {
  // every joint: 110 mm/s, 2000 mm/s2, 40000 mm/s3, and steps of 2 mm/s at corners
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(30, 30), 200);  // x' = y' = 1/sqrt(2): the first belt runs at sqrt(2), the second rests
  w.line(xyz(60, 30), 200);  // both belts run at 1
  w.line(xyz(60, 60), 200);  // the first as before; the second turns round: from 1 to -1
  w.line(xyz(60, 60, 9), 200);
  const Path path = w.take();
  const auto table = planner::limit_table(CrossedBelts(path), machine);
  REQUIRE(table);
  const double root = std::sqrt(2.0);
  CHECK(table->cap_u_s[1] == doctest::Approx(110 / root).epsilon(1e-14));
  CHECK(table->signature[1] == planner::Signature{LimitedBy::axis_speed, 0});
  CHECK(table->accel_u_s2[0] == doctest::Approx(2000 / root).epsilon(1e-14));
  CHECK(table->jerk_u_s3[0] == doctest::Approx(40000 / root).epsilon(1e-14));
  CHECK(table->cap_u_s[3] == doctest::Approx(110).epsilon(1e-14));
  CHECK(table->cap_u_s[4] == doctest::Approx(1).epsilon(1e-14));
  CHECK(table->signature[4] == planner::Signature{LimitedBy::junction, 1});
  CHECK(table->cap_u_s[7] == doctest::Approx(110 / kGear).epsilon(1e-14));
  CHECK(table->signature[7] == planner::Signature{LimitedBy::axis_speed, 2});
  // as axes X and Y would allow more, and at the corner less
  const auto direct = planner::limit_table(path, machine);
  REQUIRE(direct);
  CHECK(direct->cap_u_s[1] == doctest::Approx(110 * root).epsilon(1e-14));
  CHECK(direct->cap_u_s[4] == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("a plan for belts keeps their limits, and one for the axes breaks them") {
  auto machine = plain_machine();
  machine.path.centripetal_accel_mm_s2 = 1500;
  const Path path = program(machine);
  const CrossedBelts belts(path);
  const auto plan = planner::plan(belts, machine);
  REQUIRE(plan);
  for (const auto& v : all_found(belts, *plan, machine))
    FAIL_CHECK(v.what << " of joint " << v.axis << ": " << v.value << ", allowed " << v.limit);
  // it is as fast as the first belt allows, across both
  CHECK(plan->segments[0].peak_u_s == doctest::Approx(110 / std::sqrt(2.0)).epsilon(1e-3));

  const auto of_axes = planner::plan(path, machine);
  REQUIRE(of_axes);
  CHECK(planner::verify(path, *of_axes, machine).empty());
  const auto found = all_found(belts, *of_axes, machine);
  for (const int belt : {0, 1}) {
    CHECK(names(found, "axis speed", belt));
    CHECK(names(found, "axis acceleration", belt));
    CHECK(names(found, "axis jerk", belt));
  }
  CHECK(names(found, "axis speed", 2));
  CHECK(names(found, "junction", 2));
}

TEST_CASE("verify() does not believe the bounds by which a plan was made") {
  const auto machine = plain_machine();
  ProgramWriter w(machine);
  w.line(xyz(60, 60), 200);
  const Path path = w.take();
  const auto plan = planner::plan(WrongBelts(path), machine);
  REQUIRE(plan);
  const auto found = all_found(CrossedBelts(path), *plan, machine);
  for (const char* what : {"axis speed", "axis acceleration", "axis jerk"}) CHECK(names(found, what, 0));
  CHECK(!names(found, "axis speed", 1));
}

TEST_CASE("plans for belts keep every limit on random paths, by every method that a machine may choose") {
  Random random(environment("KADR_SEED", 1));
  const std::uint64_t count = environment("KADR_COUNT", 4);
  for (std::uint64_t run = 0; run < count; ++run) {
    CAPTURE(run);
    auto machine = plain_machine();
    if (run % 2 == 1) machine.path.centripetal_accel_mm_s2 = 1000;
    AxisValues end{};
    const Path path = random_path(random, machine, end);
    const CrossedBelts belts(path);
    for (const auto& row : machine::kPlanMethodRows) {
      if (!row.plans) continue;
      machine.planner.method = row.method;
      const auto plan = planner::plan(belts, machine);
      REQUIRE(plan);
      for (const auto& v : all_found(belts, *plan, machine))
        FAIL_CHECK(row.word << ": " << v.what << " of joint " << v.axis << ": " << v.value << ", allowed "
                            << v.limit);
    }
  }
}

}  // namespace kadr::test
