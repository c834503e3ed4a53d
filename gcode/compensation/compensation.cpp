#include "gcode/compensation/compensation.h"

#include <cmath>
#include <utility>

namespace kadr::gcode {
namespace {

using Kind = CompensationFault::Kind;

// an entry arc whose chord is that close to a right angle with its radius would be a straight line
constexpr double kLeastEntryCosine = 1e-4;

/// Reported at once, although a move waits.
bool overtakes(const Block& block) { return is<Message, Comment, SelectTool, SetToolNumber>(block); }

bool stops(const Block& block) { return is<ProgramStop, OptionalStop, ProgramEnd>(block); }

/// Direction of an arc where it starts.
PlaneVector start_direction(const Arc& arc, PlanePoint start) {
  return turned(unit(start - center_of(arc)), arc.turns > 0 ? 1 : -1);
}

}  // namespace

void Compensation::begin(const CompensationTool& tool, const AxisValues& at) {
  tool_ = tool;
  side_ = tool.left ? 1 : -1;
  axes_ = plane_axes(tool.plane);
  // G41 right after G40: the tool is still off the old contour
  if (phase_ != Phase::exit) handed_out_ = at;
  programmed_ = at;
  tool_at_ = in_plane(at);
  held_start_known_ = false;
  phase_ = Phase::entry;
}

CompensationFault Compensation::take(const Block& block, const FeedRates& feeds) {
  if (const Move* programmed = move_of(block)) {
    const CompensationFault fault = move(block, in_plane(programmed->end), feeds);
    programmed_ = programmed->end;
    return fault;
  }
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

CompensationFault Compensation::move(const Block& block, PlanePoint end, const FeedRates& feeds) {
  const Arc* arc = std::get_if<Arc>(&block.action);
  CompensationFault fault;
  switch (phase_) {
    case Phase::off:
      break;
    case Phase::entry:
      fault = arc ? enter_arc(block, *arc, feeds) : enter_line(block, end, feeds);
      phase_ = Phase::contour;
      break;
    case Phase::contour:
      fault = arc ? follow_arc(block, *arc, feeds) : follow_line(block, end, feeds);
      break;
    case Phase::lost:
    case Phase::exit: {
      Block copy = block;
      measure(copy, *move_of(copy), feeds);
      receiver_(copy);
      if (phase_ == Phase::exit) phase_ = Phase::off;
      break;
    }
  }
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

CompensationFault Compensation::enter_line(const Block& block, PlanePoint end, const FeedRates& feeds) {
  const PlaneVector way = end - tool_at_;
  CompensationFault fault;
  if (length(way) <= tool_.radius_mm) fault = {Kind::entry_short, length(way), tool_.radius_mm, {}};
  const PlaneVector across = turned(unit(way), side_);
  held_start_ = tool_at_;
  held_start_known_ = true;
  // longer than the radius, it can't be trimmed to run backwards: across is what trimming never reverses
  hold(block, feeds, end + tool_.radius_mm * across, across, 0);
  return fault;
}

CompensationFault Compensation::enter_arc(const Block& block, const Arc& arc, const FeedRates& feeds) {
  const PlanePoint end = in_plane(arc.end);
  const PlanePoint center = center_of(arc);
  const double chord = length(end - tool_at_);
  const double radius = length(tool_at_ - center);
  if (chord <= tool_.radius_mm) {
    hold(block, feeds, end, {}, 0);
    return {Kind::entry_short, chord, tool_.radius_mm, {}};
  }
  CompensationFault fault;
  if (inside(arc) && radius <= tool_.radius_mm) fault = {Kind::arc_small, radius, tool_.radius_mm, {}};

  // the arc from here to the offset end point, with the programmed direction there
  const PlanePoint tool_end = end + tool_.radius_mm * unit(inside(arc) ? center - end : end - center);
  const PlaneVector to_center = unit(center - tool_end);
  const PlaneVector back = tool_at_ - tool_end;
  const double cosine = dot(unit(back), to_center);
  if (std::fabs(cosine) < kLeastEntryCosine && !fault) fault = {Kind::entry_arc, 0, 0, {}};
  if (fault) {
    hold(block, feeds, tool_end, {}, 0);
    return fault;
  }
  Arc entry = arc;
  const PlanePoint moved = tool_end + (length(back) / 2 / cosine) * to_center;
  entry.center_first_mm = moved.first_mm;
  entry.center_second_mm = moved.second_mm;
  if (tool_.origin != AxisValues{}) lead_to_entry_arc(block, arc, feeds);
  hold({block.span, entry}, feeds, tool_end, {}, sweep_rad(entry, tool_at_, tool_end));
  return fault;
}

/// Moves the controlled point off the nose's centre first: otherwise the entry arc would be none.
void Compensation::lead_to_entry_arc(const Block& block, const Arc& arc, const FeedRates& feeds) {
  Feed line{arc};
  line.end[static_cast<std::size_t>(axes_.normal)] = programmed_[static_cast<std::size_t>(axes_.normal)];
  set_in_plane(line.end, tool_at_);
  hand_out({{block.span, line}, feeds, {}, 0});
  held_start_ = tool_at_;
  held_start_known_ = true;
}

CompensationFault Compensation::follow_line(const Block& block, PlanePoint end, const FeedRates& feeds) {
  const PlanePoint from = in_plane(programmed_);
  const PlaneVector way = end - from;
  if (same(end, from)) {
    hold(block, feeds, tool_at_, {}, 0);
    return {};
  }
  const PlaneVector next = unit(way);
  const PlaneVector across = tool_.radius_mm * turned(next, side_);
  const Arc* before = held_.empty() ? nullptr : first_held_arc();
  const bool beside_bulge = before != nullptr && !inside(*before);
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
  hold(block, feeds, end + across, way, 0);
  return fault;
}

CompensationFault Compensation::follow_arc(const Block& block, const Arc& arc, const FeedRates& feeds) {
  const PlanePoint from = in_plane(programmed_);
  const PlanePoint end = in_plane(arc.end);
  const PlanePoint center = center_of(arc);
  const double outward = inside(arc) ? -1 : 1;
  const double radius = length(center - end);
  CompensationFault fault;
  if (inside(arc) && radius <= tool_.radius_mm) {
    release();
    hold(block, feeds, end, {}, 0);
    return {Kind::arc_small, radius, tool_.radius_mm, {}};
  }
  const PlaneVector next = start_direction(arc, from);
  switch (corner_between(normal(), next, side_, !inside(arc))) {
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
      fault = meet_arc(arc, meeting);
      const CompensationFault trimmed = trim(meeting);
      if (!fault) fault = trimmed;
      break;
    }
  }
  hold(block, feeds, end + (outward * tool_.radius_mm) * unit(end - center), {}, sweep_rad(arc, from, end));
  return fault;
}

CompensationFault Compensation::meet_line(PlaneVector next, PlanePoint& meeting) {
  const Arc* before = first_held_arc();
  if (before == nullptr) {
    meeting = meet(tool_at_, normal(), next, side_, tool_.radius_mm);
    return {};
  }
  const OffsetCircle circle = circle_of(*before);
  const PlaneVector across = turned(next, side_);
  // distance from the contour by radius and tool: an entry arc may have its centre on the other side
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

CompensationFault Compensation::meet_arc(const Arc& arc, PlanePoint& meeting) {
  const PlanePoint from = in_plane(programmed_);
  OffsetCircle circle;
  circle.center = center_of(arc);
  circle.inside = inside(arc);
  circle.counterclockwise = arc.turns > 0;
  const double radius = length(circle.center - in_plane(arc.end));
  circle.radius_mm = radius + (circle.inside ? -tool_.radius_mm : tool_.radius_mm);
  if (const Arc* arc_before = first_held_arc()) {
    const OffsetCircle before = circle_of(*arc_before);
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

OffsetCircle Compensation::circle_of(const Arc& offset_arc) const {
  const PlanePoint center = center_of(offset_arc);
  return {center, length(center - in_plane(offset_arc.end)), inside(offset_arc), offset_arc.turns > 0};
}

}  // namespace kadr::gcode
