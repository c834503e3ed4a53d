#include <fmt/format.h>

#include "gcode/constants.h"
#include "gcode/interpret/interpreter.h"

/// A program that is entered at a line of its own (Reading::from_line).
namespace kadr::gcode {

std::string Interpreter::not_entered(const Line& line) {
  if (compensation_.active())
    return fmt::format("cutter compensation has been on since line {}", compensation_span_.line);
  if (nurbs_.open)
    return fmt::format("it stands in the middle of the NURBS that begins on line {}", nurbs_.span.line);
  const bool in_cycle = state_.motion == Motion::cycle && state_.cycle.in_sequence;
  const bool in_thread = passed_.in_thread();
  if (!in_cycle && !in_thread) return {};
  line_ = &line;
  words_.read(line, state_, nullptr);
  if (in_thread && motion_of_line() == Motion::thread && moves())
    return "it goes on with the thread of the move before it";
  if (in_cycle && words_.g(GGroup::motion) == kNoCode && moves())
    return fmt::format("it repeats the {} of a line before it", g_name(state_.cycle.code));
  return {};
}

std::string Interpreter::not_left() const {
  if (nurbs_.open)
    return fmt::format("it stands in the middle of the NURBS that begins on line {}", nurbs_.span.line);
  return {};
}

void Interpreter::enter(const Line& line) {
  passing_ = false;
  for (Block& setting : passed_.settings()) hand_out(setting);
  Approach approach;
  approach.end = passed_.place();
  approach.path_mode = PathMode::exact_stop;
  approach.ways = ways_to(approach.end);
  const auto bytes = static_cast<std::uint32_t>(line.text.size());
  Block block{line.span({0, bytes}), std::move(approach)};
  hand_out(block);
  for (Block waiting : passed_.waiting()) hand_out(waiting);
}

void Interpreter::leave(Span place) {
  left_ = true;
  finish(place);
}

/// The axes that move from home to a place, in groups that move together.
std::vector<std::string> Interpreter::ways_to(const AxisValues& place) const {
  std::vector<std::string> groups = options_.approach;
  if (groups.empty()) {
    std::string others(kAxisLetters);
    others.erase(kZ, 1);
    const bool down = place[kZ] < options_.home[kZ];
    groups = down ? std::vector<std::string>{others, "Z"} : std::vector<std::string>{"Z", others};
  }
  std::vector<std::string> ways;
  for (const std::string& group : groups) {
    std::string moving;
    for (const char letter : group) {
      const auto axis = static_cast<std::size_t>(axis_index(letter));
      if (place[axis] != options_.home[axis]) moving += letter;
    }
    if (!moving.empty()) ways.push_back(std::move(moving));
  }
  return ways;
}

bool Interpreter::refuse_passed_probe() {
  return error(
      problem(Code::entry_probe, action_span(),
              fmt::format("what it finds is not known: the program is entered on line {}",
                          options_.from_line.value_or(0)),
              "say where the material is: [stock] in the machine file, or --set stock.position_mm=Z"));
}

}  // namespace kadr::gcode
