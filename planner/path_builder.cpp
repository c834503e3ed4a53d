#include <algorithm>
#include <cmath>
#include <string>

#include "machine/base/numbers.h"
#include "machine/base/require.h"
#include "planner/path.h"

namespace kadr::planner {
namespace {

double norm(double a, double b) { return std::sqrt(a * a + b * b); }

/// Signed angle of an arc. End points that coincide but for rounding leave it open whether a full turn or
/// none is meant; the length that the program's reader gave decides.
double signed_sweep(double from_first, double from_second, double to_first, double to_second, int turns,
                    double planar_length_u, double mean_radius_u) {
  const double direction = turns >= 0 ? 1.0 : -1.0;
  const double cross = from_first * to_second - from_second * to_first;
  const double dot = from_first * to_first + from_second * to_second;
  double angle = direction * exact_atan2(cross, dot);
  if (angle <= 0.0) angle += 2.0 * kPi;
  angle += 2.0 * kPi * static_cast<double>(std::max(std::abs(turns) - 1, 0));
  if (planar_length_u > 0.0 && mean_radius_u > 0.0) {
    const double told = planar_length_u / mean_radius_u;
    for (const double other : {angle - 2.0 * kPi, angle + 2.0 * kPi})
      if (other > 0.0 && std::fabs(other - told) < 1e-3 * std::fabs(angle - told)) {
        angle = other;
        break;
      }
  }
  return direction * angle;
}

}  // namespace

PathBuilder::PathBuilder(const machine::MachineModel& machine, const AxisValues& start_u)
    : machine_(machine), path_(static_cast<int>(machine.axis.size())) {
  for (const machine::AxisModel& axis : machine.axis) {
    const int index = axis_index(axis.letter);
    require(index >= 0, "every machine axis has one of the nine letters");
    program_axis_.push_back(index);
    path_.nodes_u.push_back(start_u[static_cast<std::size_t>(index)]);
  }
  path_.start_s_u.push_back(0.0);
}

void PathBuilder::stop() {
  if (!path_.segments.empty()) path_.segments.back().stop_at_end = true;
}

void PathBuilder::add(const gcode::Block& block) {
  require(block.kind == gcode::BlockKind::traverse || block.kind == gcode::BlockKind::feed ||
              block.kind == gcode::BlockKind::arc,
          "only moves make path");
  const auto axes = program_axis_.size();
  PathSegment seg;
  seg.rapid = block.kind == gcode::BlockKind::traverse;
  seg.stop_at_end = block.path_mode == gcode::PathMode::exact_stop;
  seg.feed_override_enabled = block.feed_override_enabled;
  seg.block = blocks_++;
  seg.span = block.span;

  const std::size_t last = path_.nodes_u.size() - axes;
  double squares = 0.0;      // over the axes that move linearly
  double xyz_squares = 0.0;  // those of them that are X Y Z
  ArcShape arc;
  const bool is_arc = block.kind == gcode::BlockKind::arc;
  if (is_arc && !arc_shape(block, arc)) return;
  for (std::size_t j = 0; j < axes; ++j) {
    const double step = block.end[static_cast<std::size_t>(program_axis_[j])] - path_.nodes_u[last + j];
    const int axis = static_cast<int>(j);
    if (is_arc && (axis == arc.first_axis || axis == arc.second_axis)) continue;
    squares += step * step;
    if (program_axis_[j] < 3) xyz_squares += step * step;
  }
  if (is_arc) {
    const double mean_radius = 0.5 * (arc.radius_begin_u + arc.radius_end_u);
    const double told = std::sqrt(std::max(block.length_u * block.length_u - xyz_squares, 0.0));
    arc.sweep_rad =
        signed_sweep(path_.nodes_u[last + static_cast<std::size_t>(arc.first_axis)] - arc.center_first_u,
                     path_.nodes_u[last + static_cast<std::size_t>(arc.second_axis)] - arc.center_second_u,
                     end_of(block, arc.first_axis) - arc.center_first_u,
                     end_of(block, arc.second_axis) - arc.center_second_u, block.turns,
                     block.feed_length == gcode::FeedLength::xyz ? told : 0.0, mean_radius);
    const double planar = mean_radius * std::fabs(arc.sweep_rad);
    squares += planar * planar;
    xyz_squares += planar * planar;
    // a circle of radius zero is a point: what is left is the straight motion of the other axes
    if (planar > 0.0) seg.kind = SegmentKind::arc;
  }
  seg.length_u = std::sqrt(squares);

  const double s = path_.start_s_u.back();
  if (!(s + seg.length_u > s)) {
    // too short to count in s: the path ends where the program says, to the last bit, without a new segment
    if (seg.length_u > 0.0) move_last_node(block);
    if (seg.stop_at_end) stop();
    return;
  }

  // what F measures; a reader that gave no length leaves it to the geometry
  seg.path_limits = xyz_squares > 0.0;
  seg.feed_length_u = block.length_u > 0.0 ? block.length_u
                      : xyz_squares > 0.0  ? std::sqrt(xyz_squares)
                                           : seg.length_u;
  if (seg.path_limits && block.feed_length != gcode::FeedLength::xyz)
    seg.feed_length_u = std::sqrt(xyz_squares);
  if (seg.rapid)
    seg.feed_u_s = machine::kInfinity;
  else if (block.duration_s > 0.0)
    seg.feed_u_s = seg.length_u / block.duration_s;
  else
    seg.feed_u_s = block.feed_u_s * seg.length_u / seg.feed_length_u;

  for (std::size_t j = 0; j < axes; ++j)
    path_.nodes_u.push_back(block.end[static_cast<std::size_t>(program_axis_[j])]);
  path_.start_s_u.push_back(s + seg.length_u);
  if (seg.kind == SegmentKind::arc) {
    seg.arc = static_cast<std::int32_t>(path_.arcs.size());
    path_.arcs.push_back(arc);
  }
  path_.segments.push_back(seg);
}

double PathBuilder::end_of(const gcode::Block& block, int axis) const {
  return block.end[static_cast<std::size_t>(program_axis_[static_cast<std::size_t>(axis)])];
}

void PathBuilder::move_last_node(const gcode::Block& block) {
  const std::size_t last = path_.nodes_u.size() - program_axis_.size();
  for (std::size_t j = 0; j < program_axis_.size(); ++j)
    path_.nodes_u[last + j] = end_of(block, static_cast<int>(j));
}

bool PathBuilder::arc_shape(const gcode::Block& block, ArcShape& arc) {
  const gcode::PlaneAxes plane = gcode::plane_axes(block.plane);
  const auto machine_axis = [&](int program_axis) {
    const auto it = std::find(program_axis_.begin(), program_axis_.end(), program_axis);
    return it == program_axis_.end() ? -1 : static_cast<int>(it - program_axis_.begin());
  };
  arc.first_axis = machine_axis(plane.first);
  arc.second_axis = machine_axis(plane.second);
  if (arc.first_axis < 0 || arc.second_axis < 0) {
    const char missing =
        kAxisLetters[static_cast<std::size_t>(arc.first_axis < 0 ? plane.first : plane.second)];
    Diagnostic d{};
    d.code = Code::arc_axis_missing;
    d.span = block.span;
    d.message = std::string(code_entry(d.code).title);
    d.label = std::string("the arc needs axis ") + missing;
    std::string letters;
    for (const machine::AxisModel& axis : machine_.axis) letters += axis.letter;
    d.notes.push_back("machine '" + machine_.name + "' has the axes " + letters);
    d.help = "choose the plane with G17, G18 or G19, or a machine that has both axes of it";
    path_.faults.push_back(std::move(d));
    return false;
  }
  arc.center_first_u = block.center_first_mm;
  arc.center_second_u = block.center_second_mm;
  const std::size_t last = path_.nodes_u.size() - program_axis_.size();
  const double first = path_.nodes_u[last + static_cast<std::size_t>(arc.first_axis)] - arc.center_first_u;
  const double second = path_.nodes_u[last + static_cast<std::size_t>(arc.second_axis)] - arc.center_second_u;
  arc.radius_begin_u = norm(first, second);
  arc.radius_end_u = norm(end_of(block, arc.first_axis) - arc.center_first_u,
                          end_of(block, arc.second_axis) - arc.center_second_u);
  arc.angle_begin_rad = exact_atan2(second, first);
  return true;
}

}  // namespace kadr::planner
