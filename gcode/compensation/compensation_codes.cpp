#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {
namespace {

using Kind = CompensationFault::Kind;

/// LinuxCNC takes this angle for a length: under G21 it is 25.4 times as large.
constexpr double kSweepTolerance_rad = 1e-3;

bool is_one_of(int value, std::initializer_list<int> values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

double sweep_tolerance_rad(bool inches) {
  return inches ? kSweepTolerance_rad : kMillimetresPerInch * kSweepTolerance_rad;
}

/// A point turned forth and back differs in its last digits: coordinates that do not move must stay exact.
AxisValues near(const AxisValues& from, AxisValues to) {
  for (std::size_t a = 0; a < to.size(); ++a) {
    if (std::fabs(to[a] - from[a]) <= kSamePoint_u) to[a] = from[a];
  }
  return to;
}

/// The controlled point of a lathe tool seen from the centre of its nose, program coordinates: LinuxCNC's
/// orientations 1 to 8 are around the nose, 0 and 9 in its centre.
AxisValues nose_origin(int orientation, double radius_mm) {
  AxisValues origin{};
  if (is_one_of(orientation, {1, 2, 6})) origin[0] = -radius_mm;
  if (is_one_of(orientation, {3, 4, 8})) origin[0] = radius_mm;
  if (is_one_of(orientation, {2, 3, 7})) origin[2] = -radius_mm;
  if (is_one_of(orientation, {1, 4, 5})) origin[2] = radius_mm;
  return origin;
}

}  // namespace

void Interpreter::compensation() {
  const int code = words_.g(GGroup::compensation);
  if (code == kNoCode) return;
  if (code == code::g40) return compensation_off();
  if (state_.compensating()) return;
  compensation_span_ = g_span(GGroup::compensation);
  CompensationTool tool;
  tool.left = is_one_of(code, {code::g41, code::g41_1});
  const bool found = !silent_ && find_compensation_tool(tool);
  state_.compensation_code = tool.left ? code::g41 : code::g42;
  if (found && tool.radius_mm == 0) return;
  compensation_tilted_ = state_.rotation_deg != 0 && state_.plane != Plane::xy;
  if (compensation_tilted_) compensation_.set_last_end(state_.to_program(compensation_.last_end()));
  compensation_.begin(tool, compensation_tilted_ ? state_.to_program(state_.position) : state_.position);
  // without a radius, or from an unknown point, nothing is known of the contour
  const bool doubtful = state_.uncertain.axes != 0 || (words_.doubtful & letter_bit('D')) != 0;
  if (!found || doubtful) compensation_.lose();
}

void Interpreter::compensation_off() {
  if (state_.compensating() && compensation_.active()) {
    if (compensation_.entered()) state_.straight_move_due = true;
    end_compensation(g_span(GGroup::compensation));
  }
  state_.compensation_code = code::g40;
}

bool Interpreter::find_compensation_tool(CompensationTool& tool) {
  const int code = words_.g(GGroup::compensation);
  const Span span = g_span(GGroup::compensation);
  double diameter_mm = 0;
  int orientation = 0;
  if (is_one_of(code, {code::g41_1, code::g42_1})) {
    diameter_mm = words_.value('D') * state_.length_factor();
    if (words_.has('L')) near_integer(words_.value('L'), orientation);
  } else {
    const Tool* entry = compensation_table_entry();
    if (entry == nullptr) return false;
    diameter_mm = entry->diameter_mm;
    orientation = entry->orientation;
    if (state_.plane != Plane::zx && orientation != 0 && orientation != 9) {
      Diagnostic d =
          problem(Code::compensation_lathe_tool, span,
                  fmt::format("tool {} is a lathe tool: orientation {}", entry->number, orientation),
                  "write G18 before");
      return error(std::move(d));
    }
  }
  // a negative diameter, as of a tool smaller than the nominal, is the other side
  if (diameter_mm < 0) tool.left = !tool.left;
  tool.radius_mm = std::fabs(diameter_mm) / 2;
  tool.plane = state_.plane;
  if (state_.plane == Plane::zx) tool.origin = nose_origin(orientation, tool.radius_mm);
  if (tool.radius_mm == 0) {
    report_.warning(problem(Code::compensation_radius_zero, span, "the tool's radius is 0",
                            "the path stays as programmed"));
  }
  return true;
}

const Tool* Interpreter::compensation_table_entry() {
  static const Tool kNoTool;
  int number = 0;
  if (words_.has('D')) near_integer(words_.value('D'), number);
  const bool by_number = number != 0;
  if (!by_number) number = state_.tool_in_spindle;
  if (number == 0) return &kNoTool;
  if (const Tool* entry = state_.tools.find(number)) return entry;
  Diagnostic d = problem(Code::compensation_tool_unknown,
                         by_number ? words_.span(*line_, 'D') : g_span(GGroup::compensation),
                         fmt::format("tool {} has no entry in the tool table", number),
                         "give the diameter itself: G41.1 D or G42.1 D, or name a table: --tools");
  if (!options_.tools) d.notes.emplace_back("no tool table has been given");
  error(std::move(d));
  return nullptr;
}

void Interpreter::execute_compensated() {
  const std::size_t errors = report_.errors();
  compensation_faults_ = 0;
  execute();
  // a move that was refused for another reason leaves a gap in the contour
  if (report_.errors() - errors > compensation_faults_) compensation_.lose();
}

void Interpreter::compensate(const Block& block) {
  const FeedRates feeds{state_.feed_linear_mm_min / kSecondsPerMinute,
                        state_.feed_rotary_deg_min / kSecondsPerMinute};
  compensation_.set_sweep_tolerance(sweep_tolerance_rad(state_.inches));
  CompensationFault fault;
  if (compensation_tilted_ && is_move(block)) {
    Block programmed = block;
    AxisValues& end = move_of(programmed)->end;
    end = near(compensation_.programmed(), state_.to_program(end));
    fault = compensation_.take(programmed, feeds);
  } else {
    fault = compensation_.take(block, feeds);
  }
  report_compensation_fault(fault, block.span);
  state_.tool_shift = compensation_tilted_ ? state_.rotated(compensation_.shift()) : compensation_.shift();
}

void Interpreter::hand_out_compensated(Block& block) {
  Move* move = compensation_tilted_ ? move_of(block) : nullptr;
  if (move != nullptr) {
    if (Arc* arc = std::get_if<Arc>(&block.action)) {
      const PlaneAxes axes = plane_axes(arc->plane);
      const auto first = static_cast<std::size_t>(axes.first), second = static_cast<std::size_t>(axes.second);
      AxisValues center = arc->end;
      center[first] = arc->center_first_mm;
      center[second] = arc->center_second_mm;
      center = state_.to_machine(center);
      arc->center_first_mm = center[first];
      arc->center_second_mm = center[second];
      arc->plane_rotation_deg = state_.rotation_deg;
    }
    move->end = state_.to_machine(move->end);
  }
  hand_out(block);
}

void Interpreter::end_compensation(Span place) {
  compensation_.set_sweep_tolerance(sweep_tolerance_rad(state_.inches));
  report_compensation_fault(compensation_.end(), place);
  if (compensation_tilted_) compensation_.set_last_end(state_.to_machine(compensation_.last_end()));
  compensation_tilted_ = false;
  state_.tool_shift = {};
}

void Interpreter::report_compensation_fault(const CompensationFault& fault, Span span) {
  Diagnostic d = problem(Code::compensation_gouge, span, {});
  switch (fault.kind) {
    case Kind::none:
      return;
    case Kind::entry_short:
      d = problem(Code::compensation_entry_short, span,
                  fault.measured > 0 ? fmt::format("entry move of {} mm", figure(fault.measured))
                                     : "nothing moves in the plane",
                  fault.measured > 0 ? "start further away from the contour"
                                     : "write it before G41, and a longer move in the plane after it");
      d.notes.push_back(
          fmt::format("it must be longer than the tool's radius, {} mm", figure(fault.allowed)));
      break;
    case Kind::entry_arc:
      d = problem(Code::compensation_entry_arc, span, "no arc leads from here to the offset contour",
                  "enter with a straight move, or with an arc of another radius");
      break;
    case Kind::arc_small:
      d = problem(Code::compensation_arc_small, span,
                  fmt::format("arc of radius {} mm", figure(fault.measured)), "choose a smaller tool");
      d.notes.push_back(fmt::format("the tool runs inside it: its radius must be above the tool's, {} mm",
                                    figure(fault.allowed)));
      break;
    case Kind::line_reversed:
      d.label =
          fmt::format("the move before this corner is {} mm too short for the tool", figure(fault.measured));
      break;
    case Kind::arc_reversed:
      d.label = fmt::format("the arc before this corner would sweep {} degrees instead of {}",
                            figure(fault.measured), figure(fault.allowed));
      break;
    case Kind::no_meeting:
      d = problem(Code::compensation_no_meeting, span,
                  fmt::format("the tool's paths before and after this corner miss each other by {} mm",
                              figure(fault.measured)),
                  "choose a smaller tool");
      break;
    case Kind::same_center:
      d = problem(Code::compensation_no_meeting, span, "this arc and the one before it have the same centre");
      break;
  }
  if (fault.earlier.line != 0) {
    d.notes.push_back(fmt::format("the move before the corner is on line {}", fault.earlier.line));
  }
  if (d.code == Code::compensation_gouge) d.help = "choose a smaller tool, or leave out the short move";
  d.notes.push_back(fmt::format("cutter compensation has been on since line {}", compensation_span_.line));
  ++compensation_faults_;
  report_.error(std::move(d));
}

}  // namespace kadr::gcode
