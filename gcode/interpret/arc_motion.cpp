#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/interpret/interpreter.h"
#include "gcode/measure.h"
#include "gcode/read/scanner.h"
#include "machine/base/numbers.h"

namespace kadr::gcode {
namespace {

/// Letter of the centre offset along an axis X Y Z: I J K.
char offset_letter(int axis) { return static_cast<char>('I' + axis); }
std::string_view plane_name(Plane plane) {
  return plane == Plane::xy ? "XY (G17)" : plane == Plane::zx ? "XZ (G18)" : "YZ (G19)";
}
PlanePoint in_plane(const AxisValues& values, const PlaneAxes& axes) {
  return {values[static_cast<std::size_t>(axes.first)], values[static_cast<std::size_t>(axes.second)]};
}

}  // namespace

AxisValues Interpreter::arc_frame(const AxisValues& machine) const {
  const bool tilted = state_.rotation_deg != 0 && state_.plane != Plane::xy;
  return tilted ? state_.to_program(machine) : machine;
}

AxisValues Interpreter::arc_frame_to_machine(const AxisValues& point) const {
  const bool tilted = state_.rotation_deg != 0 && state_.plane != Plane::xy;
  return tilted ? state_.to_machine(point) : point;
}

void Interpreter::arc(Motion motion) {
  const bool clockwise = motion == Motion::arc_clockwise;
  const PlaneAxes axes = plane_axes(state_.plane);
  if (state_.straight_move_due) {
    error(problem(Code::compensation_exit_arc, action_span(),
                  "an arc can't lead back from the offset contour",
                  "write a straight move, G0 or G1, before it"));
    state_.straight_move_due = false;
    return move_to(target());
  }
  const bool feed_is_ready = feed_ready();
  const AxisValues end = target();
  const std::uint32_t plane_bits = (1U << axes.first) | (1U << axes.second);
  const std::uint32_t words_in_doubt = words_.doubtful & (kAxisBits | letter_bits("IJKR"));
  const AxisValues from = arc_frame(state_.position);
  const AxisValues to = arc_frame(end);
  ArcGeometry found;
  const bool known = (state_.uncertain.axes & plane_bits) == 0 && words_in_doubt == 0;
  if (!known || !find_arc(from, to, clockwise, found) || !feed_is_ready) return move_to(end);

  int turns = 1;
  if (words_.has('P')) near_integer(words_.value('P'), turns);
  Arc arc{make_move(end)};
  arc.plane = state_.plane;
  AxisValues center = to;
  center[static_cast<std::size_t>(axes.first)] = found.center.first_mm;
  center[static_cast<std::size_t>(axes.second)] = found.center.second_mm;
  const PlanePoint handed_center =
      compensation_tilted_ ? found.center : in_plane(arc_frame_to_machine(center), axes);
  arc.center_first_mm = handed_center.first_mm;
  arc.center_second_mm = handed_center.second_mm;
  arc.plane_rotation_deg = state_.plane == Plane::xy ? 0 : state_.rotation_deg;
  arc.turns = clockwise ? -turns : turns;
  const double sweep =
      arc_sweep_rad(in_plane(from, axes), in_plane(to, axes), found.center, clockwise, turns);
  const auto normal = static_cast<std::size_t>(axes.normal);
  warn_nearly_full_circle(in_plane(from, axes), in_plane(to, axes), sweep, found.radius_start_mm, turns);
  measure_arc(sweep, (found.radius_start_mm + found.radius_end_mm) / 2, to[normal] - from[normal], arc);
  set_feed(arc);
  last_move_end_ = end;
  move_to(end);
  emit(action_span(), arc);
}

bool Interpreter::find_arc(const AxisValues& start, const AxisValues& end, bool clockwise,
                           ArcGeometry& result) {
  const PlaneAxes axes = plane_axes(state_.plane);
  const PlanePoint from = in_plane(start, axes);
  const PlanePoint to = in_plane(end, axes);
  const bool centers = (words_.present & letter_bits("IJK")) != 0;
  const Span span = action_span();
  if (words_.has('R')) {
    if (centers) {
      return error(problem(Code::arc_format_mixed, span, "both R and I J K describe this arc",
                           "give either the radius R or the centre I J K"));
    }
    result = arc_of_radius(from, to, words_.value('R') * state_.length_factor(), clockwise);
  } else {
    if (!centers) {
      return error(
          problem(Code::arc_center_missing, span, "neither a centre (I J K) nor a radius (R) is given"));
    }
    PlanePoint center;
    if (!arc_center_words(center)) return false;
    result = arc_about(
        from, to, center,
        arc_limits(state_.inches, options_.arc_end_tolerance_mm, options_.arc_end_tolerance_relative));
  }
  if (result.fault != ArcFault::none) return refuse_arc(result, to);
  warn_arc(result);
  return true;
}

bool Interpreter::arc_center_words(PlanePoint& center) {
  const PlaneAxes axes = plane_axes(state_.plane);
  const char across = offset_letter(axes.normal);
  if (words_.has(across) && !rules_.offset_outside_plane_ignored) {
    const bool zero = words_.value(across) == 0;
    return error(problem(
        Code::arc_offset_outside_plane, words_.span(*line_, across),
        fmt::format("{} points out of the plane {}", across, plane_name(state_.plane)),
        zero ? fmt::format(
                   "{0}0 comes from a postprocessor for another controller: --dialect grbl or marlin ignores "
                   "it; or remove {0}",
                   across)
             : "choose the plane with G17, G18 or G19 before the arc"));
  }
  if (words_.has(across) && words_.value(across) != 0) {
    report_.warning(problem(Code::word_without_effect, words_.span(*line_, across),
                            fmt::format("{} points out of the plane {}", across, plane_name(state_.plane)),
                            "choose the plane with G17, G18 or G19 before the arc"));
  }
  for (const int axis : {axes.first, axes.second}) {
    const char letter = offset_letter(axis);
    if (state_.arc_centers_absolute && !words_.has(letter)) {
      return error(problem(Code::arc_center_missing, action_span(), fmt::format("{} is missing", letter),
                           "under G90.1 both coordinates of the centre must be given"));
    }
  }
  center = written_center(state_.arc_centers_absolute);
  return true;
}

/// The centre of I J K in the plane, machine coordinates.
PlanePoint Interpreter::written_center(bool absolute) const {
  const PlaneAxes axes = plane_axes(state_.plane);
  // in program coordinates, from there to the machine's as every end point
  AxisValues program = state_.to_program(state_.position);
  for (const int axis : {axes.first, axes.second}) {
    const char letter = offset_letter(axis);
    const double value = words_.has(letter) ? words_.value(letter) * state_.length_factor() : 0;
    double& along = program[static_cast<std::size_t>(axis)];
    along = absolute ? value : along + value;
  }
  return in_plane(arc_frame(state_.to_machine(program)), axes);
}

/// Whether I J K describe this arc if they are absolute where they are relative now, or the other way round.
bool Interpreter::fits_with_other_centers(PlanePoint end) const {
  const PlanePoint start = in_plane(arc_frame(state_.position), plane_axes(state_.plane));
  const PlanePoint center = written_center(!state_.arc_centers_absolute);
  return arc_about(start, end, center, limits_of_arc()).fault == ArcFault::none;
}

ArcLimits Interpreter::limits_of_arc() const {
  return arc_limits(state_.inches, options_.arc_end_tolerance_mm, options_.arc_end_tolerance_relative);
}

std::string Interpreter::arc_point(PlanePoint point) const {
  const PlaneAxes axes = plane_axes(state_.plane);
  const auto first = static_cast<std::size_t>(axes.first), second = static_cast<std::size_t>(axes.second);
  const double unit = state_.length_factor();
  AxisValues at = arc_frame(state_.position);
  at[first] = point.first_mm;
  at[second] = point.second_mm;
  at = state_.to_program(arc_frame_to_machine(at));
  return fmt::format("{}{} {}{}", kAxisLetters[first], figure(at[first] / unit), kAxisLetters[second],
                     figure(at[second] / unit));
}

void Interpreter::explain_off_circle(const ArcGeometry& arc, PlanePoint end, Diagnostic& d) const {
  const double apart = std::fabs(arc.radius_start_mm - arc.radius_end_mm);
  d.label = fmt::format("radius at start {:.3f} mm, at end {:.3f} mm, differ by {:.3f} mm",
                        arc.radius_start_mm, arc.radius_end_mm, apart);
  const ArcLimits limits = limits_of_arc();
  d.notes.push_back(
      fmt::format("allowed {} mm: the larger of {} mm (path.arc_end_tolerance_mm may widen it) and {} % "
                  "of the radius, at most {} mm",
                  figure(arc.allowed_mm), figure(limits.least_mm), figure(limits.relative * 100),
                  figure(limits.ceiling_mm)));
  // the second coordinate that would lie on the circle, on the side where the end is
  const double across = end.first_mm - arc.center.first_mm;
  const double square = (arc.radius_start_mm - across) * (arc.radius_start_mm + across);
  if (fits_with_other_centers(end)) {
    d.help = state_.arc_centers_absolute ? "it fits if I J K count from the start: write G91.1 before it"
                                         : "it fits if I J K are absolute: write G90.1 before it";
    return;
  }
  d.help = "give R instead of I J K, or check the centre";
  if (square < 0) return;
  const double up = end.second_mm >= arc.center.second_mm ? 1 : -1;
  const double fitting = arc.center.second_mm + up * std::sqrt(square);
  d.help = fmt::format("with this centre the end is {}; or give R instead of I J K",
                       arc_point({end.first_mm, fitting}));
}

bool Interpreter::refuse_arc(const ArcGeometry& arc, PlanePoint end) {
  const Span span = action_span();
  Diagnostic d = problem(Code::arc_end_off_circle, span, {});
  switch (arc.fault) {
    case ArcFault::radius_too_small:
      d = problem(Code::arc_radius_too_small, words_.span(*line_, 'R'),
                  fmt::format("radius {:.4f} mm", arc.radius_start_mm));
      d.notes.push_back(fmt::format("the end is {:.4f} mm away: the radius must be at least {:.4f} mm",
                                    2 * arc.half_chord_mm, arc.half_chord_mm));
      break;
    case ArcFault::no_chord:
      d = problem(Code::arc_radius_undetermined, span, "the arc ends where it starts",
                  "give the centre with I J K: R alone doesn't say where the circle lies");
      break;
    case ArcFault::zero_radius:
      d = problem(
          Code::arc_radius_zero, span,
          fmt::format("radius at start {:.4f} mm, at end {:.4f} mm", arc.radius_start_mm, arc.radius_end_mm));
      d.notes.push_back(fmt::format("allowed above {} mm", figure(kRadiusTolerance_mm, 5)));
      break;
    case ArcFault::none:
    case ArcFault::off_circle:
      explain_off_circle(arc, end, d);
      break;
  }
  if (arc.fault == ArcFault::off_circle || arc.fault == ArcFault::zero_radius) {
    const PlanePoint start = in_plane(arc_frame(state_.position), plane_axes(state_.plane));
    d.notes.push_back(fmt::format("start {}, centre {}", arc_point(start), arc_point(arc.center)));
  }
  return error(std::move(d));
}

/// An end just behind the start makes a whole turn of what was perhaps no arc at all.
void Interpreter::warn_nearly_full_circle(PlanePoint from, PlanePoint to, double sweep_rad, double radius_mm,
                                          int turns) {
  const double dx_mm = to.first_mm - from.first_mm, dy_mm = to.second_mm - from.second_mm;
  const double apart_mm = std::sqrt(dx_mm * dx_mm + dy_mm * dy_mm);
  if (turns != 1 || !(apart_mm > 0) || apart_mm > options_.arc_end_tolerance_mm || sweep_rad < kPi) return;
  report_.warning(problem(Code::arc_full_circle, action_span(),
                          fmt::format("the end is {} mm behind the start: {:.3f} mm of arc",
                                      figure(apart_mm, 6), sweep_rad * radius_mm),
                          "for a whole circle leave the end out, as in G3 I-10; else correct it"));
}

/// How far the last digit of a word as written may be off, mm; 0 if its value is computed.
double Interpreter::rounding_of(char letter) const {
  const Item& item = words_.item(*line_, letter);
  if (item.value >= 0) return 0;
  const std::string_view text = line_->slice(item.bytes);
  const std::size_t point = text.find('.');
  const auto decimals =
      point == std::string_view::npos
          ? 0
          : std::count_if(text.begin() + static_cast<std::ptrdiff_t>(point), text.end(), is_digit);
  double half_digit = 0.5;
  for (std::ptrdiff_t i = 0; i < decimals; ++i) half_digit /= 10;
  return half_digit * state_.length_factor();
}

void Interpreter::warn_arc(const ArcGeometry& arc) {
  const double apart = std::fabs(arc.radius_start_mm - arc.radius_end_mm);
  const double short_mm =
      arc.half_circle_taken ? arc.half_chord_mm - std::fabs(words_.value('R')) * state_.length_factor() : 0;
  if (arc.half_circle_taken) {
    // a radius as exact as it is written is no fault
    if (short_mm <= std::max(kHalfCircleNoise_mm, rounding_of('R'))) return;
    Diagnostic d = problem(Code::arc_by_tolerance, words_.span(*line_, 'R'),
                           fmt::format("radius below {:.5f} mm: the half circle is used", arc.half_chord_mm));
    d.notes.push_back(fmt::format("accepted up to {} mm short", figure(kRadiusTolerance_mm, 5)));
    const std::string most = fmt::format("at most {:.5f} mm short, on line {}", short_mm, d.span.line);
    report_.repeated_warning(std::move(d), short_mm, most);
  } else if (apart > options_.arc_end_tolerance_mm) {
    Diagnostic d = problem(Code::arc_by_tolerance, action_span(),
                           fmt::format("radius at start {:.3f} mm, at end {:.3f} mm: a spiral",
                                       arc.radius_start_mm, arc.radius_end_mm));
    d.notes.push_back(
        fmt::format("accepted up to {:.3f} mm; reported above {} mm (path.arc_end_tolerance_mm)",
                    arc.allowed_mm, figure(options_.arc_end_tolerance_mm)));
    const std::string most = fmt::format("at most {:.3f} mm off the circle, on line {}", apart, d.span.line);
    report_.repeated_warning(std::move(d), apart, most);
  }
}

}  // namespace kadr::gcode
