#include "gcode/interpret/owner_codes.h"

#include <fmt/format.h>

#include <algorithm>

#include "gcode/interpret/interpreter.h"
#include "gcode/interpret/letters.h"

/// G and M codes of the machine's owner, and values that the machine gives.
namespace kadr::gcode {
namespace {

constexpr std::uint32_t kSettingLetters = letter_bits("FST");
constexpr double kWeightOfSetting =
    100;  // which words are told of many lines: those that could set something

bool is_g(const Words::OwnerUse& use) { return use.entry->code.letter == 'G'; }
bool calls(const Words::OwnerUse& use) { return use.entry->own != nullptr && !use.entry->own->call.empty(); }

/// LinuxCNC asks for names in capitals: others of an INI file are never found.
bool in_capitals(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

}  // namespace

void Interpreter::take_machine_values() {
  for (const HalValue& value : options_.hal)
    set_named(state_, state_.names.number("_hal[" + value.name + "]"), value.value);
  if (!options_.ini) return;
  state_.ini = &*options_.ini;
  for (const IniValue& value : options_.ini->values) {
    if (!in_capitals(value.section) || !in_capitals(value.name)) continue;
    const std::int32_t name = state_.names.number("_ini[" + value.section + "]" + value.name);
    const std::optional<double> number = ini_number(value.text);
    if (number && find_named(state_, name) == nullptr) set_named(state_, name, *number);
  }
}

/// The letters that belong to the line's codes of the owner: all that no other code reads. F, S and T are theirs where
/// they stand without any other code or motion, axis words where a G code stands without another that takes them.
std::uint32_t Interpreter::owner_letters() const {
  const auto none = [](const auto& codes) {
    return std::all_of(codes.begin(), codes.end(), [](int code) { return code == kNoCode; });
  };
  const auto& uses = words_.owner_codes();
  const bool takes_axes = std::any_of(uses.begin(), uses.end(), is_g) &&
                          words_.g(GGroup::motion) == kNoCode && !axis_words_taken();
  const std::uint32_t axes = takes_axes ? words_.present & kAxisBits : 0;
  const bool alone = none(words_.g_codes()) && none(words_.m_codes()) && (takes_axes || !words_.has_axis());
  const bool tool_change = std::any_of(uses.begin(), uses.end(), [](const Words::OwnerUse& use) {
    return use.entry->code == machine::CodeName{'M', code::m6, {}};
  });
  std::uint32_t usable = usable_letters();
  if (takes_axes) usable &= ~axes;
  if (alone && !tool_change) usable &= ~kSettingLetters;
  return words_.present & ~usable;
}

void Interpreter::take_owner_words() {
  owner_words_.clear();
  const std::uint32_t letters = owner_letters();
  for (const char letter : kWordLetters) {
    if ((letters & letter_bit(letter)) == 0) continue;
    owner_words_.emplace_back(letter, words_.value(letter));
    words_.remove(letter);
  }
}

void Interpreter::check_owner_call() {
  const auto& uses = words_.owner_codes();
  const auto call = std::find_if(uses.begin(), uses.end(), calls);
  if (call == uses.end()) return;
  const auto any = [](const auto& codes) {
    return std::any_of(codes.begin(), codes.end(), [](int code) { return code != kNoCode; });
  };
  const bool more = uses.size() > 1 || any(words_.g_codes()) || any(words_.m_codes()) ||
                    (words_.present & ~kSettingLetters) != 0;
  if (!more) return;
  error(problem(Code::owner_code_line, line_->span(line_->items[call->item].bytes),
                fmt::format("{} runs O<{}>", machine::code_text(call->entry->code), call->entry->own->call),
                "write the other codes and motion on lines of their own"));
}

void Interpreter::owner_codes() {
  for (const Words::OwnerUse& use : words_.owner_codes()) {
    const Span span = line_->span(line_->items[use.item].bytes);
    if (use.entry->own != nullptr) {
      run_owner_code(*use.entry->own, span);
      continue;
    }
    const std::string name = machine::code_text(use.entry->code);
    std::string words;
    double weight = 0;
    for (const auto& [letter, value] : owner_words_) {
      words += fmt::format(" {}{}", letter, figure(value));
      weight += (kSettingLetters & letter_bit(letter)) != 0 ? kWeightOfSetting : 1;
    }
    if (!words.empty()) words = " with" + words;
    report_.repeated_warning(
        problem(Code::code_passed_over, span, fmt::format("{}{}: it changes nothing here", name, words)),
        weight, words.empty() ? std::string() : fmt::format("on line {}{}", line_->number, words), name);
  }
}

void Interpreter::run_owner_code(const machine::OwnerCode& own, Span span) {
  if (!own.call.empty()) {
    // a word that depends on an earlier error leads nowhere that could be judged
    if (words_.doubtful != 0) return lose_track();
    CallRequest request;
    request.place = span;
    request.owner = &own;
    request.words = owner_words_;
    call_ = std::move(request);
    return;
  }
  if (own.output >= 0) emit(span, DigitalOutput{own.output, own.on, !own.stop});
  if (own.stop && (own.time_s > 0 || own.output < 0)) emit(span, Dwell{own.time_s, true});
}

/// Behind an M code that kadr runs itself, the time that it takes on this machine.
void Interpreter::take_time(int code, Span span) {
  const double time_s = owner_table_.empty() ? 0 : owner_table_.time_s(code);
  if (time_s > 0) emit(span, Dwell{time_s, true});
}

}  // namespace kadr::gcode
