#include <fmt/format.h>

#include <cmath>

#include "gcode/interpret/interpreter.h"
#include "machine/base/require.h"

namespace kadr::gcode {
namespace {

/// G73 lifts the drill by this to break the chip; G83 comes back to this far above the hole's bottom.
constexpr double kPeckClearance_in = 0.010;
constexpr double kLargestRepeats = 1e6;
constexpr double kMostPecks = 1e6;
/// A level read back through offsets carries their rounding; a program has fewer decimals than this. Levels
/// decide the number of pecks, so undo that rounding.
constexpr double kLevelDecimals = 1e10;
constexpr double kSameLevel = 1e-9;

constexpr int kTapLeft = code::g74, kTapRight = code::g84, kDrill = code::g81, kDrillDwell = code::g82,
              kBore = code::g85, kBoreStop = code::g86, kBoreDwell = code::g89, kChipBreak = code::g73,
              kPeck = code::g83;

bool dwells(int code) {
  return code == kDrillDwell || code == kBoreStop || code == kBoreDwell || code == kTapLeft ||
         code == kTapRight;
}
bool pecks(int code) { return code == kPeck || code == kChipBreak; }
bool taps(int code) { return code == kTapLeft || code == kTapRight; }

}  // namespace

/// One hole in program units: where it is, and levels along the plane's normal.
struct Interpreter::Hole {
  PlaneAxes axes{};
  double first = 0, second = 0;
  double here = 0;     ///< level of the tool as the line begins
  double retract = 0;  ///< R
  double clear = 0;    ///< level of the move to the next hole: R, or the initial level under G98
  double bottom = 0;
};

void Interpreter::check_cycle(int code) {
  const bool named = words_.g(GGroup::motion) != kNoCode;
  const bool goes_on =
      state_.motion == Motion::cycle && state_.cycle.code == code && !(named && state_.uncertain.cycle);
  for (const char letter : std::string_view("ABCUVW")) {
    if ((words_.present & axes_on_machine_ & letter_bit(letter)) == 0) continue;
    error(problem(Code::cycle_axis_refused, words_.span(*line_, letter),
                  fmt::format("{} does not move {}", g_name(code), letter),
                  fmt::format("move {} on a line before the cycle", letter)));
  }
  if (named && !words_.has_axis()) {
    error(problem(Code::word_missing, g_span(GGroup::motion),
                  fmt::format("{} needs at least one axis word", g_name(code))));
  }
  if (!goes_on) {
    const char along = kAxisLetters[static_cast<std::size_t>(plane_axes(plane_of_line()).normal)];
    std::vector<NeededWord> needed = {{along, "the bottom of the hole"}, {'R', "the retract level"}};
    if (dwells(code) && !taps(code)) needed.push_back({'P', "the seconds to wait at the bottom"});
    if (pecks(code)) needed.push_back({'Q', "the depth of a peck"});
    require_words(needed, g_span(GGroup::motion), g_name(code));
  }
  check_whole('L', rules_.repeats_in_k ? 0 : 1, kLargestRepeats);
  if (words_.has('P') && dwells(code) && words_.value('P') < 0) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'P'),
                  fmt::format("dwell of {} s, allowed 0 and above", figure(words_.value('P')))));
  }
  if (words_.has('Q') && pecks(code) && !(words_.value('Q') > 0)) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'Q'),
                  fmt::format("a peck of {}, allowed above 0", figure(words_.value('Q'))),
                  "Q is the depth of one peck, without a sign"));
  }
}

bool Interpreter::cycle_allowed() {
  const int code = state_.cycle.code;
  if (state_.feed_mode == FeedMode::inverse_time) {
    return error(problem(Code::cycle_under_inverse_time, action_span(),
                         fmt::format("{} under G93", g_name(code)), "write G94 and F before the cycle"));
  }
  if (!feed_ready()) return false;
  const bool stopped = state_.turning == Turning::stopped;
  const bool wrong = (code == kTapRight && state_.turning == Turning::counterclockwise) ||
                     (code == kTapLeft && state_.turning == Turning::clockwise);
  if (((taps(code) || code == kBoreStop) && stopped) || wrong) {
    return error(problem(Code::cycle_spindle, action_span(),
                         stopped
                             ? "the spindle is not turning here"
                             : fmt::format("the spindle turns {} here",
                                           code == kTapRight ? "counter-clockwise (M4)" : "clockwise (M3)"),
                         code == kTapRight  ? "write M3 and S before G84"
                         : code == kTapLeft ? "write M4 and S before G74"
                                            : "write M3 or M4 and S before G86"));
  }
  return true;
}

