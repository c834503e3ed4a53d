#include <fmt/format.h>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {
namespace {

/// Why a code is not allowed under compensation, whatever the tool; empty: allowed.
std::string_view conflict_of_nonmodal(int code) {
  switch (code) {
    case code::g28:
    case code::g30:
      return "moves to a reference point";
    case code::g28_1:
    case code::g30_1:
      return "stores the position, which is off the contour";
    case code::g52:
    case code::g92:
      return "moves the origin";
    default:
      return {};
  }
}

std::string_view conflict_of_motion(Motion motion) {
  switch (motion) {
    case Motion::cubic_spline:
    case Motion::quadratic_spline:
    case Motion::nurbs:
      return "is a spline";
    case Motion::probe:
      return "probes";
    case Motion::thread:
    case Motion::rigid_tap:
    case Motion::thread_cycle:
      return "follows the spindle";
    case Motion::cycle:
      return "is a cycle";
    case Motion::none:
    case Motion::traverse:
    case Motion::feed:
    case Motion::arc_clockwise:
    case Motion::arc_counterclockwise:
      break;
  }
  return {};
}

}  // namespace

void Interpreter::check_compensation() {
  const int code = words_.g(GGroup::compensation);
  const bool until_now = state_.compensating();
  if (code != kNoCode && code != code::g40) check_compensation_words();
  check_while_compensating(until_now, code == kNoCode ? until_now : code != code::g40);
}

void Interpreter::check_compensation_words() {
  const int code = words_.g(GGroup::compensation);
  const Span span = g_span(GGroup::compensation);
  if (state_.compensating()) {
    Diagnostic d =
        problem(Code::compensation_twice, span,
                fmt::format("{}, but compensation is already on", g_name(code)), "write G40 before");
    d.notes.push_back(fmt::format("it has been on since line {}", compensation_span_.line));
    error(std::move(d));
  }
  if (plane_of_line() == Plane::yz) {
    error(problem(Code::compensation_plane, span, "the plane in force is YZ (G19)",
                  "choose the plane with G17 or G18 first"));
  }
  if (code == code::g41_1 || code == code::g42_1) {
    require_word('D', GGroup::compensation, "the diameter of the tool");
    if (words_.has('L') && plane_of_line() != Plane::zx) {
      error(problem(Code::compensation_lathe_tool, words_.span(*line_, 'L'),
                    "L is the orientation of a lathe tool", "write G18 first, or leave L out"));
    } else {
      check_whole('L', 0, kLargestOrientation);
    }
    return;
  }
  check_whole('D', 0, kLargestTool);
  if (words_.has('L')) {
    report_.warning(problem(Code::compensation_orientation_unread, words_.span(*line_, 'L'),
                            fmt::format("{} does not read L", g_name(code)),
                            fmt::format("{}.1 D L gives diameter and orientation", g_name(code))));
  }
}

void Interpreter::check_while_compensating(bool until_now, bool from_now) {
  // tool, overrides, outputs and plane change before G40 and G41 of the same line, the rest after them
  if (until_now) {
    const int tool = words_.m(MGroup::tool_change);
    const int override_code = words_.m(MGroup::overrides);
    const int input = words_.m(MGroup::inputs);
    if (tool == code::m6)
      refuse_while_compensating(words_.span(*line_, MGroup::tool_change), "M6", "changes the tool");
    if (override_code != kNoCode) {
      refuse_while_compensating(words_.span(*line_, MGroup::overrides), fmt::format("M{}", override_code),
                                "switches overrides");
    }
    if (input != kNoCode) {
      refuse_while_compensating(words_.span(*line_, MGroup::inputs), fmt::format("M{}", input),
                                input == code::m66 ? "waits for an input" : "switches an output");
    }
    if (plane_of_line() != state_.plane) {
      refuse_while_compensating(g_span(GGroup::plane), g_name(words_.g(GGroup::plane)), "changes the plane");
    }
  }
  if (!from_now) return;
  struct Refused {
    GGroup group;
    std::string_view what;
  };
  constexpr Refused kGroups[] = {{GGroup::tool_length, "changes the tool length offset"},
                                 {GGroup::coordinate_system, "chooses a work system"},
                                 {GGroup::path, "changes the path control"},
                                 {GGroup::retract, "belongs to cycles"}};
  for (const Refused& refused : kGroups) {
    const int code = words_.g(refused.group);
    if (code != kNoCode) refuse_while_compensating(g_span(refused.group), g_name(code), refused.what);
  }
  const int nonmodal_code = words_.g(GGroup::nonmodal);
  std::string_view what = conflict_of_nonmodal(nonmodal_code);
  if (nonmodal_code == code::g10 && (words_.value('L') == 2 || words_.value('L') == 20)) {
    int system = 0;
    near_integer(words_.value('P'), system);
    if (system == 0 || system == state_.work_system) what = "moves the work system in force";
  }
  const bool offset = !until_now || compensation_.active();  // a radius of 0 moves nothing
  if (nonmodal_code == code::g53 && offset) what = "moves in machine coordinates";
  if (!what.empty()) refuse_while_compensating(g_span(GGroup::nonmodal), g_name(nonmodal_code), what);
  if (state_.uncertain.motion || !moves()) return;
  const Motion motion = motion_of_line();
  const bool by_spindle =
      motion == Motion::thread || motion == Motion::rigid_tap || motion == Motion::thread_cycle;
  what = conflict_of_motion(motion);
  if (what.empty() || (by_spindle && !offset && motion != Motion::thread_cycle)) return;
  const int motion_code = words_.g(GGroup::motion);
  refuse_while_compensating(motion_code == kNoCode ? action_span() : g_span(GGroup::motion),
                            motion_code == kNoCode ? "the motion in force" : g_name(motion_code), what);
}

void Interpreter::refuse_while_compensating(Span span, std::string_view name, std::string_view what) {
  Diagnostic d = problem(Code::compensation_conflict, span, fmt::format("{} {}", name, what),
                         "write G40 and a straight move before it");
  const Span since = state_.compensating() ? compensation_span_ : g_span(GGroup::compensation);
  d.notes.push_back(fmt::format("cutter compensation has been on since line {}", since.line));
  error(std::move(d));
}

}  // namespace kadr::gcode
