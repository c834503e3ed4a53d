#include "gcode/compensation/compensation.h"

#include <cmath>
#include <utility>

#include "gcode/measure.h"
#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

using Kind = CompensationFault::Kind;

// an entry arc whose chord is that close to a right angle with its radius would be a straight line
constexpr double kLeastEntryCosine = 1e-4;
constexpr double kDegreesPerRadian = 180 / kPi;

/// Said at once, though a move waits.
bool overtakes(const Block& block) {
  return block.kind == BlockKind::message || block.kind == BlockKind::comment ||
         block.kind == BlockKind::select_tool || block.kind == BlockKind::set_tool_number;
}

bool stops(const Block& block) {
  return block.kind == BlockKind::program_stop || block.kind == BlockKind::optional_stop ||
         block.kind == BlockKind::program_end;
}

PlanePoint center_of(const Block& arc) { return {arc.center_first_mm, arc.center_second_mm}; }

double sweep_rad(const Block& arc, PlanePoint start, PlanePoint end) {
  return arc_sweep_rad(start, end, center_of(arc), arc.turns < 0, std::abs(arc.turns));
}

/// Direction of an arc where it starts.
PlaneVector start_direction(const Block& arc, PlanePoint start) {
  return turned(unit(start - center_of(arc)), arc.turns > 0 ? 1 : -1);
}

}  // namespace

