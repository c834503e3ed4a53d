#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

constexpr double kLargestCount = 1e6;
constexpr double kMostPasses = 10'000;
constexpr double kRightAngle_deg = 90;
/// LinuxCNC marks a missing Q with this value, so it treats Q-1 as none.
constexpr double kNoAngle_deg = -1;
constexpr std::size_t kFirstOther = 3;
constexpr int kEntryTaper = 1, kExitTaper = 2;

}  // namespace

/// G76 in program units. The drive line is the line of the start point along Z; depths count from it towards
/// the work:
///
///        |I|        the crest of the thread
///        |I| + J    the first pass;   pass n:  |I| + J · n^(1/R)
///        |I| + K    the last pass and the spring passes
///
struct Interpreter::ThreadShape {
  AxisValues start{};  ///< program coordinates, mm and deg
  AxisValues end{};
  double start_x = 0, start_z = 0, end_z = 0;
  bool inside = false;   ///< I above 0: the tool cuts away from the axis
  double crest = 0;      ///< |I|
  double first_cut = 0;  ///< J
  double height = 0;     ///< K
  double pitch_u_rev = 0;
  double degression = 1;
  double slope = 0;  ///< travel along Z per depth: tan Q, against the direction of the thread
  int spring_passes = 0;
  double taper = 0;              ///< E, signed from end to start; 0: none
  double taper_pitch_u_rev = 0;  ///< along the taper, so that Z keeps the pitch
  bool entry_taper = false, exit_taper = false;

  double x_at(double depth) const { return inside ? start_x + depth : start_x - depth; }
  double full_depth() const { return crest + height; }
  /// Where a pass begins and ends along Z: deeper ones begin further along the compound slide.
  double shift(double depth) const { return (depth - crest) * slope; }
};

void Interpreter::check_thread_cycle() {
  const Span span = words_.g(GGroup::motion) == kNoCode ? action_span() : g_span(GGroup::motion);
  if (!words_.has_axis()) {
    error(problem(Code::word_missing, span, "G76 needs Z: the end of the thread"));
  }
  const bool complete = require_words({{'P', "the pitch"},
                                       {'I', "the crest, seen from the tool's start"},
                                       {'J', "the depth of the first pass"},
                                       {'K', "the full depth"}},
                                      span, "each line of G76");
  check_whole('$', 0, 0);
  check_whole('H', 0, kLargestCount);
  check_whole('L', 0, kLargestCount);
  if (words_.has('Q') && !(std::fabs(words_.value('Q')) < kRightAngle_deg)) {
    error(
        problem(Code::word_out_of_range, words_.span(*line_, 'Q'),
                fmt::format("a compound angle of {} degrees, allowed below 90", figure(words_.value('Q')))));
  }
  if (!complete) return;
  const double i = words_.value('I'), j = words_.value('J'), k = words_.value('K');
  const bool below = k <= j;
  if (i == 0) {
    error(problem(Code::thread_depth, words_.span(*line_, 'I'), "I is 0",
                  "I is negative for an external thread and positive for an internal one"));
  }
  if (j <= 0) {
    error(problem(Code::thread_depth, words_.span(*line_, 'J'),
                  fmt::format("a first pass of {}, allowed above 0", figure(j))));
  } else if (below) {
    error(problem(Code::thread_depth, words_.span(*line_, 'K'),
                  fmt::format("K {} must be larger than J {}", figure(k), figure(j))));
  }
}

void Interpreter::thread_cycle() {
  ThreadShape shape;
  const AxisValues end = target();
  if (!spindle_turns(code::g76) || !thread_shape(shape, end)) return move_to(end);
  warn_thread(shape);
  double depth = shape.crest + shape.first_cut;
  for (int pass = 2; depth < shape.full_depth() && !ended_; ++pass) {
    thread_pass(shape, depth);
    depth = shape.crest + shape.first_cut * exact_pow(pass, 1.0 / shape.degression);
  }
  for (int i = 0; i <= shape.spring_passes && !ended_; ++i) thread_pass(shape, shape.full_depth());
  go_to(Rate::rapid, end);
}

