#include <fmt/format.h>

#include <cmath>

#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/letters.h"

namespace kadr::gcode {
namespace {

constexpr double kLargestTurns = 1e6;
constexpr double kLargestOrder = 1e6;
constexpr double kLargestCall = 1e9;

}  // namespace

bool Interpreter::check() {
  const std::size_t errors = report_.errors();
  check_axes();
  check_codes();
  check_unused();
  check_values();
  if (motion_of_line() > Motion::nurbs && moves()) check_motion_words();
  check_tools();
  check_functions();
  if (!words_.owner_codes().empty()) check_owner_call();
  check_shared_p();
  warn_axis_words_move();
  if (state_.compensating() || words_.g(GGroup::compensation) != kNoCode) check_compensation();
  return report_.errors() == errors;
}

void Interpreter::check_axes() {
  const std::uint32_t missing = words_.present & kAxisBits & ~axes_on_machine_;
  if (missing == 0) return;
  for (const char letter : kAxisLetters) {
    if ((missing & letter_bit(letter)) == 0) continue;
    // an axis that is not there stands at 0
    const bool stands = words_.value(letter) == 0;
    Diagnostic d = problem(Code::axis_not_on_machine, words_.span(*line_, letter),
                           fmt::format("this machine has no axis {}{}", letter,
                                       stands ? fmt::format(", and {}0 moves nothing", letter) : ""),
                           stands ? "remove the word; the motion stays the same" : "");
    d.notes.push_back(fmt::format("axes of the machine: {}", options_.axis_letters));
    error(std::move(d));
  }
}

void Interpreter::check_codes() {
  if (calls_number()) check_call();
  const int nonmodal_code = words_.g(GGroup::nonmodal);
  const int motion_code = words_.g(GGroup::motion);
  const bool takes_axes = axis_words_taken();
  const bool names_motion = motion_code != kNoCode && motion_code != code::g80;
  if (takes_axes) check_axis_words();
  if (words_.has_axis() && !takes_axes && !names_motion && !state_.uncertain.motion &&
      (motion_code == code::g80 || state_.motion == Motion::none)) {
    error(problem(Code::axis_words_without_motion, words_.motion_span(*line_),
                  motion_code == code::g80 ? "G80 on this line has ended every motion"
                                           : "no motion code is in force here",
                  "write G0, G1, G2 or G3 before the first axis words"));
    state_.uncertain.motion = true;
  }
  if (nonmodal_code == code::g53) {
    const Motion motion = motion_of_line();
    const bool line_motion = moves() && (motion == Motion::traverse || motion == Motion::feed);
    const bool incremental =
        words_.g(GGroup::distance) != kNoCode ? words_.g(GGroup::distance) == code::g91 : state_.incremental;
    if (!state_.uncertain.motion && (!line_motion || incremental)) {
      error(problem(
          Code::g53_misplaced, g_span(GGroup::nonmodal),
          incremental ? "G53 in G91: machine coordinates are absolute" : "G53 works with G0 and G1 only",
          "write it as G90 G53 G0 ... or G90 G53 G1 ..."));
    }
  }
}

/// M98, or M97 of a dialect that has it.
bool Interpreter::calls_number() const {
  const int code = words_.m(MGroup::call);
  return code != kNoCode && code != code::m99;
}

void Interpreter::check_call() {
  const Span span = words_.span(*line_, MGroup::call);
  if (!words_.has('P')) {
    error(problem(Code::word_missing, span,
                  words_.m(MGroup::call) == code::m98
                      ? "M98 needs P: the number of the subroutine"
                      : "M97 needs P: the sequence number of its first line"));
  }
  if (!calls_only()) return;
  for (const Item& item : line_->items) {
    if ((item.kind != ItemKind::word && item.kind != ItemKind::setting) || item.letter == 'N') continue;
    if (line_->span(item.bytes).column != span.column) {
      error(problem(Code::o_word_place, span, "M98 is not the first word",
                    "write the call on a line of its own, or first on its line"));
      return;
    }
    break;
  }
  if (const Item* other = words_beside_call()) {
    report_.warning(problem(Code::word_not_run, line_->span(other->bytes),
                            "LinuxCNC runs no other word on a line with M98",
                            "write it on a line of its own"));
  }
}

void Interpreter::check_motion_words() {
  const int code = words_.g(GGroup::motion);
  switch (motion_of_line()) {
    case Motion::cycle:
      return check_cycle(code == kNoCode ? state_.cycle.code : code);
    case Motion::thread:
      return check_thread(code::g33);
    case Motion::rigid_tap:
      return check_thread(code::g33_1);
    case Motion::thread_cycle:
      return check_thread_cycle();
    case Motion::none:
    case Motion::traverse:
    case Motion::feed:
    case Motion::arc_clockwise:
    case Motion::arc_counterclockwise:
    case Motion::cubic_spline:
    case Motion::quadratic_spline:
    case Motion::nurbs:
    case Motion::probe:
      break;
  }
}

std::uint32_t Interpreter::usable_letters() const {
  std::uint32_t letters = kAxisBits | letter_bits("FST@^");
  for (const int code : words_.g_codes()) letters |= letters_of_g(code);
  for (const int code : words_.m_codes()) letters |= letters_of_m(code);
  if (moves() && words_.g(GGroup::motion) == kNoCode) letters |= letters_of_g(motion_code(state_));
  if (words_.has('S')) letters |= letter_bit('$');
  if (state_.macros.on && words_.m(MGroup::call) != kNoCode)
    letters |= letter_bits(calls_number() ? "PL" : "P");
  return letters;
}

void Interpreter::check_unused() {
  if (state_.uncertain.motion) return;
  const std::uint32_t unused = words_.present & ~usable_letters();
  if (unused == 0) return;
  for (const char letter : kWordLetters) {
    if ((unused & letter_bit(letter)) == 0) continue;
    Diagnostic d = problem(Code::word_unused, words_.span(*line_, letter),
                           fmt::format("nothing on this line reads {}", letter));
    d.notes.emplace_back(users_of(letter));
    error(std::move(d));
  }
}

void Interpreter::check_values() {
  if (words_.present == 0 && words_.g(GGroup::nonmodal) == kNoCode &&
      words_.g(GGroup::spindle_mode) == kNoCode) {
    return;
  }
  for (const char letter : {'F', 'S'}) {
    if (!words_.has(letter) || words_.value(letter) >= 0) continue;
    error(problem(Code::word_out_of_range, words_.span(*line_, letter),
                  fmt::format("{} is {}, allowed 0 and above", letter, figure(words_.value(letter)))));
  }
  switch (words_.g(GGroup::nonmodal)) {
    case code::g4:
      if (!require_word('P', GGroup::nonmodal, "the seconds to wait")) break;
      if (words_.value('P') < 0) {
        error(problem(Code::word_out_of_range, words_.span(*line_, 'P'),
                      fmt::format("dwell of {} s, allowed 0 and above", figure(words_.value('P')))));
      }
      break;
    case code::g10:
      check_g10();
      break;
    default:
      break;
  }
  if (moves() && is_arc(motion_of_line())) check_whole('P', 1, kLargestTurns);
  if (words_.g(GGroup::spindle_mode) == code::g96)
    require_word('S', GGroup::spindle_mode, "the surface speed");
  if (words_.g(GGroup::spindle_mode) != kNoCode) check_whole('$', 0, 0);
  if (moves() && motion_of_line() == Motion::nurbs) check_whole('L', 0, kLargestOrder);
  if (words_.g(GGroup::path) == code::g64 && words_.has('P') && words_.value('P') < 0) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'P'), "a tolerance below 0"));
  }
  if (words_.m(MGroup::call) != kNoCode) {
    check_whole('P', 0, kLargestCall);
    check_whole('L', 0, kLargestCall);
  }
}

