#include <fmt/format.h>

#include <utility>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"
#include "machine/base/plane_spline.h"

namespace kadr::gcode {
namespace {

constexpr int kQuadratic = 3;  // orders: degree and one
constexpr int kCubic = 4;
constexpr std::uint32_t kPlaneBits = letter_bits("XY");
constexpr std::uint32_t kPlaneAxes = 3;  // X and Y in Uncertain::axes

double length_mm(const Spline& spline) {
  std::vector<SplineControl> points;
  for (const SplinePoint& p : spline.control_points) points.push_back({p.x_mm, p.y_mm, p.weight});
  return PlaneSpline(std::move(points), spline.order).length();
}

}  // namespace

void Interpreter::spline(Motion motion) {
  const bool ready = feed_ready();
  const AxisValues end = target();
  const bool known =
      (state_.uncertain.axes & kPlaneAxes) == 0 && (words_.doubtful & (kAxisBits | letter_bits("IJPQ"))) == 0;
  const bool allowed = spline_allowed(motion);
  if (!ready || !known || !allowed) return move_to(end);
  Spline spline{make_move(end)};
  spline.order = motion == Motion::cubic_spline ? kCubic : kQuadratic;
  const AxisValues from = state_.to_program(state_.position);
  const AxisValues to = state_.to_program(end);
  add_control(spline, from, 0, 0, 1);
  if (motion == Motion::quadratic_spline) {
    add_control(spline, from, spline_offset('I'), spline_offset('J'), 1);
  } else {
    const bool given = words_.has('I') || rules_of(options_.dialect).cubic_g5_from_zero;
    if (!given) warn_direction_kept();
    const double i_mm = given ? spline_offset('I') : spline_i_mm_;
    const double j_mm = given ? spline_offset('J') : spline_j_mm_;
    add_control(spline, from, i_mm, j_mm, 1);
    add_control(spline, to, spline_offset('P'), spline_offset('Q'), 1);
    // direction with which a G5 without I and J continues
    spline_i_mm_ = -spline_offset('P');
    spline_j_mm_ = -spline_offset('Q');
    spline_end_ = end;
  }
  add_control(spline, to, 0, 0, 1);
  emit_spline(std::move(spline), action_span());
}

/// A word's length in mm, 0 if it is not given.
double Interpreter::spline_offset(char letter) const {
  return words_.has(letter) ? words_.value(letter) * state_.length_factor() : 0.0;
}

/// Adds a point relative to a program position, which turns with the work system.
void Interpreter::add_control(Spline& spline, AxisValues program, double x_mm, double y_mm,
                              double weight) const {
  program[0] += x_mm;
  program[1] += y_mm;
  const AxisValues machine = state_.to_machine(program);
  spline.control_points.push_back({machine[0], machine[1], weight});
}

bool Interpreter::spline_allowed(Motion motion) {
  const std::string name = g_name(words_.g(GGroup::motion));
  if (!spline_place_allowed(name)) return false;
  if (rules_of(options_.dialect).cubic_g5_from_zero) return true;
  const auto missing = [&](char letter, std::string_view meaning) {
    return error(
        problem(Code::word_missing, action_span(), fmt::format("{} needs {}: {}", name, letter, meaning)));
  };
  if (!words_.has_axis())
    return error(problem(Code::word_missing, action_span(), fmt::format("{} needs X or Y: the end", name)));
  const bool quadratic = motion == Motion::quadratic_spline;
  const bool first = words_.has('I') || words_.has('J') || quadratic;
  if (first && !words_.has('I')) return missing('I', "X from the start to the first control point");
  if (first && !words_.has('J')) return missing('J', "Y from the start to the first control point");
  if (quadratic) return true;
  if (!words_.has('P')) return missing('P', "X from the end to the second control point");
  if (!words_.has('Q')) return missing('Q', "Y from the end to the second control point");
  return true;
}

/// Checks common to all splines: plane, axes, compensation.
bool Interpreter::spline_place_allowed(std::string_view name) {
  if (const std::uint32_t others = words_.present & kAxisBits & ~kPlaneBits; others != 0) {
    for (const char letter : kAxisLetters) {
      if ((others & letter_bit(letter)) == 0) continue;
      return error(problem(Code::spline_axis, words_.span(*line_, letter),
                           fmt::format("{} moves X and Y only, not {}", name, letter),
                           fmt::format("move {} on a line of its own", letter)));
    }
  }
  if (state_.plane != Plane::xy) {
    return error(problem(Code::spline_plane, action_span(),
                         fmt::format("{} in the plane {}", name, state_.plane == Plane::zx ? "XZ" : "YZ"),
                         "write G17 before it"));
  }
  return true;
}

void Interpreter::warn_direction_kept() {
  if (spline_end_ && *spline_end_ == state_.position) return;
  const double unit = state_.length_factor();
  const Span span = action_span();
  report_.warning(
      problem(Code::spline_direction_old, span,
              fmt::format("taken as I{} J{}", figure(spline_i_mm_ / unit), figure(spline_j_mm_ / unit)),
              "I and J may be left out right after another G5: give both here"));
}

void Interpreter::emit_spline(Spline spline, Span span) {
  spline.length_u = length_mm(spline);
  set_feed(spline);
  move_to(spline.end);
  emit(span, std::move(spline));
}

void Interpreter::add_nurbs_point() {
  const std::string name = "G5.2";
  const bool first = !nurbs_.open;
  if (first) {
    nurbs_ = {};
    nurbs_.open = true;
    nurbs_.span = action_span();
    nurbs_.doubtful = (state_.uncertain.axes & kPlaneAxes) != 0;
    if (state_.feed_mode != FeedMode::inverse_time && !feed_ready()) nurbs_.faulty = true;
    const bool weight_of_start = !words_.has_axis() && words_.has('P');
    add_nurbs_control(state_.to_program(state_.position), weight_of_start ? words_.value('P') : 1.0);
  }
  if (state_.feed_mode == FeedMode::inverse_time && words_.has('F')) nurbs_.inverse_f = words_.value('F');
  if ((words_.doubtful & (kAxisBits | letter_bit('P'))) != 0) nurbs_.doubtful = true;
  if (!spline_place_allowed(name) || !nurbs_words_allowed(first)) {
    nurbs_.faulty = true;
    return;
  }
  if (words_.has('L')) set_nurbs_order();
  if (!words_.has_axis()) return;
  // G91: every point counts from the position before the block, not from the previous point
  add_nurbs_control(state_.to_program(target()), words_.has('P') ? words_.value('P') : 1.0);
}

void Interpreter::add_nurbs_control(const AxisValues& program, double weight) {
  if (block_allowed(line_span(), nurbs_.points.size()))
    nurbs_.points.push_back({program[0], program[1], weight});
}

void Interpreter::set_nurbs_order() {
  int order = 0;
  near_integer(words_.value('L'), order);
  const std::uint32_t most = options_.bounds.nurbs_order;
  if (most != 0 && order > 0 && static_cast<std::uint32_t>(order) > most) {
    Diagnostic d = problem(Code::word_out_of_range, words_.span(*line_, 'L'), fmt::format("L is {}", order),
                           "curves of CAD systems are of order 4 or 6");
    d.notes.push_back(fmt::format("allowed: {} (--limit nurbs_order=N)", most));
    error(std::move(d));
    nurbs_.faulty = true;
    return;
  }
  if (order > kQuadratic) {
    nurbs_.order = order;
  } else if (order < kQuadratic) {
    report_.warning(problem(Code::nurbs_order, words_.span(*line_, 'L'),
                            fmt::format("L is {}, the order stays {}", order, nurbs_.order)));
  }
}

bool Interpreter::nurbs_words_allowed(bool first) {
  for (const char letter : {'@', '^'}) {
    if (!words_.has(letter)) continue;
    return error(problem(Code::nurbs_point, words_.span(*line_, letter),
                         "a control point can't have polar words", "give it by X and Y"));
  }
  const bool x = words_.has('X'), y = words_.has('Y'), p = words_.has('P');
  if (p && !(words_.value('P') > 0)) {
    return error(problem(Code::nurbs_point, words_.span(*line_, 'P'),
                         fmt::format("weight {}, allowed above 0", figure(words_.value('P')))));
  }
  if (x != y) {
    return error(problem(Code::nurbs_point, action_span(), fmt::format("{} is missing", x ? "Y" : "X"),
                         "a control point needs both X and Y"));
  }
  if (first) return true;
  if (!x) {
    return error(problem(Code::nurbs_point, action_span(), "X and Y are missing",
                         "a weight without a point is allowed on the first line only, for the start"));
  }
  if (p) return true;
  return error(problem(Code::nurbs_point, action_span(), "P is missing",
                       "each control point after the first line needs its weight: P1"));
}

void Interpreter::end_nurbs() {
  const Span span = g_span(GGroup::motion);
  if (!nurbs_.open) {
    error(problem(Code::nurbs_not_open, span, "no G5.2 is open here", "write G5.2 and the points before it"));
    return;
  }
  const Nurbs nurbs = std::exchange(nurbs_, Nurbs{});
  if (words_.has_axis()) {
    error(problem(Code::nurbs_point, line_span(), "G5.3 takes no point",
                  "write the last control point on the line before"));
    return;
  }
  if (nurbs.faulty || nurbs.doubtful) {
    state_.uncertain.axes |= kPlaneAxes;
    return;
  }
  if (nurbs.points.size() < static_cast<std::size_t>(nurbs.order)) {
    Diagnostic d = problem(Code::nurbs_too_few_points, span,
                           fmt::format("{} points, including the start", nurbs.points.size()));
    d.notes.push_back(fmt::format("a curve of order {} (L) needs {} points", nurbs.order, nurbs.order));
    error(std::move(d));
    return;
  }
  emit_nurbs(nurbs);
}

void Interpreter::emit_nurbs(const Nurbs& nurbs) {
  const Span span = g_span(GGroup::motion);
  Spline spline{make_move(state_.position)};
  AxisValues program = state_.to_program(state_.position);
  for (const SplinePoint& p : nurbs.points) {
    program[0] = p.x_mm;
    program[1] = p.y_mm;
    add_control(spline, program, 0, 0, p.weight);
  }
  spline.end = state_.to_machine(program);
  spline.order = nurbs.order;
  if (state_.feed_mode != FeedMode::inverse_time) {
    if (feed_ready()) emit_spline(std::move(spline), span);
    return;
  }
  const double f = words_.has('F') ? words_.value('F') : nurbs.inverse_f;
  spline.length_u = length_mm(spline);
  if (f > 0) {
    spline.duration_s = kSecondsPerMinute / f;
    spline.feed_u_s = spline.length_u / spline.duration_s;
  } else if (state_.feed_linear_mm_min > 0) {
    // without F the controller continues at its current feed
    spline.feed_u_s = state_.feed_linear_mm_min / kSecondsPerMinute;
  } else {
    error(problem(Code::inverse_feed_missing, span, "no F between G5.2 and here",
                  "under G93 the curve needs its own F: 60 divided by its seconds"));
    return move_to(spline.end);
  }
  move_to(spline.end);
  emit(span, std::move(spline));
}

void Interpreter::drop_nurbs(Span span) {
  const Nurbs nurbs = std::exchange(nurbs_, Nurbs{});
  if (nurbs.faulty) return;
  report_.warning(problem(Code::nurbs_dropped, span,
                          fmt::format("the G5.2 on line {} is not closed", nurbs.span.line),
                          "close it with G5.3 on a line before this one"));
}

}  // namespace kadr::gcode
