#include <algorithm>
#include <array>
#include <cmath>

#include "emulator/interpolator/arc_crossings.h"
#include "emulator/interpolator/curve_crossings.h"
#include "emulator/interpolator/interpolator.h"
#include "emulator/interpolator/line_crossings.h"
#include "emulator/interpolator/node_check.h"
#include "emulator/interpolator/slot_track.h"
#include "emulator/interpolator/tick_clock.h"
#include "machine/base/require.h"
#include "machine/machine.h"

namespace kadr::interpolator {

namespace {

/// A law's end may miss its rest by rounding.
constexpr double kRest_u_s = 1e-6;
// reversals are stored as 16-bit pulse numbers
constexpr std::size_t kMostPulsesBeforeReversal = 65535;

enum class Course : std::uint8_t { still, line, arc, curve };

/// One axis on the current segment.
struct AxisTrack {
  Course course = Course::still;
  int sign = 1;  // of the last pulse in this tick
  LineCrossings line;
  ArcCrossings arc;
  CurveCrossings curve;
};

}  // namespace

struct CrossingInterpolator::Impl {
  Impl(const planner::Path& the_path, const machine::MachineModel& the_machine);

  void advance(const planner::TickMotion& motion, StepBatch& batch);
  void prepare(StepBatch& batch) const;
  void rest(StepBatch& batch);
  void enter(std::size_t segment);
  void enter_axis(std::size_t axis, const planner::ArcShape* arc, const planner::PathCurve* curve);
  bool reaches_joint(const planner::TickMotion& motion) const;
  void emit(const planner::TickMotion& motion, const TickClock& clock, bool whole, StepBatch& batch);
  void emit_slots(const TickClock& clock, double s_end_u, bool whole, StepBatch& batch);
  void emit_pulse(std::size_t axis, const TickClock& clock, double s_u, int sign, AxisPulses& pulses);
  void emit_line(std::size_t axis, const TickClock& clock, double s_end_u, bool whole, AxisPulses& pulses);
  template <class Crossings>
  void emit_runs(std::size_t axis, Crossings& crossings, const TickClock& clock, double s_end_u, bool whole,
                 AxisPulses& pulses);
  std::uint16_t* append(std::size_t axis, std::size_t count, int sign, AxisPulses& pulses);
  void remember(std::size_t axis, const TickClock& clock, double s_u, int sign);
  void begin_commands(const planner::TickMotion& motion, bool corner, StepBatch& batch);
  void end_commands(const planner::TickMotion& motion, StepBatch& batch);

  const planner::Path& path;
  const machine::MachineModel& machine;
  std::size_t axes;

  std::size_t segment = 0;
  bool segment_done = true;  // its end was reached; the next one begins with the next motion
  bool entered = false;      // a first segment was entered
  bool joint_passed = false;
  double reached_u = 0;  // s_end of the last tick
  double ahead_u = 0;    // segment's beginning minus the tick's beginning

  std::vector<AxisTrack> track;     // [axes]
  std::vector<std::size_t> moving;  // axes with pulses on this segment, ascending
  SlotTrack slots;                  // another method than crossings, on this segment
  bool by_slots = false;
  std::vector<std::int64_t> steps;          // [axes] lattice nodes now
  std::vector<std::int64_t> node_end;       // [axes] lattice nodes of the segment's end
  std::vector<double> position_u, tangent;  // [axes] at the end of the last tick

