#include <cmath>
#include <utility>

#include "gcode/compensation/compensation.h"
#include "gcode/measure.h"
#include "machine/base/numbers.h"

/// What leaves the compensation: corners, trimmed moves, their lengths and feeds.
namespace kadr::gcode {
namespace {

using Kind = CompensationFault::Kind;

constexpr double kDegreesPerRadian = 180 / kPi;

}  // namespace

PlanePoint center_of(const Arc& arc) { return {arc.center_first_mm, arc.center_second_mm}; }

double sweep_rad(const Arc& arc, PlanePoint start, PlanePoint end) {
  return arc_sweep_rad(start, end, center_of(arc), arc.turns < 0, std::abs(arc.turns));
}

void Compensation::round_corner(const Block& block, const FeedRates& feeds, PlanePoint corner_end) {
  Move move = *move_of(block);
  const auto normal_axis = static_cast<std::size_t>(axes_.normal);
  move.end[normal_axis] = programmed_[normal_axis];
  set_in_plane(move.end, corner_end);
  if (is<Traverse>(block)) {
    hand_out({{block.span, Traverse{move}}, feeds, {}, 0});
  } else {
    const PlanePoint center = in_plane(programmed_);
    Arc arc{move};
    arc.plane = tool_.plane;
    arc.center_first_mm = center.first_mm;
    arc.center_second_mm = center.second_mm;
    arc.turns = tool_.left ? -1 : 1;
    hand_out({{block.span, arc}, feeds, {}, 0});
  }
  held_start_ = corner_end;
  held_start_known_ = true;
}

void Compensation::hold(const Block& block, const FeedRates& feeds, PlanePoint tool, PlaneVector direction,
                        double sweep) {
  Held held{block, feeds, direction, sweep};
  set_in_plane(move_of(held.block)->end, tool);
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
    for (Held& held : held_)
      if (Move* move = move_of(held.block)) set_in_plane(move->end, end);
  }
  release();
  held_start_ = fault ? tool_at_ : end;
  held_start_known_ = true;
  return fault;
}

CompensationFault Compensation::check_trimmed(const Held& held, PlanePoint end) const {
  if (!held_start_known_) return {};
  const Arc* arc = std::get_if<Arc>(&held.block.action);
  if (arc == nullptr) {
    const double along = dot(unit(held.direction), end - held_start_);
    if (along < 0) return {Kind::line_reversed, -along, 0, held.block.span};
    return {};
  }
  const double sweep = sweep_rad(*arc, held_start_, end);
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
  if (Move* move = move_of(block)) {
    for (std::size_t a = 0; a < move->end.size(); ++a) move->end[a] += tool_.origin[a];
    if (Arc* arc = std::get_if<Arc>(&block.action)) {
      arc->center_first_mm += tool_.origin[static_cast<std::size_t>(axes_.first)];
      arc->center_second_mm += tool_.origin[static_cast<std::size_t>(axes_.second)];
    }
    measure(block, *move, held.feeds);
  }
  receiver_(block);
}

/// Sets length, feed and duration of a compensated move.
/// @param move  of `block`
void Compensation::measure(Block& block, Move& move, const FeedRates& feeds) {
  const FeedLength programmed = move.feed_length;
  if (Arc* arc = std::get_if<Arc>(&block.action)) {
    const PlaneAxes axes = plane_axes(arc->plane);
    const auto at = [&](const AxisValues& values) {
      return PlanePoint{values[static_cast<std::size_t>(axes.first)],
                        values[static_cast<std::size_t>(axes.second)]};
    };
    const PlanePoint start = at(handed_out_);
    PlanePoint end = at(arc->end);
    const auto normal_axis = static_cast<std::size_t>(axes.normal);
    const double radius = (length(start - center_of(*arc)) + length(end - center_of(*arc))) / 2;
    if (length(end - start) < kSamePoint_u) end = start;
    measure_arc(sweep_rad(*arc, start, end), radius, arc->end[normal_axis] - handed_out_[normal_axis], *arc);
  } else if (!is<Spline>(block)) {
    measure_straight(handed_out_, move);
  }
  handed_out_ = move.end;
  if (is<Traverse>(block)) return;
  if (move.duration_s > 0) {
    // inverse time: F made a feed of the programmed length, and at that feed the tool moves
    if (move.feed_u_s > 0 && move.feed_length == programmed) {
      move.duration_s = move.length_u / move.feed_u_s;
    } else {
      move.feed_u_s = move.length_u / move.duration_s;
    }
  } else if (move.feed_length != programmed) {
    move.feed_u_s = move.feed_length == FeedLength::rotary ? feeds.rotary_deg_s : feeds.linear_mm_s;
  }
}

}  // namespace kadr::gcode