bool Interpreter::require_word(char letter, GGroup group, std::string_view what) {
  if (words_.has(letter)) return true;
  return error(problem(Code::word_missing, g_span(group),
                       fmt::format("{} needs {}: {}", g_name(words_.g(group)), letter, what)));
}

bool Interpreter::require_words(const std::vector<NeededWord>& needed, Span span, std::string_view who) {
  std::string missing;
  for (const NeededWord& word : needed) {
    if (words_.has(word.letter)) continue;
    missing += fmt::format("{} {} ({})", missing.empty() ? "" : ",", word.letter, word.meaning);
  }
  return missing.empty() || error(problem(Code::word_missing, span, fmt::format("{} needs{}", who, missing)));
}

bool Interpreter::check_whole(char letter, double least, double most) {
  if (!words_.has(letter)) return true;
  int whole = 0;
  const double value = words_.value(letter);
  const Span span = words_.span(*line_, letter);
  if (!near_integer(value, whole)) {
    return error(problem(Code::word_not_whole, span, fmt::format("{} is {}", letter, figure(value))));
  }
  if (whole >= least && whole <= most) return true;
  return error(problem(Code::word_out_of_range, span,
                       fmt::format("{} is {}, allowed {:.0f} to {:.0f}", letter, whole, least, most)));
}

void Interpreter::check_shared_p() {
  if (!words_.has('P')) return;
  const int code = words_.g(GGroup::nonmodal);
  const int override_code = words_.m(MGroup::overrides);
  const int motion_code = words_.g(GGroup::motion);
  const int users = (code == code::g4 || code == code::g10 ? 1 : 0) +
                    (words_.g(GGroup::path) == code::g64 ? 1 : 0) +
                    (override_code == code::m50 || override_code == code::m51 ? 1 : 0) +
                    (motion_code == code::g2 || motion_code == code::g3 ? 1 : 0);
  if (users < 2) return;
  report_.warning(problem(Code::word_shared, words_.span(*line_, 'P'),
                          fmt::format("{} codes on this line read this P", users),
                          "write them on separate lines"));
}

}  // namespace kadr::gcode
