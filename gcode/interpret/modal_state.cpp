#include <fmt/format.h>

#include <algorithm>

#include "gcode/interpret/interpreter.h"
#include "gcode/read/parser.h"

/// M70 to M73: modes are saved, and restored by running the words that differ.
namespace kadr::gcode {
namespace {

std::string_view plane_word(Plane plane) {
  return plane == Plane::xy ? "G17 " : plane == Plane::zx ? "G18 " : "G19 ";
}
std::string_view feed_mode_word(FeedMode mode) {
  return mode == FeedMode::inverse_time ? "G93 " : mode == FeedMode::units_per_minute ? "G94 " : "G95 ";
}
std::string work_system_word(int system) {
  // G54 .. G59 are 1 .. 6, G59.1 .. G59.3 are 7 .. 9
  return system <= 6 ? fmt::format("G{} ", 53 + system) : fmt::format("G59.{} ", system - 6);
}
std::string path_word(const ModalState& modes) {
  if (modes.path_mode == PathMode::exact_path) return "G61 ";
  if (modes.path_mode == PathMode::exact_stop) return "G61.1 ";
  // P0 is written out as well: an M51 of the same line reads it too, as in LinuxCNC
  return fmt::format("G64 P{:.9f} ", modes.path_tolerance);
}

/// The words that lead from `now` to `saved`, units and M codes left out.
std::string differing_words(const ModalState& now, const ModalState& saved) {
  std::string words;
  const auto differ = [&](bool differs, std::string_view word) {
    if (differs) words += word;
  };
  differ(now.feed_mode != saved.feed_mode, feed_mode_word(saved.feed_mode));
  differ(now.constant_surface_speed != saved.constant_surface_speed,
         saved.constant_surface_speed ? fmt::format("G96 S{:.0f} ", saved.spindle_rpm) : "G97 ");
  // as LinuxCNC writes them: F with one decimal, S whole
  differ(now.feed_number != saved.feed_number, fmt::format("F{:.1f} ", saved.feed_number));
  const bool speed_told = saved.constant_surface_speed && !now.constant_surface_speed;
  differ(now.spindle_rpm != saved.spindle_rpm && !speed_told, fmt::format("S{:.0f} ", saved.spindle_rpm));
  differ(now.plane != saved.plane, plane_word(saved.plane));
  differ(now.diameter_mode != saved.diameter_mode, saved.diameter_mode ? "G7 " : "G8 ");
  differ(now.compensation_code != saved.compensation_code && saved.compensation_code == code::g40, "G40 ");
  differ(now.work_system != saved.work_system, work_system_word(saved.work_system));
  differ(now.path_mode != saved.path_mode || now.path_tolerance != saved.path_tolerance, path_word(saved));
  differ(now.incremental != saved.incremental, saved.incremental ? "G91 " : "G90 ");
  differ(now.arc_centers_absolute != saved.arc_centers_absolute,
         saved.arc_centers_absolute ? "G90.1 " : "G91.1 ");
  differ(now.retract_to_start != saved.retract_to_start, saved.retract_to_start ? "G98 " : "G99 ");
  // of a tool length only whether there is one
  differ(now.tool_length != saved.tool_length, saved.tool_length ? "G43 " : "G49 ");
  differ(now.g92_active != saved.g92_active, saved.g92_active ? "G92.3 " : "G92.2 ");
  return words;
}

/// The codes by which LinuxCNC saves coolant and overrides; 0: none, which is never restored.
int mist_code(const ModalState& modes) { return modes.mist ? 7 : modes.flood ? 0 : 9; }
int flood_code(const ModalState& modes) { return modes.flood ? 8 : 0; }
int override_code(const ModalState& modes) { return modes.feed_override ? 48 : 51; }
int spindle_code(Turning turning) {
  return turning == Turning::clockwise ? 3 : turning == Turning::counterclockwise ? 4 : 5;
}

/// M codes that restore `saved`. As in LinuxCNC, a coolant that was off is not switched off if the other
/// was on, and of the overrides only an enabled feed override is restored.
std::vector<int> differing_m_codes(const ModalState& now, const ModalState& saved) {
  std::vector<int> codes;
  const auto differ = [&](int code_now, int code_saved) {
    if (code_now != code_saved && code_saved != 0) codes.push_back(code_saved);
  };
  differ(spindle_code(now.turning), spindle_code(saved.turning));
  differ(mist_code(now), mist_code(saved));
  differ(flood_code(now), flood_code(saved));
  differ(override_code(now), override_code(saved));
  return codes;
}

}  // namespace

ModalState Interpreter::modes() const {
  ModalState modes;
  modes.inches = state_.inches;
  modes.incremental = state_.incremental;
  modes.arc_centers_absolute = state_.arc_centers_absolute;
  modes.retract_to_start = state_.retract_to_start;
  modes.diameter_mode = state_.diameter_mode;
  modes.constant_surface_speed = state_.constant_surface_speed;
  modes.feed_override = state_.feed_override;
  modes.speed_override = state_.speed_override;
  modes.feed_hold = state_.feed_hold;
  modes.mist = state_.mist;
  modes.flood = state_.flood;
  modes.plane = state_.plane;
  modes.feed_mode = state_.feed_mode;
  modes.path_mode = state_.path_mode;
  modes.path_tolerance = state_.path_tolerance;
  modes.feed_number = state_.feed_number;
  modes.spindle_rpm = state_.spindle_rpm;
  modes.turning = state_.turning;
  modes.work_system = state_.work_system;
  modes.compensation_code = state_.compensation_code;
  modes.tool_length = std::any_of(state_.tool_offset.begin(), state_.tool_offset.end(),
                                  [](double offset) { return offset != 0; });
  modes.g92_active = state_.parameters[parameter::kG92Active] == 1;
  return modes;
}

void Interpreter::modal_state() {
  const int code = words_.m(MGroup::modal_state);
  if (code == kNoCode) return;
  CallLevel& level = state_.levels.back();
  switch (code) {
    case code::m71:
      level.modal.reset();
      level.restores_modal = false;
      return;
    case code::m72: {
      const Span place = words_.span(*line_, MGroup::modal_state);
      if (level.modal) return restore(*level.modal, place);
      error(problem(Code::modal_state_missing, place, "nothing was saved at this level of calls",
                    "M70 saves the modes for an M72 in the same subroutine; M71 discards them"));
      return;
    }
    default:
      level.modal = modes();
      level.restores_modal = code == code::m73;
      return;
  }
}

void Interpreter::restore(const ModalState& saved, Span place) {
  if (state_.inches != saved.inches) run_words(saved.inches ? "G20" : "G21", place);
  // one line of all words and the first M code, then each further M code on its own
  const ModalState now = modes();
  std::string line = differing_words(now, saved);
  for (const int code : differing_m_codes(now, saved)) {
    run_words(line + fmt::format("M{}", code), place);
    line.clear();
  }
  if (!line.empty()) run_words(line, place);
  state_.feed_hold = state_.feed_hold || saved.feed_hold;
}

void Interpreter::run_words(const std::string& words, Span place) {
  const Words kept = words_;
  const Line* const line = line_;
  Line own;
  own.file = place.file;
  own.number = place.line;
  own.text = words;
  Parser(state_.names, report_, options_.dialect).parse(own);
  place_ = place;
  report_.set_place(place);
  run(own);
  report_.set_place(std::nullopt);
  place_.reset();
  words_ = kept;
  line_ = line;
}

void Interpreter::leave_level(Span place) {
  const CallLevel level = std::move(state_.levels.back());
  state_.levels.pop_back();
  if (level.restores_modal) restore(*level.modal, place);
}

void Interpreter::diameter_mode() {
  const int code = words_.g(GGroup::diameter);
  diameters_begin_ = code == code::g7 && !state_.diameter_mode;
  if (code != kNoCode) state_.diameter_mode = code == code::g7;
}

}  // namespace kadr::gcode