void Interpreter::cycle() {
  CycleWords& kept = state_.cycle;
  Hole hole;
  hole.axes = plane_axes(state_.plane);
  const char along = kAxisLetters[static_cast<std::size_t>(hole.axes.normal)];
  if (words_.has('R')) kept.retract = words_.value('R');
  if (words_.has(along)) kept.bottom = words_.value(along);
  if (words_.has('P') && dwells(kept.code)) kept.dwell_s = words_.value('P');
  if (words_.has('Q') && pecks(kept.code)) kept.peck = words_.value('Q');
  if (words_.g(GGroup::motion) != kNoCode) state_.uncertain.cycle = false;
  if (state_.uncertain.cycle) return;
  if (!cycle_allowed() || !cycle_levels(hole)) {
    state_.uncertain.cycle = true;
    return;
  }
  const PathMode mode = state_.path_mode;
  const double tolerance = state_.path_tolerance;  // restored in the units in force now, as LinuxCNC does
  const Span span = action_span();
  if (mode != PathMode::exact_path) set_path_mode(PathMode::exact_path, 0, span);
  cycle_holes(hole);
  if (mode != PathMode::exact_path) set_path_mode(mode, tolerance, span);
}

bool Interpreter::cycle_levels(Hole& hole) {
  CycleWords& kept = state_.cycle;
  hole.first = state_.program_position(hole.axes.first);
  hole.second = state_.program_position(hole.axes.second);
  hole.here = std::round(state_.program_position(hole.axes.normal) * kLevelDecimals) / kLevelDecimals;
  if (std::fabs(hole.here - kept.last_level) < kSameLevel) hole.here = kept.last_level;
  if (!kept.in_sequence) kept.initial_level = hole.here;
  kept.in_sequence = true;
  double initial = kept.initial_level;
  hole.retract = state_.incremental ? kept.retract + initial : kept.retract;
  hole.bottom = state_.incremental ? hole.retract + kept.bottom : kept.bottom;
  if (hole.retract < hole.bottom) {
    const char along = kAxisLetters[static_cast<std::size_t>(hole.axes.normal)];
    return error(problem(Code::cycle_retract_below_bottom, action_span(),
                         fmt::format("R is at {0}{1}, the bottom of the hole at {0}{2}", along,
                                     figure(hole.retract), figure(hole.bottom)),
                         state_.incremental
                             ? fmt::format("under G91 {} counts from R: downwards is negative", along)
                             : "R is the level above the hole to which the tool goes at the rapid rate"));
  }
  if (pecks(kept.code) && hole.retract - hole.bottom > kMostPecks * kept.peck) {
    return error(problem(Code::word_out_of_range, words_.has('Q') ? words_.span(*line_, 'Q') : action_span(),
                         fmt::format("pecks of {} for a depth of {}, allowed: {:.0f} pecks",
                                     figure(kept.peck, 9), figure(hole.retract - hole.bottom), kMostPecks)));
  }
  // a sequence that began below R: first straight up
  if (initial < hole.retract) {
    go_to_level(hole, Rate::rapid, hole.retract);
    initial = hole.here = hole.retract;
  }
  hole.clear = kept.last_level = state_.retract_to_start ? initial : hole.retract;
  return true;
}

void Interpreter::cycle_holes(Hole hole) {
  const auto word = [&](int axis, double otherwise) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    return words_.has(letter) ? words_.value(letter) : otherwise;
  };
  int repeats = 1;
  if (words_.has('L')) near_integer(words_.value('L'), repeats);
  for (int i = 0; i < repeats && !ended_; ++i) {
    // an incremental angle continues from the previous hole
    const bool polar = (words_.present & letter_bits("@^")) != 0;
    if (i > 0 && polar && state_.incremental && !resolve_polar()) return;
    if (state_.incremental) {
      hole.first += word(hole.axes.first, 0);
      hole.second += word(hole.axes.second, 0);
    } else {
      hole.first = word(hole.axes.first, hole.first);
      hole.second = word(hole.axes.second, hole.second);
    }
    // the first move to a hole is at the tool's height, the others at the retract level
    const double way = i == 0 && hole.here > hole.retract ? hole.here : hole.clear;
    go_to_level(hole, Rate::rapid, way);
    if (way > hole.retract) go_to_level(hole, Rate::rapid, hole.retract);
    make_hole(hole);
  }
}

