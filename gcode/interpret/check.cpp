#include <fmt/format.h>

#include <cmath>

#include "gcode/interpret/interpreter.h"

namespace kadr::gcode {
namespace {

constexpr double kLargestTurns = 1e6;
constexpr double kLargestOrder = 1e6;
constexpr double kLargestCall = 1e9;

/// Codes that read a letter, for the message about a letter that nobody reads.
std::string_view users_of(char letter) {
  switch (letter) {
    case 'D':
      return "D belongs to G41 G42 G41.1 G42.1 G96";
    case 'E':
      return "E belongs to G76 M66 M67 M68";
    case 'H':
      return "H belongs to G43 G43.2 G76";
    case 'I':
    case 'J':
      return "I and J belong to G2 G3 G5 G5.1 G10 G33.1 G76";
    case 'K':
      return "K belongs to G2 G3 G33 G33.1 G76";
    case 'L':
      return "L belongs to G5.2 G10 G41.1 G42.1, cycles, M66 and M98";
    case 'P':
      return "P belongs to G2 G3 G4 G5 G5.2 G10 G64 G76, cycles, M19 M50 to M53 M62 to M66 and M98";
    case 'Q':
      return "Q belongs to G5 G10 G64 G73 G76 G83 M19 M61 M66 M67 M68";
    case 'R':
      return "R belongs to G2 G3 G10 G76 M19 and cycles";
    case '$':
      return "$ names a spindle: it belongs to S, M3 M4 M5 M51, G33 G33.1 G76 G96 G97";
    default:
      return "no code that kadr runs reads this letter";
  }
}

/// Letters besides axes, F, S and T that a motion reads. `code`: of the line, of a cycle the one in force.
std::uint32_t letters_of_motion(Motion motion, int code) {
  switch (motion) {
    case Motion::arc_clockwise:
    case Motion::arc_counterclockwise:
      return letter_bits("IJKRP");
    case Motion::cubic_spline:
      return letter_bits("IJPQ");
    case Motion::quadratic_spline:
      return letter_bits("IJ");
    case Motion::nurbs:
      return letter_bits("PL");
    case Motion::thread:
      return letter_bits("KE$");
    case Motion::rigid_tap:
      return letter_bits("KIE$");
    case Motion::thread_cycle:
      return letter_bits("PIJRKQHEL$");
    case Motion::cycle:
      return letters_of_cycle(code);
    case Motion::none:
    case Motion::traverse:
    case Motion::feed:
    case Motion::probe:
      break;
  }
  return 0;
}

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
  check_shared_p();
  if (state_.compensating() || words_.g(GGroup::compensation) != kNoCode) check_compensation();
  return report_.errors() == errors;
}

void Interpreter::check_axes() {
  const std::uint32_t missing = words_.present & kAxisBits & ~axes_on_machine_;
  if (missing == 0) return;
  for (const char letter : kAxisLetters) {
    if ((missing & letter_bit(letter)) == 0) continue;
    Diagnostic d = problem(Code::axis_not_on_machine, words_.span(*line_, letter),
                           fmt::format("this machine has no axis {}", letter));
    d.notes.push_back(fmt::format("axes of the machine: {}", options_.axis_letters));
    error(std::move(d));
  }
}

void Interpreter::check_codes() {
  if (words_.m(MGroup::call) == 98) check_call();
  const int nonmodal_code = words_.g(GGroup::nonmodal);
  const int motion_code = words_.g(GGroup::motion);
  const bool takes_axes = axis_words_taken();
  const bool names_motion = motion_code != kNoCode && motion_code != 800;
  if (takes_axes) check_axis_words();
  if (words_.has_axis() && !takes_axes && !names_motion && !state_.uncertain.motion &&
      (motion_code == 800 || state_.motion == Motion::none)) {
    error(problem(
        Code::axis_words_without_motion, words_.motion_span(*line_),
        motion_code == 800 ? "G80 on this line has ended every motion" : "no motion code is in force here",
        "write G0, G1, G2 or G3 before the first axis words"));
    state_.uncertain.motion = true;
  }
  if (nonmodal_code == 530) {
    const Motion motion = motion_of_line();
    const bool line_motion = moves() && (motion == Motion::traverse || motion == Motion::feed);
    const bool incremental =
        words_.g(GGroup::distance) != kNoCode ? words_.g(GGroup::distance) == 910 : state_.incremental;
    if (!state_.uncertain.motion && (!line_motion || incremental)) {
      error(problem(
          Code::g53_misplaced, g_span(GGroup::nonmodal),
          incremental ? "G53 in G91: machine coordinates are absolute" : "G53 works with G0 and G1 only",
          "write it as G90 G53 G0 ... or G90 G53 G1 ..."));
    }
  }
}

void Interpreter::check_call() {
  const Span span = words_.span(*line_, MGroup::call);
  if (!words_.has('P')) {
    error(problem(Code::word_missing, span, "M98 needs P: the number of the subroutine"));
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
      return check_thread(330);
    case Motion::rigid_tap:
      return check_thread(331);
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
  const int motion_code = words_.g(GGroup::motion);
  if (moves()) {
    const bool cycle_goes_on = motion_code == kNoCode && state_.motion == Motion::cycle;
    letters |= letters_of_motion(motion_of_line(), cycle_goes_on ? state_.cycle.code : motion_code);
  }
  switch (words_.g(GGroup::nonmodal)) {
    case 40:
      letters |= letter_bit('P');
      break;
    case 100:
      letters |= letter_bits("LPRQIJ");
      break;
    default:
      break;
  }
  if (words_.g(GGroup::path) == 640) letters |= letter_bits("PQ");
  const int length = words_.g(GGroup::tool_length);
  if (length == 430 || length == 432) letters |= letter_bit('H');
  switch (words_.g(GGroup::compensation)) {
    case 410:
    case 420:
    case 411:
    case 421:
      letters |= letter_bits("DL");
      break;
    default:
      break;
  }
  const int mode = words_.g(GGroup::spindle_mode);
  if (mode == 960) letters |= letter_bit('D');
  if (mode != kNoCode || words_.has('S') || words_.m(MGroup::spindle) != kNoCode) letters |= letter_bit('$');
  if (words_.m(MGroup::spindle) == 19) letters |= letter_bits("RPQ");
  const int override_code = words_.m(MGroup::overrides);
  if (override_code >= 50) letters |= letter_bit('P');
  if (override_code == 51) letters |= letter_bit('$');
  switch (words_.m(MGroup::inputs)) {
    case kNoCode:
      break;
    case 66:
      letters |= letter_bits("PELQ");
      break;
    case 67:
    case 68:
      letters |= letter_bits("EQ");
      break;
    default:
      letters |= letter_bit('P');
      break;
  }
  if (words_.m(MGroup::tool_change) == 61) letters |= letter_bit('Q');
  if (words_.m(MGroup::call) == 98) letters |= letter_bits("PL");
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
    case 40:
      if (!require_word('P', GGroup::nonmodal, "the seconds to wait")) break;
      if (words_.value('P') < 0) {
        error(problem(Code::word_out_of_range, words_.span(*line_, 'P'),
                      fmt::format("dwell of {} s, allowed 0 and above", figure(words_.value('P')))));
      }
      break;
    case 100:
      check_g10();
      break;
    default:
      break;
  }
  if (moves() && is_arc(motion_of_line())) check_whole('P', 1, kLargestTurns);
  if (words_.g(GGroup::spindle_mode) == 960) require_word('S', GGroup::spindle_mode, "the surface speed");
  if (words_.g(GGroup::spindle_mode) != kNoCode) check_whole('$', 0, 0);
  if (moves() && motion_of_line() == Motion::nurbs) check_whole('L', 0, kLargestOrder);
  if (words_.g(GGroup::path) == 640 && words_.has('P') && words_.value('P') < 0) {
    error(problem(Code::word_out_of_range, words_.span(*line_, 'P'), "a tolerance below 0"));
  }
  if (words_.m(MGroup::call) == 98) {
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
  const int users = (code == 40 || code == 100 ? 1 : 0) + (words_.g(GGroup::path) == 640 ? 1 : 0) +
                    (override_code == 50 || override_code == 51 ? 1 : 0) +
                    (motion_code == 20 || motion_code == 30 ? 1 : 0);
  if (users < 2) return;
  report_.warning(problem(Code::word_shared, words_.span(*line_, 'P'),
                          fmt::format("{} codes on this line read this P", users),
                          "write them on separate lines"));
}

}  // namespace kadr::gcode
