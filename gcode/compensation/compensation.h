#pragma once
#include <functional>
#include <vector>

#include "gcode/block.h"
#include "gcode/compensation/offset_corner.h"

namespace kadr::gcode {

PlanePoint center_of(const Arc& arc);
/// Angle travelled, > 0.
double sweep_rad(const Arc& arc, PlanePoint start, PlanePoint end);

/// State fixed by G41 or G42 until G40.
struct CompensationTool {
  bool left = true;      ///< of the contour, seen in the direction of motion
  double radius_mm = 0;  ///< > 0
  Plane plane = Plane::xy;
  AxisValues origin{};  ///< lathe tools: the controlled point seen from the centre of the nose
};

/// The feeds in force at a move, for a move whose compensated path measures other axes than the programmed.
struct FeedRates {
  double linear_mm_s = 0;
  double rotary_deg_s = 0;
};

/// Why the tool can't follow the contour.
struct CompensationFault {
  enum class Kind : std::uint8_t {
    none,
    entry_short,    ///< measured: length of the entry move in the plane, allowed: above the tool's radius
    entry_arc,      ///< no arc leads from here to the compensated end
    arc_small,      ///< measured: radius of an arc with the tool inside, allowed: above the tool's radius
    line_reversed,  ///< measured: how far the trimmed line `earlier` would have to run backwards
    arc_reversed,   ///< measured: degrees that the trimmed arc `earlier` would sweep, allowed: as programmed
    no_meeting,     ///< measured: gap between the offsets of `earlier` and of this move
    same_center,    ///< two arcs about one centre
  };
  Kind kind = Kind::none;
  double measured = 0;
  double allowed = 0;
  Span earlier{};  ///< the move before the corner

  explicit operator bool() const { return kind != Kind::none; }
};

/// Turns a contour into the path of the tool's centre, one radius off it.
///
/// Sits between the interpreter and the receiver of Blocks from G41 to the first move after G40. Takes the
/// programmed moves in coordinates in which the contour's plane is one of two axes; hands out moves of the
/// tool's centre: lines and arcs shifted by the radius, an arc about each outside corner, moves trimmed to
/// where they meet at each inside corner. So a move waits for the next one that moves in the plane, and what
/// was called in between waits after it.
///
///     outside:            ___           inside:      | contour
///                   tool /   \                  ____ |
///       -----------------   _ \                 tool||
///       ------------------.  | |                    ||
///               contour   |  | |                 ---'|
///                                                ----' contour
///
/// After a fault the moves before the corner are handed out untrimmed and the contour continues, so that later
/// corners are checked too.
class Compensation {
 public:
  using Receiver = std::function<void(Block&)>;
  explicit Compensation(Receiver receiver) : receiver_(std::move(receiver)) {}

  /// G41 G42. @param at  position of the machine
  void begin(const CompensationTool& tool, const AxisValues& at);
  /// Any block. Blocks that are not moves keep their place after the move that waits.
  CompensationFault take(const Block& block, const FeedRates& feeds);
  /// G40: the last move ends off its programmed end; the next one starts there.
  CompensationFault end();
  /// An arc may sweep that much more than programmed: where it joins a nearly straight corner untrimmed.
  void set_sweep_tolerance(double tolerance_rad) { sweep_tolerance_rad_ = tolerance_rad; }
  /// No move led away after G40: the next one begins at the tool.
  void leave() { phase_ = Phase::off; }
  /// The contour can't be known after an error in the program: moves go through as programmed until G40.
  void lose();

  /// Whether blocks must pass here. False from the first move after G40 on.
  bool active() const { return phase_ != Phase::off; }
  /// Blocks that were taken and not handed out yet.
  std::size_t waiting() const { return held_.size(); }
  /// Whether a move has been made off the contour.
  bool entered() const { return phase_ == Phase::contour || phase_ == Phase::lost; }
  /// Tool's centre as seen from the programmed point.
  AxisValues shift() const;
  /// End of the last programmed move.
  const AxisValues& programmed() const { return programmed_; }
  /// End of the last move handed out: what the next one is measured from.
  const AxisValues& last_end() const { return handed_out_; }
  /// The same point in the coordinates of the next moves.
  void set_last_end(const AxisValues& end) { handed_out_ = end; }

 private:
  enum class Phase : std::uint8_t { off, entry, contour, lost, exit };
  /// A block that waits. Moves know the part that trimming must not remove.
  struct Held {
    Block block;
    FeedRates feeds;
    PlaneVector direction;  ///< lines: of the programmed motion, zero if it doesn't move in the plane
    double sweep_rad = 0;   ///< arcs: as programmed; 0: not checked
  };

  CompensationFault move(const Block& block, PlanePoint end, const FeedRates& feeds);
  CompensationFault enter_line(const Block& block, PlanePoint end, const FeedRates& feeds);
  CompensationFault enter_arc(const Block& block, const Arc& arc, const FeedRates& feeds);
  CompensationFault follow_line(const Block& block, PlanePoint end, const FeedRates& feeds);
  CompensationFault follow_arc(const Block& block, const Arc& arc, const FeedRates& feeds);
  void lead_to_entry_arc(const Block& block, const Arc& arc, const FeedRates& feeds);
  CompensationFault meet_line(PlaneVector next, PlanePoint& meeting);
  CompensationFault meet_arc(const Arc& arc, PlanePoint& meeting);
  void round_corner(const Block& block, const FeedRates& feeds, PlanePoint corner_end);
  void hold(const Block& block, const FeedRates& feeds, PlanePoint tool, PlaneVector direction,
            double sweep_rad);
  CompensationFault trim(PlanePoint end);
  CompensationFault check_trimmed(const Held& held, PlanePoint end) const;
  void release();
  void hand_out(const Held& held);
  void measure(Block& block, Move& move, const FeedRates& feeds);

  PlanePoint in_plane(const AxisValues& values) const {
    return {values[static_cast<std::size_t>(axes_.first)], values[static_cast<std::size_t>(axes_.second)]};
  }
  void set_in_plane(AxisValues& values, PlanePoint point) const {
    values[static_cast<std::size_t>(axes_.first)] = point.first_mm;
    values[static_cast<std::size_t>(axes_.second)] = point.second_mm;
  }
  bool inside(const Arc& arc) const { return (arc.turns > 0) == tool_.left; }
  OffsetCircle circle_of(const Arc& offset_arc) const;
  const Arc* first_held_arc() const { return std::get_if<Arc>(&first_held_.action); }
  PlaneVector normal() const { return unit(tool_at_ - in_plane(programmed_)); }

  Receiver receiver_;
  CompensationTool tool_;
  double side_ = 1;  ///< +1 left, -1 right
  PlaneAxes axes_{0, 1, 2};
  double sweep_tolerance_rad_ = 0;

  Phase phase_ = Phase::off;
  AxisValues programmed_{};  ///< end of the last programmed move
  PlanePoint tool_at_;       ///< the tool's centre there if nothing is trimmed
  AxisValues handed_out_{};  ///< end of the last move handed out
  std::vector<Held> held_;
  Block first_held_;               ///< the last move that was the first to wait
  PlanePoint held_start_;          ///< where the held moves begin
  bool held_start_known_ = false;  ///< false: how far they were trimmed at their beginning isn't checked
};

}  // namespace kadr::gcode
