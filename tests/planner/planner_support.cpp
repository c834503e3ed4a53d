#include "planner_support.h"

#include <algorithm>

#include "gcode/block.h"
#include "machine/machine.h"

namespace kadr::test {

machine::MachineModel random_machine(Random& r) {
  static const char* const kLetters[] = {"XYZ", "XYZA", "XYZABC", "XYZAUV", "XYZABCUVW"};
  machine::MachineModel m = plain_machine(kLetters[r.below(5)]);
  const bool trapezoid = r.chance(0.25);
  for (machine::AxisModel& axis : m.axis) {
    axis.max_feed_u_s = r.decades(20.0, 600.0);
    axis.max_accel_u_s2 = r.decades(100.0, 20000.0);
    axis.max_jerk_u_s3 = trapezoid || r.chance(0.03) ? kInfinity : r.decades(2000.0, 2e6);
    axis.junction_accel_u_s2 = r.decades(100.0, 20000.0);
    axis.junction_jerk_u_s3 = r.chance(0.3) ? r.decades(1e5, 1e8) : kInfinity;
  }
  if (r.chance(0.3)) m.path.max_feed_mm_s = r.decades(20.0, 300.0);
  if (r.chance(0.3)) m.path.max_accel_mm_s2 = r.decades(200.0, 5000.0);
  if (r.chance(0.3)) m.path.max_jerk_mm_s3 = r.decades(5000.0, 1e6);
  if (r.chance(0.5)) m.path.centripetal_accel_mm_s2 = r.decades(100.0, 5000.0);
  static constexpr std::int64_t kTicks[] = {2500, 10000, 40000};
  m.clock.control_tick = Ticks{kTicks[r.below(3)]};
  m.planner.whole_ticks = r.chance(0.6);
  if (r.chance(0.1)) m.planner.axis_limits = machine::AxisLimitRule::report;
  return m;
}

namespace {

class RandomProgram {
 public:
  RandomProgram(Random& random, const machine::MachineModel& machine)
      : r_(random), machine_(machine), writer_(machine, random_start(random, machine)) {}

  planner::Path make(AxisValues& end) {
    const int parts = 1 + r_.below(12);
    for (int i = 0; i < parts; ++i) part();
    end = writer_.at();
    return writer_.take();
  }

 private:
  static AxisValues random_start(Random& r, const machine::MachineModel& machine) {
    AxisValues start{};
    for (const machine::AxisModel& axis : machine.axis)
      start[static_cast<std::size_t>(axis_index(axis.letter))] = r.between(-50.0, 50.0);
    return start;
  }

  double feed() { return r_.decades(0.5, 400.0); }

  AxisValues moved(double length, bool all_axes) {
    AxisValues to = writer_.at();
    for (const machine::AxisModel& axis : machine_.axis) {
      const int k = axis_index(axis.letter);
      if (k >= 3 && !all_axes) continue;
      if (r_.chance(0.75)) to[static_cast<std::size_t>(k)] += length * r_.between(-1.0, 1.0);
    }
    return to;
  }

  void part() {
    writer_.mode = r_.chance(0.15) ? gcode::PathMode::exact_stop : gcode::PathMode::exact_path;
    // one draw per statement: the order of arguments is the compiler's choice
    const double speed = feed();
    const double long_way = r_.decades(0.1, 100.0);
    const double any_way = r_.decades(1e-4, 100.0);
    switch (r_.below(11)) {
      case 0:
        writer_.rapid(moved(r_.decades(0.01, 200.0), true));
        break;
      case 1:
        writer_.line(moved(any_way, false), speed);
        break;
      case 2:
        writer_.line(moved(long_way, true), speed);
        break;
      case 3:
        writer_.timed_line(moved(0.5 * long_way, true), 2.0 / speed);
        break;
      case 4:
        arc(1 + r_.below(3), false);
        break;
      case 5:
        arc(1 + r_.below(2), true);
        break;
      case 6:
        chain(true);
        break;
      case 7:
        chain(false);
        break;
      case 8:
        tiny();
        break;
      case 9:
        curve();
        break;
      default:
        writer_.line(writer_.at(), speed);
        writer_.stop();
        break;
    }
    if (r_.chance(0.1)) writer_.stop();
  }

