#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string>

#include "gcode/block.h"
#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/planner.h"

/// Machines, blocks and random programs for the planner's tests.
namespace kadr::test {

using machine::kInfinity;

/// X Y Z (or the letters given), all axes alike: 110 mm/s, a 2000 mm/s2, jerk 40000 mm/s3, corners a_inst tau
/// = 2 mm/s, tau 1 ms: the numbers of the feed scheduler's tables.
inline machine::MachineModel plain_machine(const std::string& letters = "XYZ") {
  machine::MachineModel m;
  m.name = "test";
  for (const char letter : letters) {
    machine::AxisModel axis;
    axis.letter = letter;
    axis.kind = is_rotary_letter(letter) ? machine::AxisKind::rotary : machine::AxisKind::linear;
    axis.step_u = 0.001;
    axis.max_feed_u_s = 110.0;
    axis.max_accel_u_s2 = 2000.0;
    axis.max_jerk_u_s3 = 40000.0;
    axis.junction_accel_u_s2 = 2000.0;
    m.axis.push_back(axis);
  }
  return m;
}

/// The same with trapezoidal profiles and free times.
inline machine::MachineModel trapezoid_machine(const std::string& letters = "XYZ") {
  machine::MachineModel m = plain_machine(letters);
  for (machine::AxisModel& axis : m.axis) axis.max_jerk_u_s3 = kInfinity;
  m.planner.whole_ticks = false;
  return m;
}

/// Writes blocks as the interpreter would: lengths that F measures follow the NIST rule.
class ProgramWriter {
 public:
  explicit ProgramWriter(const machine::MachineModel& machine, const AxisValues& start = {})
      : builder_(machine, start), at_(start) {}

  gcode::PathMode mode = gcode::PathMode::exact_path;

  void line(const AxisValues& to, double feed_u_s) {
    auto b = move<gcode::Feed>(to);
    b.feed_u_s = feed_u_s;
    measure(b, 0.0, -1, -1);
    send(b);
  }
  void rapid(const AxisValues& to) {
    auto b = move<gcode::Traverse>(to);
    measure(b, 0.0, -1, -1);
    send(b);
  }
  void timed_line(const AxisValues& to, double duration_s) {
    auto b = move<gcode::Feed>(to);
    b.duration_s = duration_s;
    measure(b, 0.0, -1, -1);
    send(b);
  }
  /// turns > 0 counter-clockwise from the plane's first axis to its second.
  void arc(gcode::Plane plane, double center_first, double center_second, int turns, const AxisValues& to,
           double feed_u_s) {
    auto b = move<gcode::Arc>(to);
    b.plane = plane;
    b.center_first_mm = center_first;
    b.center_second_mm = center_second;
    b.turns = turns;
    b.feed_u_s = feed_u_s;
    const gcode::PlaneAxes axes = gcode::plane_axes(plane);
    const auto f = static_cast<std::size_t>(axes.first);
    const auto s = static_cast<std::size_t>(axes.second);
    const double a0 = exact_atan2(at_[s] - center_second, at_[f] - center_first);
    const double a1 = exact_atan2(to[s] - center_second, to[f] - center_first);
    double sweep = turns > 0 ? a1 - a0 : a0 - a1;
    const bool closed = to[f] == at_[f] && to[s] == at_[s];
    while (closed ? sweep < kPi : sweep <= 0.0) sweep += 2.0 * kPi;
    sweep += 2.0 * kPi * (std::abs(turns) - 1);
    const auto radius = [&](const AxisValues& p) {
      const double x = p[f] - center_first, y = p[s] - center_second;
      return std::sqrt(x * x + y * y);
    };
    measure(b, 0.5 * (radius(at_) + radius(to)) * sweep, axes.first, axes.second);
    send(b);
  }
  void stop() { builder_.stop(); }
  const AxisValues& at() const { return at_; }
  planner::Path take() { return builder_.take(); }

 private:
  template <gcode::MoveAction M>
  M move(const AxisValues& to) const {
    M b;
    b.end = to;
    b.path_mode = mode;
    return b;
  }
  void measure(gcode::Move& b, double planar, int first, int second) const {
    const auto length = [&](int from, int to) {
      double sum = 0.0;
      for (int k = from; k < to; ++k) {
        const auto i = static_cast<std::size_t>(k);
        if (k != first && k != second) sum += (b.end[i] - at_[i]) * (b.end[i] - at_[i]);
      }
      return sum;
    };
    const double xyz = length(0, 3) + planar * planar;
    const double uvw = length(6, 9);
    b.feed_length = xyz > 0   ? gcode::FeedLength::xyz
                    : uvw > 0 ? gcode::FeedLength::uvw
                              : gcode::FeedLength::rotary;
    b.length_u = std::sqrt(xyz > 0 ? xyz : uvw > 0 ? uvw : length(3, 6));
  }
  template <gcode::MoveAction M>
  void send(const M& b) {
    builder_.add({{}, b});
    at_ = b.end;
  }
  planner::PathBuilder builder_;
  AxisValues at_;
};

inline AxisValues xyz(double x, double y = 0.0, double z = 0.0) { return {x, y, z, 0, 0, 0, 0, 0, 0}; }

/// What the joints do at a place of a path, by joint.
struct JointPlace {
  JointPlace(const planner::Joints& joints, std::size_t segment, double local_s) {
    const std::size_t n = joints.size();
    joints.at(segment, local_s, {{x.data(), n}, {d1.data(), n}, {d2.data(), n}, {d3.data(), n}});
  }
  /// Of the axes.
  JointPlace(const planner::Path& path, std::size_t segment, double local_s)
      : JointPlace(planner::DirectJoints(path), segment, local_s) {}
  std::array<double, kProgramAxes> x{}, d1{}, d2{}, d3{};
};

/// splitmix64: the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Spread evenly over the decades.
  double decades(double low, double high) { return exact_exp(between(exact_log(low), exact_log(high))); }
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  bool chance(double p) { return unit() < p; }

 private:
  std::uint64_t state_;
};

inline std::uint64_t environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

machine::MachineModel random_machine(Random& random);
/// Lines, arcs, helices, full circles, tiny and collinear segments, rotary motion, stops. @param end the last position
planner::Path random_path(Random& random, const machine::MachineModel& machine, AxisValues& end);

}  // namespace kadr::test
