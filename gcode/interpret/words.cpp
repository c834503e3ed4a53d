#include "gcode/interpret/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/interpret/macro_variables.h"
#include "gcode/interpret/predefined.h"
#include "gcode/read/scanner.h"

namespace kadr::gcode {
namespace {

constexpr double kCodeTolerance = 1e-3;  // in tenths of a G number
constexpr double kTenths = 10;
constexpr double kLargestCode = 1e5;
constexpr double kLargestWord = 1e9;  // mm, deg, rpm ...: far beyond any machine, far below a step overflow
constexpr std::uint32_t kMotionBits = kAxisBits | letter_bits("IJKRP");

bool refuse(Report* report, Code code, Span span, std::string label, std::string help = {}) {
  if (report != nullptr) report->error(problem(code, span, std::move(label), std::move(help)));
  return false;
}

/// Least increments that make 1 of a letter's unit: 0.001 mm or degree, 0.0001 inch; 1 for numbers without unit.
double steps_of(char letter, bool inches) {
  constexpr std::uint32_t kLengths = kAxisBits | letter_bits("IJKRQ");
  if ((letter_bit(letter) & kLengths) == 0) return 1;
  return inches && !is_rotary_letter(letter) ? 1e4 : 1e3;
}

/// @param name  of the code; empty: it is no number that a code can have
bool refuse_code(Report* report, Code code, Span span, const std::string& label, const std::string& name) {
  if (name.empty()) return refuse(report, code, span, label);
  if (report == nullptr) return false;
  // G codes that LinuxCNC runs and kadr does not may move: nobody is led to pass them over
  const bool may_be_own = code == Code::unknown_code || name.front() == 'M';
  report->repeated_error(
      problem(code, span, label,
              may_be_own
                  ? fmt::format("if {0} is one of your machine's own that moves nothing: --ignore {0}, or "
                                "[codes] of the machine file",
                                name)
                  : std::string()),
      name);
  return false;
}

/// "G92.1" of 921, "M3" of 3
std::string code_text(char letter, int number) {
  return letter == 'G' ? g_name(number) : fmt::format("{}{}", letter, number);
}

}  // namespace

std::string g_name(int tenths) {
  return tenths % 10 == 0 ? fmt::format("G{}", tenths / 10) : fmt::format("G{}.{}", tenths / 10, tenths % 10);
}

bool same_letters(std::string_view text, std::string_view upper_case) {
  return std::equal(text.begin(), text.end(), upper_case.begin(), upper_case.end(),
                    [](char a, char b) { return upper(a) == b; });
}

ActiveComment active_comment(std::string_view comment) {
  comment.remove_prefix(1);
  if (!comment.empty() && comment.back() == ')') comment.remove_suffix(1);
  while (!comment.empty() && is_blank(comment.front())) comment.remove_prefix(1);
  const std::size_t comma = comment.find(',');
  for (const std::string_view alone : {"PROBEOPEN", "PROBECLOSE", "LOGCLOSE"}) {
    const std::string_view head = comment.substr(0, alone.size());
    if (same_letters(head, alone)) return {head, {}};
  }
  // (TECH name = value); a text that only begins like it is an ordinary comment
  const std::string_view tech = comment.substr(0, 4);
  if (same_letters(tech, "TECH") && comment.size() > 5 && is_blank(comment[4]) &&
      comment.find('=') != std::string_view::npos)
    return {tech, comment.substr(5)};
  if (comma == std::string_view::npos) return {};
  const std::string_view command = comment.substr(0, comma);
  for (const std::string_view known :
       {"MSG", "DEBUG", "PRINT", "ABORT", "LOG", "LOGOPEN", "LOGAPPEND", "PY"}) {
    if (same_letters(command, known)) return {command, comment.substr(comma + 1)};
  }
  return {};
}

void Words::clear() {
  present = doubtful = 0;
  any = percent = refused_motion = other_codes_ = false;
  comment = -1;
  settings.clear();
  owner_uses_.clear();
  if (dialect_ != Dialect::linuxcnc) of_dialect.clear();
  evaluator_.begin_line();
  g_.fill(kNoCode);
  m_.fill(kNoCode);
  motion_ = {};
}

bool Words::read(const Line& line, const State& state, Report* report) {
  clear();
  levels_ = &state.levels;
  bool good = true;
  for (std::uint32_t at = 0; at < line.items.size(); ++at) {
    const Item& item = line.items[at];
    switch (item.kind) {
      case ItemKind::word:
        good = read_word(line, at, state, report) && good;
        break;
      case ItemKind::setting:
        good = read_setting(line, item, state, report) && good;
        break;
      case ItemKind::comment:
        good = read_comment(line, at, report) && good;
        break;
      case ItemKind::percent:
        percent = true;
        break;
      case ItemKind::line_comment:
        // Python after a semicolon is the only remark of this form that LinuxCNC runs
        if (report != nullptr && same_letters(line.slice(item.bytes).substr(0, 4), ";PY,"))
          report->warning(
              problem(Code::comment_not_run, line.span(item.bytes), "kadr does not run ;py, statements"));
        break;
      case ItemKind::o_word:
      case ItemKind::control:
      case ItemKind::block_delete:
      case ItemKind::byte_order_mark:
      case ItemKind::unread:
        break;
    }
  }
  return good;
}

bool Words::read_word(const Line& line, std::uint32_t at, const State& state, Report* report) {
  const Item& item = line.items[at];
  double value = item.number;
  any = true;
  bool doubt = false;
  if (item.value >= 0) {
    if (state.macros.on) {
      const int units = g(GGroup::units);
      evaluator_.round_to(steps_of(item.letter, units == kNoCode ? state.inches : units == code::g20));
    }
    const bool known = evaluator_.evaluate(line, item.first, item.value, state, report, value);
    evaluator_.round_to(1);
    if (!known) {
      if (item.letter == 'G') refused_motion = true;
      return false;
    }
    doubt = evaluator_.doubtful();
    // a word with a vacant value does not stand there
    if (state.macros.on && is_vacant(value)) return true;
  }
  if (item.letter == 'G') return read_g(line, at, value, report);
  if (item.letter == 'M') return read_m(line, at, value, report);
  if (item.letter == 'N') return read_line_number(line, at, report);
  const std::size_t letter = index(item.letter);
  const std::uint32_t bit = 1U << letter;
  if ((present & bit) != 0 || !(std::fabs(value) <= kLargestWord)) {
    return refuse_word(line, item, value, report);
  }
  present |= bit;
  if (doubt) doubtful |= bit;
  values_[letter] = value;
  items_[letter] = at;
  if ((bit & kMotionBits) != 0) widen_motion(item.bytes);
  return true;
}

bool Words::refuse_word(const Line& line, const Item& item, double value, Report* report) const {
  if (has(item.letter)) {
    return refuse(report, Code::word_repeated, line.span(item.bytes),
                  fmt::format("a second {} on this line", item.letter));
  }
  return refuse(report, Code::value_too_large, line.span(item.bytes),
                fmt::format("{} is {:.6g}, allowed up to {:.0e}", item.letter, value, kLargestWord));
}

bool Words::read_line_number(const Line& line, std::uint32_t at, Report* report) {
  const bool first = std::all_of(line.items.begin(), line.items.begin() + at, [](const Item& before) {
    return before.kind != ItemKind::word && before.kind != ItemKind::setting;
  });
  const std::string_view text = line.slice(line.items[at].bytes);
  std::size_t behind = 1;
  while (behind < text.size() && is_blank(text[behind])) ++behind;
  if (behind == text.size() || !is_digit(text[behind])) {
    return refuse(report, Code::bad_number, line.span(line.items[at].bytes),
                  "a line number is written in digits");
  }
  if (first) return true;
  return refuse(report, Code::line_number_place, line.span(line.items[at].bytes), "N is not the first word",
                "a line number comes first on its line");
}

bool Words::read_g(const Line& line, std::uint32_t at, double value, Report* report) {
  const Span span = line.span(line.items[at].bytes);
  int tenths = -1;
  if (value >= 0 && value < kLargestCode) {
    const double tenths_value = value * kTenths;
    const auto nearest = static_cast<int>(tenths_value + 0.5);
    if (std::fabs(tenths_value - nearest) <= kCodeTolerance) tenths = nearest;
  }
  if (take_owner_code('G', tenths, at)) return true;
  GCode code;
  if (dialect_ != Dialect::linuxcnc) {
    // G67 has ended the calls of G66 before the line is run
    const bool macros = rules_of(dialect_).macros.on;
    if (tenths == code::g67 && macros) return true;
    if (tenths == code::g66_1 && macros)
      return refuse(report, Code::word_not_run, span, "kadr does not run G66.1: calls before every block");
    bool done = false;
    if (!read_of_dialect(line, at, tenths, done, report)) {
      refused_motion = true;
      return false;
    }
    if (done) return true;
    code = code_of_dialects(tenths);
  }
  if (code.standing == Standing::unknown) code = g_code(tenths);
  if (code.standing != Standing::runs) {
    refused_motion = true;
    if (code.standing == Standing::not_run) {
      return refuse_code(report, Code::word_not_run, span,
                         fmt::format("kadr does not run {}", g_name(tenths)), g_name(tenths));
    }
    return refuse_code(report, Code::unknown_code, span, fmt::format("there is no G code {:.6g}", value),
                       tenths < 0 ? std::string() : g_name(tenths));
  }
  const auto group = static_cast<std::size_t>(code.group);
  if (code.group == GGroup::motion) {
    widen_motion(line.items[at].bytes);
  } else {
    other_codes_ = true;
  }
  if (g_[group] != kNoCode) {
    // G80 with a motion code is the usual safety line of a postprocessor: the motion code wins. Between
    // G5.2 and G5.3 no other motion code is allowed, so G5.3 does not take it.
    const bool harmless = code.group == GGroup::motion && (tenths == 800 || g_[group] == 800) &&
                          tenths != 53 && g_[group] != 53;
    if (!harmless) {
      return refuse(
          report, Code::modal_conflict, span,
          fmt::format("{} and {} exclude each other on one line", g_name(g_[group]), g_name(tenths)));
    }
    if (tenths == 800) return true;
  }
  g_[group] = static_cast<std::int16_t>(tenths);
  g_items_[group] = at;
  return true;
}

/// A code as its dialect has it.
/// @param number  becomes the code that is meant
/// @param done  true: the code has no effect
bool Words::read_of_dialect(const Line& line, std::uint32_t at, int& number, bool& done, Report* report) {
  const Item& item = line.items[at];
  const DialectRules& rules = rules_of(dialect_);
  const DialectCode* row = dialect_code(dialect_, item.letter, number);
  if (row == nullptr) {
    const bool run = item.letter == 'G' ? g_code(number).standing == Standing::runs
                                        : m_code(number).standing == Standing::runs;
    if (!run || has_code(dialect_, item.letter, number)) return true;
    return refuse(report, Code::dialect_refuses, line.span(item.bytes),
                  fmt::format("{} does not have {}", rules.name, code_text(item.letter, number)));
  }
  const bool lathe = std::any_of(line.items.begin(), line.items.end(), [&](const Item& other) {
    return other.kind == ItemKind::word && row->lathe_letters.find(other.letter) != std::string_view::npos;
  });
  if (lathe) {
    return refuse(report, Code::dialect_refuses, line.span(item.bytes),
                  fmt::format("{} with these words is a code of lathes (code system A)",
                              code_text(item.letter, number)),
                  "kadr runs no lathe cycles: let the postprocessor write the passes as moves");
  }
  switch (row->reading) {
    case CodeReading::refused:
      return refuse(report, Code::word_not_run, line.span(item.bytes),
                    fmt::format("kadr does not run {} of {}: {}", code_text(item.letter, number), rules.name,
                                row->what));
    case CodeReading::runs:
      number = row->meant;
      if (row->given_p != 0) of_dialect.push_back({at, row});
      return true;
    case CodeReading::ends_nothing:
    case CodeReading::told:
      break;
  }
  done = other_codes_ = true;
  of_dialect.push_back({at, row});
  return true;
}

bool Words::read_m(const Line& line, std::uint32_t at, double value, Report* report) {
  const Span span = line.span(line.items[at].bytes);
  int number = -1;
  const bool whole = near_integer(value, number);
  if (whole && take_owner_code('M', number, at)) return true;
  if (dialect_ != Dialect::linuxcnc) {
    bool done = false;
    if (!read_of_dialect(line, at, number, done, report)) return false;
    if (done) return true;
  }
  const bool local = number == code::m97 && rules_of(dialect_).macros.local_subs;
  const MCode code = local ? MCode{Standing::runs, MGroup::call} : whole ? m_code(number) : MCode{};
  if (code.standing == Standing::not_run) {
    return refuse_code(report, Code::word_not_run, span, fmt::format("kadr does not run M{}", number),
                       fmt::format("M{}", number));
  }
  if (code.standing == Standing::unknown) {
    return refuse_code(report, Code::unknown_code, span, fmt::format("there is no M code {:.6g}", value),
                       whole && number >= 0 ? fmt::format("M{}", number) : std::string());
  }
  const auto group = static_cast<std::size_t>(code.group);
  if (m_[group] != kNoCode) {
    return refuse(report, Code::modal_conflict, span,
                  fmt::format("M{} and M{} exclude each other on one line", m_[group], number));
  }
  other_codes_ = true;
  m_[group] = static_cast<std::int16_t>(number);
  m_items_[group] = at;
  return true;
}

bool Words::read_setting(const Line& line, const Item& item, const State& state, Report* report) {
  any = true;
  double value = 0;
  if (item.name >= 0) {
    evaluator_.declare(item.name);
    if (!evaluator_.evaluate(line, item.first, item.value, state, report, value)) return false;
    const bool predefined = is_predefined(item.name);
    if (predefined || is_machine_value(state.names[item.name])) {
      return refuse(report, Code::parameter_read_only, line.span({item.bytes.begin, item.equals}),
                    fmt::format("#<{}> tells {}", state.names[item.name],
                                predefined ? "the state of the controller" : "a value of the machine"));
    }
    settings.push_back({0, item.name, value});
    return true;
  }
  double number = 0;
  if (!evaluator_.evaluate(line, item.first, item.target, state, report, number)) return false;
  if (!evaluator_.evaluate(line, item.target + 1, item.value, state, report, value)) return false;
  const Span span = line.span({item.bytes.begin, item.equals});
  int parameter_number = 0;
  if (state.macros.on && near_integer(number, parameter_number)) {
    settings.push_back({parameter_number, -1, value});
    return true;
  }
  if (!near_integer(number, parameter_number) || parameter_number < parameter::kFirst ||
      parameter_number > parameter::kLast) {
    return refuse(report, Code::parameter_range, span,
                  fmt::format("parameter {}, allowed: whole numbers from {} to {}", number, parameter::kFirst,
                              parameter::kLast));
  }
  if (parameter::is_read_only(parameter_number)) {
    return refuse(
        report, Code::parameter_read_only, span,
        fmt::format("parameters {}, {} to {}, {} to {}, {} to {} and {} to {} hold work system, tool "
                    "and position",
                    parameter::kWorkSystem, parameter::kToolNumber, parameter::kToolLast,
                    parameter::kPosition, parameter::kPositionLast, parameter::kMachine,
                    parameter::kMachineLast, parameter::kApplied, parameter::kAppliedLast));
  }
  settings.push_back({parameter_number, -1, value});
  return true;
}

bool Words::read_comment(const Line& line, std::uint32_t at, Report* report) {
  const auto warn = [&](const Item& item, std::string label) {
    if (report == nullptr) return;
    report->warning(problem(Code::comment_not_run, line.span(item.bytes), std::move(label)));
  };
  if (comment >= 0) {
    const Item& before = line.items[static_cast<std::size_t>(comment)];
    if (!active_comment(line.slice(before.bytes)).command.empty()) {
      warn(before, "only the last comment of a line is active");
    }
  }
  comment = static_cast<int>(at);
  const std::string_view command = active_comment(line.slice(line.items[at].bytes)).command;
  if (!command.empty() && !same_letters(command, "MSG") && !same_letters(command, "DEBUG") &&
      !same_letters(command, "PRINT") && !same_letters(command, "ABORT") && !same_letters(command, "TECH")) {
    warn(line.items[at], fmt::format("kadr does not run ({}, ...)", command));
  }
  return true;
}

/// A code of the owner, but for one that the subroutine of this code names: that is the code itself.
bool Words::take_owner_code(char letter, int number, std::uint32_t at) {
  const OwnerTable::Entry* entry = owner_->empty() ? nullptr : owner_->find(letter, number);
  if (entry == nullptr) return false;
  const bool inside = entry->own != nullptr && !entry->own->call.empty() &&
                      std::any_of(levels_->begin(), levels_->end(),
                                  [&](const CallLevel& level) { return level.code == entry->code; });
  if (inside) return false;
  other_codes_ = true;
  owner_uses_.push_back({entry, at});
  return true;
}

void Words::widen_motion(Bytes bytes) {
  if (motion_.end == 0) {
    motion_ = bytes;
    return;
  }
  motion_.begin = std::min(motion_.begin, bytes.begin);
  motion_.end = std::max(motion_.end, bytes.end);
}

}  // namespace kadr::gcode
