#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string_view>
#include <vector>

#include "emulator/interpolator/interpolator.h"
#include "machine/base/numbers.h"
#include "machine/machine.h"
#include "planner/path/path.h"

/// Paths and tick motions made by hand, without planner, for the interpolator's tests.
namespace kadr::test {

inline std::uint64_t environment_count(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  if (text == nullptr) return otherwise;
  const std::string_view view(text);
  std::uint64_t value = otherwise;
  std::from_chars(view.data(), view.data() + view.size(), value);
  return value;
}

/// Uniform numbers with the same sequence on every platform.
struct Dice {
  explicit Dice(std::uint64_t seed) : engine(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  }
  int whole(int low, int high) {
    return low + static_cast<int>(engine() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  std::mt19937_64 engine;
};

inline machine::MachineModel machine_with(int axes, double step_u = 0.001, std::int64_t tau = 10'000) {
  machine::MachineModel machine;
  machine.clock.control_tick = Ticks{tau};
  for (int k = 0; k < axes; ++k) {
    machine::AxisModel axis;
    axis.letter = kAxisLetters[static_cast<std::size_t>(k)];
    axis.step_u = step_u;
    axis.max_feed_u_s = 1000.0;
    machine.axis.push_back(axis);
  }
  return machine;
}

class PathMaker {
 public:
  explicit PathMaker(std::vector<double> start) : path(static_cast<int>(start.size())), at(std::move(start)) {
    path.nodes_u = at;
    path.start_s_u = {0.0};
  }
  void line(const std::vector<double>& end) {
    double square = 0;
    for (std::size_t k = 0; k < at.size(); ++k) square += (end[k] - at[k]) * (end[k] - at[k]);
    if (square == 0.0) return;
    append(end, std::sqrt(square), -1);
  }
  /// Arc from here about a centre given relative to here; the other axes move to `end`.
  void arc(int first, int second, double to_center_first, double to_center_second, double sweep,
           double growth, std::vector<double> end) {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    planner::ArcShape shape;
    shape.first_axis = first;
    shape.second_axis = second;
    shape.center_first_u = at[a] + to_center_first;
    shape.center_second_u = at[b] + to_center_second;
    const double dx = at[a] - shape.center_first_u, dy = at[b] - shape.center_second_u;
    shape.radius_begin_u = std::sqrt(dx * dx + dy * dy);
    shape.radius_end_u = std::max(shape.radius_begin_u + growth, 0.25 * shape.radius_begin_u);
    shape.angle_begin_rad = exact_atan2(dy, dx);
    shape.sweep_rad = sweep;
    const double turns = std::floor(sweep / (2 * kPi));
    const SinCos t = exact_sincos(shape.angle_begin_rad + (sweep - turns * 2 * kPi));
    end[a] = shape.center_first_u + shape.radius_end_u * t.cos;
    end[b] = shape.center_second_u + shape.radius_end_u * t.sin;
    // a full circle ends where it began
    if (growth == 0.0 && sweep == turns * 2 * kPi) end[a] = at[a], end[b] = at[b];
    const double plane = 0.5 * (shape.radius_begin_u + shape.radius_end_u) * sweep;
    double square = plane * plane;
    for (std::size_t k = 0; k < at.size(); ++k)
      if (k != a && k != b) square += (end[k] - at[k]) * (end[k] - at[k]);
    path.arcs.push_back(shape);
    append(end, std::sqrt(square), static_cast<std::int32_t>(path.arcs.size()) - 1);
  }

  planner::Path path;
  std::vector<double> at;

 private:
  void append(const std::vector<double>& end, double length_u, std::int32_t arc_index) {
    planner::PathSegment segment;
    segment.kind = arc_index < 0 ? planner::SegmentKind::line : planner::SegmentKind::arc;
    segment.shape = arc_index;
    segment.length_u = length_u;
    segment.block = static_cast<std::uint32_t>(path.segments.size());
    path.segments.push_back(segment);
    path.start_s_u.push_back(path.start_s_u.back() + length_u);
    path.nodes_u.insert(path.nodes_u.end(), end.begin(), end.end());
    at = end;
  }
};

enum class Feed { linear, constant, wild };

/// Tick motions from rest to rest over a whole path, around a given speed. `wild` changes the feed at random,
/// rests now and then, and starts inside ticks.
inline std::vector<planner::TickMotion> drive(double length_u, double speed_u_s,
                                              const machine::MachineModel& machine, Feed feed,
                                              std::uint64_t seed) {
  Dice dice(seed);
  std::vector<planner::TickMotion> motions;
  const double tau_s = machine.clock.tau_s();
  const auto tau = static_cast<double>(machine.clock.control_tick.value);
  double s = 0, speed = 0;
  while (s < length_u) {
    planner::TickMotion m;
    m.tick = ControlTicks{static_cast<std::int64_t>(motions.size())};
    m.s_begin_u = s;
    m.speed_begin_u_s = m.ramp_begin_u_s = speed;
    double target = motions.empty() ? 0.5 * speed_u_s : speed_u_s;
    if (feed == Feed::wild) target = dice.chance(0.1) ? 0.0 : dice.between(0.0, 2.0) * speed_u_s;
    m.ramp_end_u_s = target;
    m.move_end_ticks = tau;
    if (feed == Feed::wild && speed == 0.0 && dice.chance(0.5))
      m.move_begin_ticks = dice.between(0.0, 0.9 * tau);
    if (feed == Feed::constant) m.ramp_begin_u_s = m.ramp_end_u_s = 0.5 * (speed + target);
    const double span_s = (m.move_end_ticks - m.move_begin_ticks) / tau * tau_s;
    const double way = 0.5 * (m.ramp_begin_u_s + m.ramp_end_u_s) * span_s;
    m.s_end_u = s + way;
    m.speed_end_u_s = target;
    if (m.s_end_u >= length_u) {
      // the same speeds over a shorter time end on the path's end
      m.s_end_u = length_u;
      m.move_end_ticks =
          m.move_begin_ticks + (m.move_end_ticks - m.move_begin_ticks) * ((length_u - s) / way);
      m.speed_end_u_s = 0.0;
    }
    s = m.s_end_u;
    speed = m.speed_end_u_s;
    motions.push_back(m);
  }
  return motions;
}

/// What a run over a path gave.
struct Run {
  std::vector<interpolator::StepEvent> events;   // all, in path order
  std::vector<std::int64_t> net, pulses, nodes;  // [axes]
  std::vector<double> worst_steps;               // [axes]
  std::vector<StepBatch> batches;
  std::uint64_t hash = 0;
};

inline Run run_path(const planner::Path& path, const machine::MachineModel& machine,
                    const std::vector<planner::TickMotion>& motions, bool keep_batches = false) {
  interpolator::CrossingInterpolator interpolator(path, machine);
  interpolator.set_self_check(true);
  interpolator.set_trace(true);
  StepHash hash;
  Run run;
  run.net.resize(machine.axis.size());
  run.pulses.resize(machine.axis.size());
  StepBatch batch;
  for (const planner::TickMotion& motion : motions) {
    interpolator.advance(motion, batch);
    hash.add(batch);
    for (std::size_t k = 0; k < batch.axis.size(); ++k) {
      run.net[k] += batch.axis[k].net_steps().value;
      run.pulses[k] += static_cast<std::int64_t>(batch.axis[k].count());
    }
    const auto& events = interpolator.trace();
    run.events.insert(run.events.end(), events.begin(), events.end());
    if (keep_batches) run.batches.push_back(batch);
  }
  run.nodes = interpolator.position_steps();
  run.worst_steps = interpolator.worst_node_error_steps();
  run.hash = hash.digest();
  return run;
}

/// Exact position of one axis on a segment, in long double, from the definitions in planner/path/path.h.
inline long double exact_position(const planner::Path& path, std::size_t segment, int axis, double s_u) {
  const planner::PathSegment& piece = path.segments[segment];
  const long double u = static_cast<long double>(s_u) / piece.length_u;
  const auto k = static_cast<std::size_t>(axis);
  if (piece.kind == planner::SegmentKind::arc) {
    const planner::ArcShape& arc = path.arc_of(segment);
    const long double r =
        arc.radius_begin_u + (static_cast<long double>(arc.radius_end_u) - arc.radius_begin_u) * u;
    const long double angle = arc.angle_begin_rad + arc.sweep_rad * u;
    if (arc.first_axis == axis) return arc.center_first_u + r * std::cos(angle);
    if (arc.second_axis == axis) return arc.center_second_u + r * std::sin(angle);
  }
  const long double begin = path.node(segment)[k], end = path.node(segment + 1)[k];
  return begin + (end - begin) * u;
}

}  // namespace kadr::test