  /// An arc, helix or spiral of the program's rounding; a full circle if closed.
  void arc(int turns, bool closed) {
    static constexpr gcode::Plane kPlanes[] = {gcode::Plane::xy, gcode::Plane::zx, gcode::Plane::yz};
    const gcode::Plane plane = kPlanes[r_.below(3)];
    const gcode::PlaneAxes axes = gcode::plane_axes(plane);
    const auto f = static_cast<std::size_t>(axes.first);
    const auto s = static_cast<std::size_t>(axes.second);
    const double radius = r_.decades(0.01, 80.0);
    const SinCos from = exact_sincos(r_.between(0.0, 2.0 * kPi));
    AxisValues to = writer_.at();
    const double cf = to[f] - radius * from.cos;
    const double cs = to[s] - radius * from.sin;
    if (!closed) {
      const SinCos angle = exact_sincos(r_.between(0.0, 2.0 * kPi));
      const double rounding = r_.chance(0.5) ? 0.0 : r_.between(-0.5, 0.5) * std::min(0.01, radius);
      to[f] = cf + (radius + rounding) * angle.cos;
      to[s] = cs + (radius + rounding) * angle.sin;
    }
    if (r_.chance(0.4)) to[static_cast<std::size_t>(axes.normal)] += r_.between(-10.0, 10.0);
    if (machine_.find_axis('A') >= 0 && r_.chance(0.3)) to[3] += r_.between(-90.0, 90.0);
    const int signed_turns = r_.chance(0.5) ? turns : -turns;
    writer_.arc(plane, cf, cs, signed_turns, to, feed());
  }

  /// A straight line in equal or unequal pieces.
  void chain(bool equal) {
    const int n = 2 + r_.below(60);
    const double length = r_.decades(0.01, 2.0);
    const double fx = r_.between(-1.0, 1.0), fy = r_.between(-1.0, 1.0), speed = feed();
    for (int i = 0; i < n; ++i) {
      AxisValues to = writer_.at();
      const double step = equal ? length : length * r_.decades(0.01, 1.0);
      to[0] += fx * step;
      to[1] += fy * step;
      writer_.line(to, equal ? speed : speed * r_.between(0.5, 1.0));
    }
  }

  void tiny() {
    const int n = 1 + r_.below(50);
    const double length = r_.decades(1e-4, 0.03), speed = feed();
    for (int i = 0; i < n; ++i) writer_.line(moved(length, r_.chance(0.2)), speed);
  }

  /// Facets of a smooth curve, rounded as a program is.
  void curve() {
    const int n = 10 + r_.below(150);
    const double step = r_.decades(0.02, 1.0), speed = feed(), grid = r_.chance(0.5) ? 1e-3 : 1e-4;
    double angle = r_.between(0.0, 2.0 * kPi), turn = 0.0;
    AxisValues exact = writer_.at();
    for (int i = 0; i < n; ++i) {
      turn = 0.9 * turn + r_.between(-0.02, 0.02);
      angle += turn;
      const SinCos d = exact_sincos(angle);
      exact[0] += step * d.cos;
      exact[1] += step * d.sin;
      AxisValues to = exact;
      to[0] = std::floor(to[0] / grid + 0.5) * grid;
      to[1] = std::floor(to[1] / grid + 0.5) * grid;
      writer_.line(to, speed);
    }
  }

  Random& r_;
  const machine::MachineModel& machine_;
  ProgramWriter writer_;
};

}  // namespace

planner::Path random_path(Random& random, const machine::MachineModel& machine, AxisValues& end) {
  return RandomProgram(random, machine).make(end);
}

}  // namespace kadr::test
