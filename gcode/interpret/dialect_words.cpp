#include <fmt/format.h>

#include "gcode/interpret/interpreter.h"

/// Words that a dialect reads otherwise become those of LinuxCNC, before the line is checked.
namespace kadr::gcode {
namespace {

bool reads_p(int code) {
  return code == code::g74 || code == code::g82 || code == code::g84 || code == code::g86 ||
         code == code::g89;
}

}  // namespace

/// @return false if an error was reported
bool Interpreter::take_dialect_words() {
  const std::size_t errors = report_.errors();
  // G31 holds for its line
  if (state_.motion == Motion::probe && state_.probe_code == code::g31) state_.motion = state_.group_1;
  if (!words_.of_dialect.empty()) take_codes_of_dialect();
  if (rules_.keeps_group_1 && words_.g(GGroup::motion) == code::g80) end_cycle();
  if (words_.g(GGroup::nonmodal) == code::g4) take_dwell_words();
  if (motion_of_line() == Motion::cycle && moves()) take_cycle_words();
  if (rules_.radius_in_p) take_radius();
  if (rules_.text.corners) take_corner_word();
  if (rules_.extruder) take_extruder();
  if (rules_.further_systems > 0) take_further_offset();
  if (options_.dialect == Dialect::grbl && !line_->failed) check_dialect_words();
  return report_.errors() == errors;
}

/// Codes without effect take their words along, and are told once each.
void Interpreter::take_codes_of_dialect() {
  for (const Words::OfDialect& found : words_.of_dialect) {
    const DialectCode& row = *found.code;
    const Item& item = line_->items[found.item];
    if (row.given_p != 0) {
      words_.put('P', found.item, row.given_p);
      continue;
    }
    if (row.letters == "*") {
      words_.present = 0;
    } else {
      words_.present &= ~letter_bits(row.letters);
    }
    if (row.reading != CodeReading::told || silent_ || line_->failed) continue;
    const std::string name(line_->slice(item.bytes));
    report_.repeated_note(problem(Code::word_told, line_->span(item.bytes),
                                  fmt::format("{} of {} {}", name, rules_.name, row.what)),
                          name);
  }
}

/// G80 where cycles are a group of their own: G0 to G3 of before hold again.
void Interpreter::end_cycle() {
  words_.set(GGroup::motion, kNoCode);
  state_.motion = state_.group_1;
  state_.cycle.in_sequence = false;
}

/// Seconds that 1 of the word means: of some dialects a decimal point says seconds.
double Interpreter::dwell_unit_s(char letter, double unit_s) const {
  if (!rules_.point_means_seconds) return unit_s;
  const std::string_view text = line_->slice(words_.item(*line_, letter).bytes);
  return text.find('.') == std::string_view::npos ? unit_s : 1;
}

/// The words of a G4 become P in seconds.
void Interpreter::take_dwell_words() {
  char counts = 0;
  for (const DwellWord& word : rules_.dwell_words) {
    if (!words_.has(word.letter)) continue;
    if (counts != 0) {
      report_.warning(problem(Code::word_without_effect, words_.span(*line_, word.letter),
                              fmt::format("{} counts alone", counts), "write one of them"));
    } else {
      counts = word.letter;
    }
  }
  if (counts == 0) return;
  double dwell_s = 0;
  for (const DwellWord& word : rules_.dwell_words) {
    if (!words_.has(word.letter)) continue;
    if (word.letter == counts) {
      dwell_s = words_.value(word.letter) * dwell_unit_s(word.letter, word.unit_s);
      words_.stand_in('P', word.letter);
    }
    if (word.letter != 'P') words_.remove(word.letter);
  }
  words_.set('P', dwell_s);
}

/// P of cycles becomes seconds, K is L.
void Interpreter::take_cycle_words() {
  const int named = words_.g(GGroup::motion);
  const int code = named == kNoCode ? state_.cycle.code : named;
  if (words_.has('P') && reads_p(code) && words_.g(GGroup::nonmodal) != code::g4)
    words_.set('P', words_.value('P') * dwell_unit_s('P', rules_.cycle_dwell_s));
  if (named != kNoCode) state_.cycle.tap_peck = 0;
  if (rules_.taps_peck && words_.has('Q') && (code == code::g74 || code == code::g84)) {
    state_.cycle.tap_peck = words_.value('Q');
    words_.remove('Q');
    if (!(state_.cycle.tap_peck > 0)) {
      error(problem(Code::word_out_of_range, words_.span(*line_, 'Q'),
                    fmt::format("a peck of {}, allowed above 0", figure(state_.cycle.tap_peck))));
    }
  }
  if (rules_.repeats_in_k && words_.has('K') && !words_.has('L')) {
    const double repeats = words_.value('K');
    words_.stand_in('L', 'K');
    words_.set('L', repeats);
    words_.remove('K');
  }
}

/// G41 P: the radius, where LinuxCNC has G41.1 D: the diameter.
void Interpreter::take_radius() {
  const int code = words_.g(GGroup::compensation);
  if ((code != code::g41 && code != code::g42) || !words_.has('P') || words_.has('D')) return;
  const double radius = words_.value('P');
  words_.stand_in('D', 'P');
  words_.set('D', 2 * radius);
  words_.remove('P');
  words_.set(GGroup::compensation, code == code::g41 ? code::g41_1 : code::g42_1);
}

/// G54.1 P, and G10 L20 P, which writes its offset.
void Interpreter::take_further_offset() {
  int l = 0, p = 0;
  const bool names = words_.g(GGroup::coordinate_system) == code::g54_1;
  const bool writes = words_.g(GGroup::nonmodal) == code::g10 && words_.has('L') &&
                      near_integer(words_.value('L'), l) && l == 20;
  if (!names && !writes) return;
  if (!words_.has('P')) {
    error(problem(Code::word_missing, g_span(names ? GGroup::coordinate_system : GGroup::nonmodal),
                  fmt::format("P is missing: the work system, 1 to {}", rules_.further_systems)));
    return;
  }
  if (!check_whole('P', 1, rules_.further_systems) || !writes) return;
  near_integer(words_.value('P'), p);
  words_.set('L', 2);
  words_.set('P', kWorkSystems + p);
}

/// G92 E0 sets the filament alone. E of a move is told by other_kind().
void Interpreter::take_extruder() {
  if (!words_.has('E') || words_.g(GGroup::nonmodal) != code::g92) return;
  const Span span = words_.span(*line_, 'E');
  if (!silent_ && !line_->failed)
    report_.repeated_note(
        problem(Code::word_told, span, "E of G92 concerns the filament; kadr has no extruder"), "E");
  words_.remove('E');
  if (!words_.has_axis()) words_.set(GGroup::nonmodal, kNoCode);
}

/// What Grbl 1.1 answers with an error though LinuxCNC runs it.
void Interpreter::check_dialect_words() {
  const auto refuse = [&](Span span, std::string what, std::string help = {}) {
    error(problem(Code::dialect_refuses, span, std::move(what), std::move(help)));
  };
  for (const char letter : std::string_view("DEHQ@^$"))
    if (words_.has(letter))
      refuse(words_.span(*line_, letter), fmt::format("{} does not have the letter {}", rules_.name, letter));
  if (words_.has('T') && words_.value('T') > rules_.largest_tool)
    refuse(words_.span(*line_, 'T'),
           fmt::format("{} knows tools up to {}", rules_.name, rules_.largest_tool));
  if (words_.g(GGroup::tool_length) == code::g43_1 && ((words_.present & kAxisBits) != letter_bit('Z')))
    refuse(g_span(GGroup::tool_length), fmt::format("G43.1 of {} takes Z and no other axis", rules_.name));
  if (words_.g(GGroup::nonmodal) == code::g10) {
    const double l = words_.has('L') ? words_.value('L') : 0;
    if (l != 2 && l != 20)
      refuse(g_span(GGroup::nonmodal), fmt::format("{} has G10 L2 and L20", rules_.name));
    if (words_.has('R'))
      refuse(words_.span(*line_, 'R'), fmt::format("{} turns no work system", rules_.name));
    if (words_.has('P') && words_.value('P') > 6)
      refuse(words_.span(*line_, 'P'), fmt::format("{} has the work systems 1 to 6", rules_.name));
  }
  const bool arc = is_arc(motion_of_line()) && moves();
  if (arc && words_.has('P'))
    refuse(words_.span(*line_, 'P'), fmt::format("an arc of {} makes one turn", rules_.name));
  const PlaneAxes plane = plane_axes(plane_of_line());
  const auto has_axis = [&](int axis) { return words_.has(kAxisLetters[static_cast<std::size_t>(axis)]); };
  if (arc && !has_axis(plane.first) && !has_axis(plane.second))
    refuse(action_span(), fmt::format("an arc of {} names its end in the plane", rules_.name),
           "write X and Y of the start for a whole circle");
}

}  // namespace kadr::gcode