bool Interpreter::thread_shape(ThreadShape& shape, const AxisValues& end) {
  for (std::size_t axis = kFirstOther; axis < kProgramAxes; ++axis) {
    if (end[axis] == state_.position[axis]) continue;
    return error(problem(Code::thread_axis_refused, words_.span(*line_, kAxisLetters[axis]),
                         fmt::format("{} would move from {} to {}", kAxisLetters[axis],
                                     figure(state_.position[axis]), figure(end[axis])),
                         "move it on a line before the cycle"));
  }
  const auto word = [&](char letter, double otherwise) {
    return words_.has(letter) ? words_.value(letter) : otherwise;
  };
  shape.start = state_.to_program(state_.position);
  shape.end = state_.to_program(end);
  const double unit = state_.length_factor();
  shape.start_x = shape.start[kX] / unit;
  shape.start_z = shape.start[kZ] / unit;
  shape.end_z = shape.end[kZ] / unit;
  double per_radius = state_.diameter_mode ? 0.5 : 1.0;
  // as LinuxCNC: G7 on the line of G76 halves the words of a line that began with radii once more
  if (diameters_begin_) per_radius /= 2;
  shape.inside = words_.value('I') > 0;
  shape.crest = std::fabs(words_.value('I')) * per_radius;
  shape.first_cut = words_.value('J') * per_radius;
  shape.height = words_.value('K') * per_radius;
  shape.pitch_u_rev = words_.value('P');
  shape.degression = std::max(1.0, word('R', 1));
  const double angle_deg = word('Q', 0) == kNoAngle_deg ? 0 : word('Q', 0);
  const SinCos angle = exact_sincos(angle_deg * kRadiansPerDegree);
  const bool upwards = shape.end_z > shape.start_z;
  shape.slope = (upwards ? -1 : 1) * angle.sin / angle.cos;
  if (words_.has('H')) near_integer(words_.value('H'), shape.spring_passes);
  int ends = 0;
  if (words_.has('L')) near_integer(words_.value('L'), ends);
  shape.entry_taper = (ends & kEntryTaper) != 0;
  shape.exit_taper = (ends & kExitTaper) != 0;
  const double taper = std::max(0.0, word('E', 0));
  shape.taper = upwards ? -taper : taper;
  if (taper > 0) {
    shape.taper_pitch_u_rev =
        shape.pitch_u_rev * std::sqrt(taper * taper + shape.height * shape.height) / taper;
  }
  const double passes = shape.degression * exact_log(shape.height / shape.first_cut);
  if (passes < exact_log(kMostPasses)) return true;
  return error(problem(Code::thread_passes, action_span(),
                       fmt::format("more than {:.0f} passes from {} down to {}", kMostPasses,
                                   figure(shape.first_cut), figure(shape.height)),
                       "raise J or lower R"));
}

void Interpreter::warn_thread(const ThreadShape& shape) {
  const auto warn = [&](char letter, std::string label) {
    report_.warning(problem(Code::thread_unusual, words_.span(*line_, letter), std::move(label)));
  };
  warn_pitch('P');
  if (words_.has('R') && words_.value('R') < 1) warn('R', "a degression below 1 is taken as 1");
  if (words_.has('Q') && words_.value('Q') == kNoAngle_deg) warn('Q', "Q-1 is taken as no angle at all");
  if (words_.has('E') && words_.value('E') < 0) warn('E', "a taper below 0 is taken as none");
  const double length = std::fabs(shape.end_z - shape.start_z);
  const bool tapers = shape.entry_taper || shape.exit_taper;
  if (tapers && std::fabs(shape.taper) > length / 2) {
    warn('E', fmt::format("the taper is longer than half of the thread's {}", figure(length)));
  }
  if (state_.plane == Plane::zx) return;
  report_.warning(problem(Code::thread_unusual, action_span(),
                          "G76 cuts in X and Z although another plane is in force", "write G18 before it"));
}

void Interpreter::thread_pass(const ThreadShape& shape, double depth) {
  const auto go_xz = [&](Rate rate, double x, double z) {
    AxisValues program = shape.start;
    program[kX] = x * state_.length_factor();
    program[kZ] = z * state_.length_factor();
    go(rate, program);
  };
  const double back = shape.x_at(depth - shape.full_depth());
  const double cut = shape.x_at(depth);
  const double outside = shape.x_at(depth - shape.height);
  const double begin = shape.start_z - shape.shift(depth);
  const double end = shape.end_z + shape.shift(shape.full_depth()) - shape.shift(depth);
  const bool feed_override = state_.feed_override;
  const bool tapered = shape.taper != 0;
  go_xz(Rate::rapid, back, begin);
  if (tapered && shape.entry_taper) {
    enable_feed_override(false);
    start_thread(shape.taper_pitch_u_rev);
    go_xz(Rate::feed, outside, begin);
    go_xz(Rate::feed, cut, begin - shape.taper);
  } else {
    go_xz(Rate::rapid, cut, begin);
    enable_feed_override(false);
  }
  start_thread(shape.pitch_u_rev);
  if (tapered && shape.exit_taper) {
    go_xz(Rate::feed, cut, end + shape.taper);
    start_thread(shape.taper_pitch_u_rev);
    go_xz(Rate::feed, outside, end);
  } else {
    go_xz(Rate::feed, cut, end);
  }
  stop_thread();
  go_xz(Rate::rapid, back, end);
  if (feed_override) enable_feed_override(true);
}

}  // namespace kadr::gcode
