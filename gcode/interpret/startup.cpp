#include <fmt/format.h>

#include <algorithm>

#include "gcode/interpret/interpreter.h"
#include "gcode/measure.h"
#include "gcode/read/parser.h"

/// What holds before the first line, what a program leaves unsaid, and words that kadr reads without effect.
namespace kadr::gcode {
namespace {

constexpr std::string_view kStartupLetters = "GFSPQD";

/// The groups whose codes do more than set a mode, but for those that end one.
constexpr GGroup kActing[] = {GGroup::nonmodal, GGroup::motion, GGroup::compensation, GGroup::tool_length};
bool sets_mode(int code) {
  return code <= code::g3 || code == code::g80 || code == code::g40 || code == code::g49;
}

}  // namespace

void Interpreter::begin(SourceSet& sources) {
  owner_table_.check(options_.dialect, report_);
  if (options_.startup.empty()) return;
  SourceText text("startup", options_.startup);
  Line line;
  line.file = static_cast<std::uint32_t>(sources.size());
  line.number = 1;
  line.text = text.text();
  const std::size_t found = report_.found();
  Parser(state_.names, report_, options_.dialect).parse(line);
  silent_ = true;
  if (!line.failed && startup_allowed(line)) run(line);
  silent_ = started_ = worded_ = false;
  // places of messages point into it
  if (report_.found() != found) sources.add(std::move(text));
}

bool Interpreter::startup_allowed(const Line& line) {
  const std::size_t errors = report_.errors();
  const auto refuse = [&](const Item& item) {
    error(problem(Code::startup_word, line.span(item.bytes),
                  fmt::format("{} sets no mode", line.slice(item.bytes)),
                  "allowed: G codes that set a mode, F, S and what they read"));
  };
  if (!words_.read(line, state_, &report_)) return false;
  for (const Item& item : line.items) {
    const bool word =
        item.kind == ItemKind::word && kStartupLetters.find(item.letter) != std::string_view::npos;
    if (!word) refuse(item);
  }
  for (const GGroup group : kActing) {
    if (words_.g(group) == kNoCode || sets_mode(words_.g(group))) continue;
    error(problem(Code::startup_word, words_.span(line, group),
                  fmt::format("{} sets no mode", g_name(words_.g(group))),
                  "allowed: G codes that set a mode, F, S and what they read"));
  }
  return report_.errors() == errors;
}

/// The words of the line that are lengths.
std::uint32_t Interpreter::length_words() const {
  const bool arc = is_arc(motion_of_line()) && moves();
  std::uint32_t lengths = letter_bits(arc ? "XYZUVW@IJKR" : "XYZUVW@");
  const auto add = [&](bool reads, char letter) {
    if (reads) lengths |= letter_bit(letter);
  };
  const int compensation = words_.g(GGroup::compensation);
  add(words_.g(GGroup::path) == code::g64, 'P');
  add(compensation == code::g41_1 || compensation == code::g42_1, 'D');
  add(words_.g(GGroup::nonmodal) == code::g10 && words_.has('L') && words_.value('L') != 2 &&
          words_.value('L') != 20,
      'R');
  return lengths & words_.present;
}

/// Keeps the first length of a program that has not said its units.
void Interpreter::note_length() {
  if (words_.g(GGroup::units) != kNoCode) return;  // taken with the line
  const std::uint32_t lengths = length_words();
  if ((lengths & kAxisBits & ~axes_on_machine_) != 0) return;
  for (const char letter : kWordLetters) {
    if ((lengths & letter_bit(letter)) == 0 || words_.value(letter) == 0) continue;
    length_ = words_.span(*line_, letter);
    length_text_ = fmt::format("{0}{1} is taken as {1} mm", letter, figure(words_.value(letter)));
    units_pending_ = false;
    return;
  }
}

void Interpreter::tell_units() {
  if (length_.line == 0 || report_.errors() > 0) return;
  Diagnostic d = problem(
      Code::units_unsaid, length_, length_text_,
      "write G20 (inches) or G21 (mm) before it; or say units = \"inch\" or \"mm\" in the machine file");
  if (!units_later_.empty()) d.notes.push_back(units_later_);
  report_.warning(std::move(d));
}

/// G28.1, G92.1 and G4 read no axis words: those of their line belong to the motion in force.
void Interpreter::warn_axis_words_move() {
  if (!words_.has_axis() || words_.g(GGroup::motion) != kNoCode || !moves() || state_.uncertain.motion)
    return;
  const int code = words_.g(GGroup::nonmodal);
  const bool beside = code == code::g28_1 || code == code::g30_1 || code == code::g4;
  const GGroup group = beside ? GGroup::nonmodal : GGroup::g92_state;
  if (words_.g(group) == kNoCode) return;
  report_.warning(problem(Code::axis_words_move, words_.motion_span(*line_),
                          fmt::format("{} does not read them: {} moves there", g_name(words_.g(group)),
                                      g_name(motion_code(state_))),
                          "write the motion on a line of its own"));
}

void Interpreter::warn_without_effect() {
  const auto warn = [&](Span span, std::string label) {
    report_.warning(problem(Code::word_without_effect, span, std::move(label)));
  };
  if (words_.g(GGroup::path) == code::g64 && words_.has('Q') && words_.value('Q') > 0) {
    Diagnostic d = problem(Code::word_without_effect, words_.span(*line_, 'Q'),
                           "kadr joins no moves: the tolerance of Q changes nothing");
    const std::string most =
        fmt::format("the largest is {}, on line {}", figure(words_.value('Q')), d.span.line);
    report_.repeated_warning(std::move(d), words_.value('Q'), most);
  }
  const int code = words_.m(MGroup::overrides);
  const bool zero = words_.has('P') && words_.value('P') == 0;
  const Span span = code == kNoCode ? Span{} : words_.span(*line_, MGroup::overrides);
  if (code == code::m52 && !zero) warn(span, "kadr has no input that lowers the feed");
  if (code == code::m53 && zero) warn(span, "a feed hold of the operator acts all the same");
}

}  // namespace kadr::gcode