void Interpreter::make_hole(const Hole& hole) {
  switch (state_.cycle.code) {
    case kChipBreak:
    case kPeck:
      return peck(hole);
    case kTapLeft:
    case kTapRight:
      return tap(hole);
    case kBoreStop:
      return bore_and_stop(hole);
    case kDrill:
      go_to_level(hole, Rate::feed, hole.bottom);
      break;
    case kDrillDwell:
      go_to_level(hole, Rate::feed, hole.bottom);
      dwell_at_bottom();
      break;
    case kBore:
      go_to_level(hole, Rate::feed, hole.bottom);
      go_to_level(hole, Rate::feed, hole.retract);
      break;
    case kBoreDwell:
      go_to_level(hole, Rate::feed, hole.bottom);
      dwell_at_bottom();
      return go_to_level(hole, Rate::feed, hole.clear);
    default:
      require(false, "every code of the group of cycles has its hole");
  }
  go_to_level(hole, Rate::rapid, hole.clear);
}

void Interpreter::peck(const Hole& hole) {
  const double clearance = state_.inches ? kPeckClearance_in : kPeckClearance_in * kMillimetresPerInch;
  const double depth = state_.cycle.peck;
  for (double level = hole.retract - depth; level > hole.bottom && !ended_; level -= depth) {
    go_to_level(hole, Rate::feed, level);
    if (state_.cycle.code == kPeck) go_to_level(hole, Rate::rapid, hole.retract);
    go_to_level(hole, Rate::rapid, level + clearance);
  }
  go_to_level(hole, Rate::feed, hole.bottom);
  go_to_level(hole, Rate::rapid, hole.clear);
}

void Interpreter::tap(const Hole& hole) {
  const Span span = action_span();
  const Turning in = state_.turning;
  const Turning out = in == Turning::clockwise ? Turning::counterclockwise : Turning::clockwise;
  const bool feed_override = state_.feed_override;
  const bool speed_override = state_.speed_override;
  enable_feed_override(false);
  enable_speed_override(false);
  const auto turn = [&](Turning turning) {
    turn_spindle(Turning::stopped, span);
    turn_spindle(turning, span);
  };
  const double peck = state_.cycle.tap_peck;
  for (double level = hole.retract - peck; peck > 0 && level > hole.bottom && !ended_; level -= peck) {
    tap_to_level(hole, level);
    turn(out);
    tap_to_level(hole, hole.retract);
    turn(in);
  }
  tap_to_level(hole, hole.bottom);
  turn_spindle(Turning::stopped, span);
  turn_spindle(out, span);
  dwell_at_bottom();
  tap_to_level(hole, hole.clear);
  turn(in);
  // after swapped axes the program continues as if the tool were over the hole
  state_.position = near_position(state_.to_machine(place_at(hole, hole.clear)));
  tapped_at_ = state_.position;
  if (feed_override) enable_feed_override(true);
  if (speed_override) enable_speed_override(true);
}

/// LinuxCNC 2.9 swaps the axes of the feed moves of G74 and G84 outside G17. Its machine makes this move;
/// so does the emulated one, with a warning.
void Interpreter::tap_to_level(const Hole& hole, double level) {
  if (state_.plane == Plane::xy) return go_to_level(hole, Rate::feed, level);
  Hole exchanged = hole;
  const bool zx = state_.plane == Plane::zx;
  exchanged.first = zx ? hole.second : level;
  exchanged.second = zx ? level : hole.first;
  go_to_level(exchanged, Rate::feed, zx ? hole.first : hole.second);
  report_.warning(problem(Code::tap_outside_g17, action_span(),
                          fmt::format("the tap is fed to X{} Y{} Z{}", figure(state_.program_position(0)),
                                      figure(state_.program_position(1)), figure(state_.program_position(2))),
                          "tap in G17, or write the moves of the cycle yourself"));
}

void Interpreter::bore_and_stop(const Hole& hole) {
  const Turning turning = state_.turning;
  go_to_level(hole, Rate::feed, hole.bottom);
  dwell_at_bottom();
  turn_spindle(Turning::stopped, action_span());
  go_to_level(hole, Rate::rapid, hole.clear);
  turn_spindle(turning, action_span());
}

AxisValues Interpreter::place_at(const Hole& hole, double level) const {
  AxisValues program = state_.to_program(state_.position);
  const auto put = [&](int axis, double value) {
    program[static_cast<std::size_t>(axis)] = state_.to_base_units(axis, value);
  };
  put(hole.axes.first, hole.first);
  put(hole.axes.second, hole.second);
  put(hole.axes.normal, level);
  return program;
}

void Interpreter::go_to_level(const Hole& hole, Rate rate, double level) { go(rate, place_at(hole, level)); }

void Interpreter::dwell_at_bottom() { emit(action_span(), Dwell{state_.cycle.dwell_s}); }

void Interpreter::retract_mode() {
  const int code = words_.g(GGroup::retract);
  if (code != kNoCode) state_.retract_to_start = code == code::g98;
}

}  // namespace kadr::gcode