bool is_move(const Block& block) {
  switch (block.kind) {
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::probe:
    case BlockKind::rigid_tap:
      return true;
    case BlockKind::dwell:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::spindle_speed:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
    case BlockKind::spindle_mode:
    case BlockKind::select_tool:
    case BlockKind::change_tool:
    case BlockKind::set_tool_number:
    case BlockKind::digital_output:
    case BlockKind::analog_output:
    case BlockKind::wait_input:
    case BlockKind::message:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return false;
}

void Compensation::begin(const CompensationTool& tool, const AxisValues& at) {
  tool_ = tool;
  side_ = tool.left ? 1 : -1;
  axes_ = plane_axes(tool.plane);
  // G41 right behind G40: the tool still stands beside the old contour
  if (phase_ != Phase::exit) handed_out_ = at;
  programmed_ = at;
  tool_at_ = in_plane(at);
  held_start_known_ = false;
  phase_ = Phase::entry;
}

CompensationFault Compensation::take(const Block& block, const FeedRates& feeds) {
  if (is_move(block)) return move(block, feeds);
  CompensationFault fault;
  if (stops(block)) {
    fault = trim(tool_at_);
    held_start_known_ = false;
  }
  Held held{block, feeds, {}, 0};
  if (held_.empty() || overtakes(block)) {
    receiver_(held.block);
  } else {
    held_.push_back(std::move(held));
  }
  return fault;
}

CompensationFault Compensation::move(const Block& block, const FeedRates& feeds) {
  const bool arc = block.kind == BlockKind::arc;
  CompensationFault fault;
  switch (phase_) {
    case Phase::off:
      break;
    case Phase::entry:
      fault = arc ? enter_arc(block, feeds) : enter_line(block, feeds);
      phase_ = Phase::contour;
      break;
    case Phase::contour:
      fault = arc ? follow_arc(block, feeds) : follow_line(block, feeds);
      break;
    case Phase::lost:
    case Phase::exit: {
      Block copy = block;
      measure(copy, feeds);
      receiver_(copy);
      if (phase_ == Phase::exit) phase_ = Phase::off;
      break;
    }
  }
  programmed_ = block.end;
  return fault;
}

CompensationFault Compensation::end() {
  CompensationFault fault;
  if (phase_ == Phase::contour) fault = trim(tool_at_);
  release();
  phase_ = phase_ == Phase::entry ? Phase::off : Phase::exit;
  return fault;
}

void Compensation::lose() {
  if (phase_ != Phase::entry && phase_ != Phase::contour) return;
  release();
  phase_ = Phase::lost;
}

AxisValues Compensation::shift() const {
  AxisValues shift{};
  if (phase_ == Phase::contour) set_in_plane(shift, tool_at_ - in_plane(programmed_));
  return shift;
}

CompensationFault Compensation::enter_line(const Block& block, const FeedRates& feeds) {
  const PlaneVector way = in_plane(block.end) - tool_at_;
  CompensationFault fault;
  if (length(way) <= tool_.radius_mm) fault = {Kind::entry_short, length(way), tool_.radius_mm, {}};
  const PlaneVector across = turned(unit(way), side_);
  held_start_ = tool_at_;
  held_start_known_ = true;
  // longer than the radius, it can't be trimmed to run backwards: across is what trimming never reverses
  hold(block, feeds, in_plane(block.end) + tool_.radius_mm * across, across, 0);
  return fault;
}

CompensationFault Compensation::enter_arc(const Block& block, const FeedRates& feeds) {
  const PlanePoint end = in_plane(block.end);
  const PlanePoint center = center_of(block);
  const double chord = length(end - tool_at_);
  const double radius = length(tool_at_ - center);
  if (chord <= tool_.radius_mm) {
    hold(block, feeds, end, {}, 0);
    return {Kind::entry_short, chord, tool_.radius_mm, {}};
  }
  CompensationFault fault;
  if (inside(block) && radius <= tool_.radius_mm) fault = {Kind::arc_small, radius, tool_.radius_mm, {}};

  // the arc that leads from here to beside the end and has the programmed direction there
  const PlanePoint tool_end = end + tool_.radius_mm * unit(inside(block) ? center - end : end - center);
  const PlaneVector to_center = unit(center - tool_end);
  const PlaneVector back = tool_at_ - tool_end;
  const double cosine = dot(unit(back), to_center);
  if (std::fabs(cosine) < kLeastEntryCosine && !fault) fault = {Kind::entry_arc, 0, 0, {}};
  if (fault) {
    hold(block, feeds, tool_end, {}, 0);
    return fault;
  }
  Block arc = block;
  const PlanePoint moved = tool_end + (length(back) / 2 / cosine) * to_center;
  arc.center_first_mm = moved.first_mm;
  arc.center_second_mm = moved.second_mm;
  if (tool_.origin != AxisValues{}) {
    // the controlled point must first stand off the nose's centre, or the arc would be none
    Held line{block, feeds, {}, 0};
    line.block.kind = BlockKind::feed;
    line.block.center_first_mm = line.block.center_second_mm = 0;
    line.block.turns = 0;
    line.block.end[static_cast<std::size_t>(axes_.normal)] =
        programmed_[static_cast<std::size_t>(axes_.normal)];
    set_in_plane(line.block.end, tool_at_);
    hand_out(line);
    held_start_ = tool_at_;
    held_start_known_ = true;
  }
  hold(arc, feeds, tool_end, {}, sweep_rad(arc, tool_at_, tool_end));
  return fault;
}

CompensationFault Compensation::follow_line(const Block& block, const FeedRates& feeds) {
  const PlanePoint from = in_plane(programmed_);
  const PlaneVector way = in_plane(block.end) - from;
  if (same(in_plane(block.end), from)) {
    hold(block, feeds, tool_at_, {}, 0);
    return {};
  }
  const PlaneVector next = unit(way);
  const PlaneVector across = tool_.radius_mm * turned(next, side_);
  const bool beside_bulge = !held_.empty() && first_held_.kind == BlockKind::arc && !inside(first_held_);
  CompensationFault fault;
  switch (corner_between(normal(), next, side_, beside_bulge)) {
    case Corner::straight:
      release();
      held_start_ = tool_at_;
      held_start_known_ = true;
      break;
    case Corner::outside:
      fault = trim(tool_at_);
      round_corner(block, feeds, from + across);
      break;
    case Corner::inside: {
      PlanePoint meeting = tool_at_;
      fault = meet_line(next, meeting);
      const CompensationFault trimmed = trim(meeting);
      if (!fault) fault = trimmed;
      break;
    }
  }
  hold(block, feeds, in_plane(block.end) + across, way, 0);
  return fault;
}

CompensationFault Compensation::follow_arc(const Block& block, const FeedRates& feeds) {
  const PlanePoint from = in_plane(programmed_);
  const PlanePoint end = in_plane(block.end);
  const PlanePoint center = center_of(block);
  const double outward = inside(block) ? -1 : 1;
  const double radius = length(center - end);
  CompensationFault fault;
  if (inside(block) && radius <= tool_.radius_mm) {
    release();
    hold(block, feeds, end, {}, 0);
    return {Kind::arc_small, radius, tool_.radius_mm, {}};
  }
  const PlaneVector next = start_direction(block, from);
  switch (corner_between(normal(), next, side_, !inside(block))) {
    case Corner::straight:
      release();
      held_start_ = tool_at_;
      held_start_known_ = true;
      break;
    case Corner::outside:
      release();
      round_corner(block, feeds, from + (outward * tool_.radius_mm) * unit(from - center));
      break;
    case Corner::inside: {
      PlanePoint meeting = tool_at_;
      fault = meet_arc(block, meeting);
      const CompensationFault trimmed = trim(meeting);
      if (!fault) fault = trimmed;
      break;
    }
  }
  hold(block, feeds, end + (outward * tool_.radius_mm) * unit(end - center), {}, sweep_rad(block, from, end));
  return fault;
}

CompensationFault Compensation::meet_line(PlaneVector next, PlanePoint& meeting) {
  if (first_held_.kind != BlockKind::arc) {
    meeting = meet(tool_at_, normal(), next, side_, tool_.radius_mm);
    return {};
  }
  const OffsetCircle circle = circle_of(first_held_);
  const PlaneVector across = turned(next, side_);
  // so far from the contour as radius and tool say: an entry arc may have got its centre on the other side
  const double radius_mm = circle.radius_mm + (circle.inside ? tool_.radius_mm : -tool_.radius_mm);
  const double height =
      radius_mm * dot(unit(circle.center - in_plane(programmed_)), across) - tool_.radius_mm;
  const auto crossing = cross(next, side_ * height, circle, !circle.inside);
  if (!crossing) {
    return {Kind::no_meeting, std::fabs(height) - circle.radius_mm, 0, first_held_.span};
  }
  meeting = *crossing;
  return {};
}

CompensationFault Compensation::meet_arc(const Block& arc, PlanePoint& meeting) {
  const PlanePoint from = in_plane(programmed_);
  OffsetCircle circle;
  circle.center = center_of(arc);
  circle.inside = inside(arc);
  circle.counterclockwise = arc.turns > 0;
  const double radius = length(circle.center - in_plane(arc.end));
  circle.radius_mm = radius + (circle.inside ? -tool_.radius_mm : tool_.radius_mm);
  if (first_held_.kind == BlockKind::arc) {
    const OffsetCircle before = circle_of(first_held_);
    if (same(before.center, circle.center) || before.radius_mm == 0) {
      return {Kind::same_center, 0, 0, first_held_.span};
    }
    const auto crossing = cross(before, circle);
    if (!crossing) {
      const double apart = length(circle.center - before.center);
      const double gap = std::fmax(apart - before.radius_mm - circle.radius_mm,
                                   std::fabs(before.radius_mm - circle.radius_mm) - apart);
      return {Kind::no_meeting, gap, 0, first_held_.span};
    }
    meeting = *crossing;
    return {};
  }
  // the radius of a spiral is the one at its end
  const double height = radius * dot(unit(circle.center - from), normal()) - tool_.radius_mm;
  const auto crossing = cross(turned(normal(), -side_), side_ * height, circle, circle.inside);
  if (!crossing) {
    return {Kind::no_meeting, std::fabs(height) - circle.radius_mm, 0, first_held_.span};
  }
  meeting = *crossing;
  return {};
}

OffsetCircle Compensation::circle_of(const Block& offset_arc) const {
  const PlanePoint center = center_of(offset_arc);
  return {center, length(center - in_plane(offset_arc.end)), inside(offset_arc), offset_arc.turns > 0};
}

void Compensation::round_corner(const Block& block, const FeedRates& feeds, PlanePoint corner_end) {
  Held corner{block, feeds, {}, 0};
  Block& move = corner.block;
  const auto normal_axis = static_cast<std::size_t>(axes_.normal);
  move.end[normal_axis] = programmed_[normal_axis];
  set_in_plane(move.end, corner_end);
  if (block.kind != BlockKind::traverse) {
    const PlanePoint center = in_plane(programmed_);
    move.kind = BlockKind::arc;
    move.center_first_mm = center.first_mm;
    move.center_second_mm = center.second_mm;
    move.turns = tool_.left ? -1 : 1;
  }
  hand_out(corner);
  held_start_ = corner_end;
  held_start_known_ = true;
}

void Compensation::hold(const Block& block, const FeedRates& feeds, PlanePoint tool, PlaneVector direction,
                        double sweep) {
  Held held{block, feeds, direction, sweep};
  set_in_plane(held.block.end, tool);
  if (held_.empty()) first_held_ = held.block;
  held_.push_back(std::move(held));
  tool_at_ = tool;
}

CompensationFault Compensation::trim(PlanePoint end) {
  if (held_.empty()) return {};
  CompensationFault fault;
  for (const Held& held : held_) {
    if (is_move(held.block)) fault = check_trimmed(held, end);
    if (fault) break;
  }
  if (!fault) {
    for (Held& held : held_) {
      if (is_move(held.block)) set_in_plane(held.block.end, end);
    }
  }
  release();
  held_start_ = fault ? tool_at_ : end;
  held_start_known_ = true;
  return fault;
}

CompensationFault Compensation::check_trimmed(const Held& held, PlanePoint end) const {
  if (!held_start_known_) return {};
  if (held.block.kind != BlockKind::arc) {
    const double along = dot(unit(held.direction), end - held_start_);
    if (along < 0) return {Kind::line_reversed, -along, 0, held.block.span};
    return {};
  }
  const double sweep = sweep_rad(held.block, held_start_, end);
  if (held.sweep_rad == 0 || sweep <= held.sweep_rad + sweep_tolerance_rad_) return {};
  return {Kind::arc_reversed, sweep * kDegreesPerRadian, held.sweep_rad * kDegreesPerRadian, held.block.span};
}

void Compensation::release() {
  held_start_known_ = false;
  if (held_.empty()) return;
  first_held_ = held_.front().block;
  for (const Held& held : held_) hand_out(held);
  held_.clear();
}

void Compensation::hand_out(const Held& held) {
  Block block = held.block;
  if (is_move(block)) {
    for (std::size_t a = 0; a < block.end.size(); ++a) block.end[a] += tool_.origin[a];
    if (block.kind == BlockKind::arc) {
      block.center_first_mm += tool_.origin[static_cast<std::size_t>(axes_.first)];
      block.center_second_mm += tool_.origin[static_cast<std::size_t>(axes_.second)];
    }
    measure(block, held.feeds);
  }
  receiver_(block);
}

void Compensation::measure(Block& block, const FeedRates& feeds) {
  const FeedLength programmed = block.feed_length;
  if (block.kind == BlockKind::arc) {
    const PlaneAxes axes = plane_axes(block.plane);
    const auto at = [&](const AxisValues& values) {
      return PlanePoint{values[static_cast<std::size_t>(axes.first)],
                        values[static_cast<std::size_t>(axes.second)]};
    };
    const PlanePoint start = at(handed_out_);
    PlanePoint end = at(block.end);
    const auto normal_axis = static_cast<std::size_t>(axes.normal);
    const double radius = (length(start - center_of(block)) + length(end - center_of(block))) / 2;
    if (length(end - start) < kSamePoint_u) end = start;
    measure_arc(sweep_rad(block, start, end), radius, block.end[normal_axis] - handed_out_[normal_axis],
                block);
  } else if (block.kind != BlockKind::spline) {
    measure_straight(handed_out_, block);
  }
  handed_out_ = block.end;
  if (block.kind == BlockKind::traverse) return;
  if (block.duration_s > 0) {
    // inverse time: F made a feed of the programmed length, and at that feed the tool moves
    if (block.feed_u_s > 0 && block.feed_length == programmed) {
      block.duration_s = block.length_u / block.feed_u_s;
    } else {
      block.feed_u_s = block.length_u / block.duration_s;
    }
  } else if (block.feed_length != programmed) {
    block.feed_u_s = block.feed_length == FeedLength::rotary ? feeds.rotary_deg_s : feeds.linear_mm_s;
  }
}

}  // namespace kadr::gcode