  bool tracing = false, checking = false;
  std::vector<StepEvent> events;
  std::vector<std::int64_t> steps_before;
  NodeCheck check;
};

CrossingInterpolator::Impl::Impl(const planner::Path& the_path, const machine::MachineModel& the_machine)
    : path(the_path),
      machine(the_machine),
      axes(static_cast<std::size_t>(the_path.axes())),
      track(axes),
      steps(axes),
      node_end(axes),
      position_u(axes),
      tangent(axes),
      check(the_path, the_machine) {
  require(axes == machine.axis.size(), "the path has the machine's axes");
  require(machine.clock.control_tick.value >= 1 && machine.clock.control_tick.value <= 65536,
          "a control tick has 1 to 65536 base ticks");
  moving.reserve(axes);
  if (path.nodes_u.size() < axes) return;
  for (std::size_t k = 0; k < axes; ++k) {
    position_u[k] = path.node(0)[k];
    steps[k] = lattice_node(position_u[k], machine.axis[k].step_u);
  }
}

/// Which crossings does the segment have on each axis?
void CrossingInterpolator::Impl::enter(std::size_t to) {
  segment = to;
  segment_done = false;
  entered = true;
  moving.clear();
  const planner::PathSegment& piece = path.segments[to];
  const planner::ArcShape* arc = nullptr;
  if (piece.kind == planner::SegmentKind::arc) {
    arc = &path.arc_of(to);
    // a circle without extent is a straight line of the other axes
    if (arc->sweep_rad == 0.0 || !(std::max(arc->radius_begin_u, arc->radius_end_u) > 0.0)) arc = nullptr;
  }
  const planner::PathCurve* curve = piece.kind == planner::SegmentKind::curve ? &path.curve_of(to) : nullptr;
  for (std::size_t k = 0; k < axes; ++k) enter_axis(k, arc, curve);
  by_slots = slots.start(path, to, machine, steps, node_end);
}

void CrossingInterpolator::Impl::enter_axis(std::size_t axis, const planner::ArcShape* arc,
                                            const planner::PathCurve* curve) {
  const double begin_u = path.node(segment)[axis], end_u = path.node(segment + 1)[axis];
  const double length_u = path.segments[segment].length_u;
  const double step_u = machine.axis[axis].step_u;
  AxisTrack& at = track[axis];
  at.course = Course::still;
  const bool first = arc != nullptr && arc->first_axis == static_cast<int>(axis);
  const bool second = arc != nullptr && arc->second_axis == static_cast<int>(axis);
  const bool curved = first || second || (curve != nullptr && curve->moves(axis));
  if (begin_u == end_u && !curved) {
    node_end[axis] = steps[axis];
    return;
  }
  node_end[axis] = lattice_node(end_u, step_u);
  if (curve != nullptr && curved) {
    at.course = Course::curve;
    at.curve.start(*curve, axis, step_u, steps[axis], node_end[axis]);
  } else if (first || second) {
    at.course = Course::arc;
    at.arc.start(*arc, second, step_u, {steps[axis], node_end[axis], length_u});
  } else if (node_end[axis] != steps[axis]) {
    at.course = Course::line;
    at.line = LineCrossings::between(begin_u / step_u, end_u / step_u, steps[axis], node_end[axis], length_u);
  }
  if (at.course != Course::still) moving.push_back(axis);
}

bool CrossingInterpolator::Impl::reaches_joint(const planner::TickMotion& motion) const {
  const double left_u = path.start_s_u[segment + 1] - motion.s_end_u;
  return left_u <= 0.0 || (motion.speed_end_u_s <= kRest_u_s && left_u <= kSamePoint_u);
}

void CrossingInterpolator::Impl::advance(const planner::TickMotion& motion, StepBatch& batch) {
  batch.tick = motion.tick;
  if (batch.axis.size() != axes) prepare(batch);
  for (AxisPulses& pulses : batch.axis) pulses.clear();
  events.clear();
  joint_passed = false;
  require(motion.s_end_u >= motion.s_begin_u && motion.s_begin_u >= reached_u,
          "the path parameter never runs back");
  reached_u = motion.s_end_u;
  if (motion.s_end_u == motion.s_begin_u || path.size() == 0) return rest(batch);
  if (checking) steps_before = steps;

  const TickClock clock(motion, machine.clock.control_tick.value);
  bool begun = false, corner = false;
  for (;;) {
    if (segment_done) {
      const std::size_t to = entered ? segment + 1 : 0;
      if (to == path.size() || motion.s_end_u <= path.start_s_u[to]) break;
      enter(to);
      joint_passed = begun;
      corner = true;
    }
    if (!begun) begin_commands(motion, corner, batch);
    begun = true;
    segment_done = reaches_joint(motion);
    emit(motion, clock, segment_done, batch);
    if (!segment_done) break;
  }
  if (!begun) return rest(batch);
  for (std::size_t k = 0; k < axes; ++k) {
    AxisPulses& pulses = batch.axis[k];
    keep_ascending(pulses.offset_ticks.data(), pulses.offset_ticks.size());
  }
  end_commands(motion, batch);
  if (!tracing && !checking) return;
  // the events were found axis by axis; the index keeps pulses of one axis at one position in order
  std::stable_sort(events.begin(), events.end(), [](const StepEvent& a, const StepEvent& b) {
    if (a.segment != b.segment) return a.segment < b.segment;
    return a.s_u != b.s_u ? a.s_u < b.s_u : a.axis < b.axis;
  });
  if (checking) check.add(motion, steps_before, events);
}

/// Room for twice the pulses that an axis gives at its highest feed, so that running does not allocate.
void CrossingInterpolator::Impl::prepare(StepBatch& batch) const {
  batch.axis.resize(axes);
  for (std::size_t k = 0; k < axes; ++k) {
    const double pulses =
        2.0 * machine.axis[k].max_feed_u_s * machine.clock.tau_s() / machine.axis[k].step_u + 64.0;
    batch.axis[k].offset_ticks.reserve(static_cast<std::size_t>(pulses < 65536.0 ? pulses : 65536.0));
    batch.axis[k].reversals.reserve(64);
  }
}

void CrossingInterpolator::Impl::rest(StepBatch& batch) {
  for (std::size_t k = 0; k < axes; ++k) batch.axis[k].command = {position_u[k], position_u[k], 0.0, 0.0};
}

/// All pulses of the current segment up to the tick's end.
void CrossingInterpolator::Impl::emit(const planner::TickMotion& motion, const TickClock& clock, bool whole,
                                      StepBatch& batch) {
  ahead_u = path.start_s_u[segment] - motion.s_begin_u;
  const double s_end_u = motion.s_end_u - path.start_s_u[segment];
  if (by_slots) return emit_slots(clock, s_end_u, whole, batch);
  for (const std::size_t k : moving) {
    AxisTrack& at = track[k];
    if (at.course == Course::line)
      emit_line(k, clock, s_end_u, whole, batch.axis[k]);
    else if (at.course == Course::arc)
      emit_runs(k, at.arc, clock, s_end_u, whole, batch.axis[k]);
    else
      emit_runs(k, at.curve, clock, s_end_u, whole, batch.axis[k]);
    if (whole) require(steps[k] == node_end[k], "an axis ends a segment on the node of its end point");
  }
}

/// Pulses by slots; a method that misses the segment's end is taken there at it, as controllers do.
void CrossingInterpolator::Impl::emit_slots(const TickClock& clock, double s_end_u, bool whole,
                                            StepBatch& batch) {
  for (; !slots.at_end() && (whole || slots.s_u() <= s_end_u); slots.advance())
    for (std::size_t k = 0; k < axes; ++k)
      if (const int sign = slots.step(k); sign != 0) emit_pulse(k, clock, slots.s_u(), sign, batch.axis[k]);
  if (!whole) return;
  const double length_u = path.segments[segment].length_u;
  for (std::size_t k = 0; k < axes; ++k)
    while (steps[k] != node_end[k])
      emit_pulse(k, clock, length_u, node_end[k] > steps[k] ? 1 : -1, batch.axis[k]);
}

void CrossingInterpolator::Impl::emit_pulse(std::size_t axis, const TickClock& clock, double s_u, int sign,
                                            AxisPulses& pulses) {
  *append(axis, 1, sign, pulses) = clock.offset(clock.moment_ticks(s_u + ahead_u));
  if (tracing || checking) remember(axis, clock, s_u, sign);
}

void CrossingInterpolator::Impl::emit_line(std::size_t axis, const TickClock& clock, double s_end_u,
                                           bool whole, AxisPulses& pulses) {
  LineCrossings& line = track[axis].line;
  const std::int64_t to = whole ? line.count : line.reached(s_end_u);
  if (to == line.next) return;
  const auto count = static_cast<std::size_t>(to - line.next);
  std::uint16_t* offsets = append(axis, count, line.sign, pulses);
  stamp_line(clock, line.first_level, line.spacing_u, line.next, count, ahead_u, offsets);
  if (tracing || checking)
    for (std::int64_t k = line.next; k < to; ++k) remember(axis, clock, line.s_u(k), line.sign);
  line.next = to;
}

template <class Crossings>
void CrossingInterpolator::Impl::emit_runs(std::size_t axis, Crossings& crossings, const TickClock& clock,
                                           double s_end_u, bool whole, AxisPulses& pulses) {
  for (;;) {
    if (crossings.next == crossings.count && !crossings.find_run()) return;
    const double* s = crossings.s_u.data();
    const auto to =
        whole ? crossings.count
              : static_cast<int>(std::upper_bound(s + crossings.next, s + crossings.count, s_end_u) - s);
    const auto count = static_cast<std::size_t>(to - crossings.next);
    if (count > 0) {
      std::uint16_t* offsets = append(axis, count, crossings.sign, pulses);
      stamp_list(clock, s + crossings.next, count, ahead_u, offsets);
      if (tracing || checking)
        for (int k = crossings.next; k < to; ++k) remember(axis, clock, s[k], crossings.sign);
      crossings.next = to;
    }
    if (to < crossings.count) return;
  }
}

/// Makes room for pulses of one direction and counts them; returns where their offsets go.
std::uint16_t* CrossingInterpolator::Impl::append(std::size_t axis, std::size_t count, int sign,
                                                  AxisPulses& pulses) {
  const std::size_t before = pulses.offset_ticks.size();
  if (before == 0) {
    pulses.first_sign = static_cast<std::int8_t>(sign);
  } else if (track[axis].sign != sign) {
    require(before <= kMostPulsesBeforeReversal, "an axis has at most 65536 pulses in a control tick");
    pulses.reversals.push_back(static_cast<std::uint16_t>(before));
  }
  track[axis].sign = sign;
  steps[axis] += sign * static_cast<std::int64_t>(count);
  pulses.offset_ticks.resize(before + count);
  return pulses.offset_ticks.data() + before;
}

void CrossingInterpolator::Impl::remember(std::size_t axis, const TickClock& clock, double s_u, int sign) {
  const double on_segment_u = std::clamp(s_u, 0.0, path.segments[segment].length_u);
  events.push_back(
      {segment, on_segment_u, static_cast<std::int32_t>(axis), sign, clock.moment_ticks(s_u + ahead_u)});
}

void CrossingInterpolator::Impl::begin_commands(const planner::TickMotion& motion, bool corner,
                                                StepBatch& batch) {
  // before the motion begins inside the tick the axes are at rest
  const double speed_u_s = motion.move_begin_ticks > 0.0 ? 0.0 : motion.ramp_begin_u_s;
  // on the same segment the tangent is that of the last tick's end
  if (corner) planner::eval_tangent(path, segment, motion.s_begin_u - path.start_s_u[segment], tangent);
  for (std::size_t k = 0; k < axes; ++k) {
    batch.axis[k].command.position_begin_u = position_u[k];
    batch.axis[k].command.speed_begin_u_s = tangent[k] * speed_u_s;
  }
}

void CrossingInterpolator::Impl::end_commands(const planner::TickMotion& motion, StepBatch& batch) {
  const auto tau = static_cast<double>(machine.clock.control_tick.value);
  const double speed_u_s = motion.move_end_ticks < tau ? 0.0 : motion.ramp_end_u_s;
  const double length_u = path.segments[segment].length_u;
  const double s_u = segment_done ? length_u : motion.s_end_u - path.start_s_u[segment];
  planner::eval_position(path, segment, s_u, position_u);
  planner::eval_tangent(path, segment, s_u, tangent);
  for (std::size_t k = 0; k < axes; ++k) {
    batch.axis[k].command.position_end_u = position_u[k];
    batch.axis[k].command.speed_end_u_s = tangent[k] * speed_u_s;
  }
}

CrossingInterpolator::CrossingInterpolator(const planner::Path& path, const machine::MachineModel& machine)
    : impl_(std::make_unique<Impl>(path, machine)) {}
CrossingInterpolator::~CrossingInterpolator() = default;

void CrossingInterpolator::advance(const planner::TickMotion& motion, StepBatch& batch) {
  impl_->advance(motion, batch);
}
const std::vector<std::int64_t>& CrossingInterpolator::position_steps() const { return impl_->steps; }
std::size_t CrossingInterpolator::segment() const { return impl_->segment; }
bool CrossingInterpolator::passed_joint() const { return impl_->joint_passed; }
void CrossingInterpolator::set_self_check(bool on) { impl_->checking = on; }
const std::vector<double>& CrossingInterpolator::worst_node_error_steps() const {
  return impl_->check.worst_steps();
}
std::size_t CrossingInterpolator::worst_node_segment() const { return impl_->check.worst_segment(); }
void CrossingInterpolator::set_trace(bool on) { impl_->tracing = on; }
const std::vector<StepEvent>& CrossingInterpolator::trace() const { return impl_->events; }

}  // namespace kadr::interpolator
