#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gcode/flow/flow.h"
#include "gcode/interpret/macro_variables.h"

namespace kadr::gcode {
namespace {

Program::Position behind(const Structure& structure, int statement) { return structure[statement].after; }

}  // namespace

std::string Flow::label_text(std::int32_t name) const {
  const std::string& text = state_.names[name];
  const bool digits = std::all_of(text.begin(), text.end(), is_digit);
  return digits ? "O" + text : "O<" + text + ">";
}

void Flow::call_statement(const Line& line) {
  const FlowStatement& flow = line.flow;
  const Span place = line.span({flow.label.begin, flow.keyword.end});
  std::int32_t name = flow.name;
  if (name < 0) {
    double label = 0;
    int number = 0;
    if (!value(line, flow.label_first, flow.label_root, label)) return interpreter_.lose_track();
    if (!near_integer(label, number) || number < 0) {
      interpreter_.lose_track();
      return error(problem(Code::o_label_missing, place, fmt::format("the label is {}", figure(label)),
                           "a label is a whole number, 0 or above"));
    }
    name = state_.names.number(std::to_string(number));
  }
  std::vector<double> arguments;
  std::int32_t first = flow.first;
  for (const std::int32_t root : flow.arguments) {
    double argument = 0;
    const bool doubtful = !value(line, first, root, argument);
    if (doubtful) return interpreter_.lose_track();
    arguments.push_back(argument);
    first = root + 1;
  }
  const Target target = find(name, false, place);
  if (target.unit == nullptr || !enter(target, CallKind::o_word, place, arguments)) interpreter_.lose_track();
}

void Flow::call_code(const CallRequest& request) {
  if (request.returns) return return_code(request);
  if (request.owner != nullptr) return call_owner(request);
  if (request.repeats == 0) return;
  if (request.to_line) return call_line(request);
  const Target target = find(state_.names.number(std::to_string(request.number)), true, request.place);
  const CallKind kind = request.macro ? CallKind::macro : CallKind::code;
  if (target.unit == nullptr || !enter(target, kind, request.place, request.arguments))
    return interpreter_.lose_track();
  calls_.back().repeats_left = request.repeats - 1;
}

/// The subroutine of an owner's code; it reads the words of the line as #<p>, #<q>, ...
void Flow::call_owner(const CallRequest& request) {
  const Target target = find(state_.names.number(request.owner->call), false, request.place);
  if (target.unit == nullptr || !enter(target, CallKind::o_word, request.place, {}))
    return interpreter_.lose_track();
  state_.levels.back().code = request.owner->code;
  for (const auto& [letter, value] : request.words)
    set_named(state_, state_.names.number(std::string_view(&letter, 1)), value);
}

void Flow::make_known(Unit& unit) {
  for (const auto& [name, statement] : unit.structure.subs())
    subs_.try_emplace(name, Target{&unit, statement, behind(unit.structure, statement)});
  for (const auto& [name, statement] : unit.structure.labels())
    labels_.try_emplace(name, Target{&unit, statement, behind(unit.structure, statement)});
}

Flow::Target Flow::find_known(std::int32_t name, bool by_code) const {
  // the calling file first, then all others in the order in which they were read
  const int here = by_code ? unit_->structure.label(name) : unit_->structure.sub(name);
  if (here >= 0) return {unit_, here, behind(unit_->structure, here)};
  const auto& known = by_code ? labels_ : subs_;
  const auto it = known.find(name);
  return it == known.end() ? Target{} : it->second;
}

Flow::Target Flow::find(std::int32_t name, bool by_code, Span place) {
  Target target = find_known(name, by_code);
  if (target.unit != nullptr) {
    warn_other_file(target, name, place);
    return target;
  }
  if (find_known(name, !by_code).unit != nullptr) {
    error(problem(Code::sub_kind, place,
                  by_code ? fmt::format("{} is a sub ... endsub", label_text(name))
                          : fmt::format("{} ends with M99", label_text(name)),
                  by_code ? fmt::format("write {} call", label_text(name))
                          : fmt::format("write M98 P{}", state_.names[name])));
    return {};
  }
  if (!load(name, place)) return {};
  target = find_known(name, by_code);
  if (target.unit != nullptr) return target;
  error(problem(Code::sub_file, place,
                fmt::format("{} does not hold {}{}", sources_[units_.back()->program.file()].name(),
                            label_text(name), by_code ? " for M98" : " sub"),
                "a called file must contain the subroutine of its own name"));
  return {};
}

/// LinuxCNC finds a subroutine in the main program or in the file of its own name.
void Flow::warn_other_file(const Target& target, std::int32_t name, Span place) {
  const bool its_own = target.unit->name.empty() || target.unit->name == state_.names[name];
  if (its_own || rules_of(options_.dialect).finds_subs_of_other_files) return;
  const std::string& file = sources_[target.unit->program.file()].name();
  report_.warning(
      problem(Code::sub_of_other_file, place,
              fmt::format("{} stands in {}, where LinuxCNC does not find it", label_text(name), file),
              fmt::format("move it to {}.ngc, or into the program", state_.names[name])));
}

/// A dialect with macro B has subprograms in files like O1001.nc or O0001.
FoundText Flow::find_text(const std::string& name) const {
  FoundText first = called_.find(name);
  const bool number = !name.empty() && name.size() <= 5 && std::all_of(name.begin(), name.end(), is_digit);
  if (!macros_ || !number || first.text || !first.refusal.empty()) return first;
  for (const std::size_t digits : {std::size_t{4}, std::size_t{5}}) {
    const std::string padded = std::string(digits - std::min(digits, name.size()), '0') + name;
    for (const char* head : {"O", "o", ""}) {
      FoundText found = called_.find(head + padded);
      if (found.text || !found.refusal.empty()) return found;
      if (digits == 4 && head[0] == 'O') first.looked = found.looked;
    }
  }
  return first;
}

bool Flow::load(std::int32_t name, Span place) {
  const std::string& text = state_.names[name];
  const auto loaded =
      std::find_if(units_.begin(), units_.end(), [&](const auto& u) { return u->name == text; });
  if (loaded != units_.end()) return false;  // already reported
  // folders are asked once for each name
  const auto [known, is_new] = unusable_.try_emplace(name);
  FoundText& found = known->second;
  if (is_new) found = find_text(text);
  if (!found.refusal.empty()) {
    const Code code = found.too_large ? Code::file_too_large : Code::sub_file;
    error(problem(code, place, found.refusal, found.help));
    return false;
  }
  if (!found.text) {
    Diagnostic d = problem(Code::sub_not_found, place, fmt::format("there is no {}", label_text(name)));
    d.notes.push_back(found.looked);
    d.help = "name the folder that holds it: --subs FOLDER";
    error(std::move(d));
    return false;
  }
  const std::uint32_t index = sources_.add(std::move(*found.text));
  unusable_.erase(known);
  return readable(index) && add_unit(index, text);
}

bool Flow::enter(Target target, CallKind kind, Span place, const std::vector<double>& arguments) {
  const std::uint32_t most = options_.bounds.call_depth;
  if (most != 0 && calls_.size() >= most) {
    Diagnostic d = problem(Code::calls_too_deep, place, fmt::format("{} calls deep", calls_.size() + 1),
                           "a subroutine that calls itself needs a condition that ends it");
    d.notes.push_back(fmt::format("allowed: {} (--limit call_depth=N)", most));
    error(std::move(d));
    stopped_ = true;
    return false;
  }
  calls_.push_back({unit_, unit_->program.position(), target, kind != CallKind::o_word, 0, {}});
  places_.push_back(place);
  CallLevel level;
  level.own_numbered = kind != CallKind::code;
  if (level.own_numbered) {
    std::copy_n(state_.parameters.begin() + parameter::kFirst, state_.locals(), level.numbered.begin());
    take_arguments(arguments);
    if (kind == CallKind::macro) calls_.back().arguments = arguments;
  }
  state_.levels.push_back(std::move(level));
  unit_ = target.unit;
  if (target.statement >= 0) unit_->defined[static_cast<std::size_t>(target.statement)] = true;
  unit_->program.go_to(target.begin);
  return true;
}

/// #1 and on of a call; those that it does not give are 0, or vacant.
void Flow::take_arguments(const std::vector<double>& arguments) {
  const auto first = state_.parameters.begin() + parameter::kFirst;
  std::fill_n(first, state_.locals(), macros_ ? kVacant : 0.0);
  std::copy(arguments.begin(), arguments.end(), first);
}

void Flow::give_back(const Line& line) {
  if (calls_.empty() || calls_.back().by_code) {
    return error(problem(Code::sub_kind, line.span(line.flow.keyword), "no O call has led here",
                         "M98 calls end with M99"));
  }
  double returned = 0;
  state_.value_returned = !line.flow.arguments.empty() && argument(line, returned);
  state_.returned_value = state_.value_returned ? returned : 0;
  leave_call();
}

void Flow::return_code(const CallRequest& request) {
  const Span place = request.place;
  const bool own_line = request.to_line && !rules_of(options_.dialect).macros.returns_to_number;
  if (request.to_line && (calls_.empty() || own_line))
    return jump_to_number(request.number, place.line, place);
  if (calls_.empty()) {
    report_.warning(problem(Code::main_again, place, "the program ends here, after one run"));
    return interpreter_.end_program(place);
  }
  Call& call = calls_.back();
  if (!call.by_code) {
    error(problem(Code::sub_kind, place, "the subroutine was called by O call",
                  "end it with return or endsub"));
    return leave_call();
  }
  if (!request.alone && !rules_of(options_.dialect).call_shares_line) {
    error(problem(Code::o_word_place, place, "M99 shares its line with other words",
                  "write M99 on a line of its own"));
  }
  if (call.repeats_left > 0 && report_.errors() == 0 && !request.to_line) {
    --call.repeats_left;
    if (!call.arguments.empty()) take_arguments(call.arguments);
    unit_->program.go_to(call.target.begin);
    return;
  }
  if (call.repeats_left > 0) interpreter_.lose_track();
  const std::uint32_t caller_line = places_.back().line;
  leave_call();
  if (request.to_line) jump_to_number(request.number, caller_line, place);
}

void Flow::leave_call() {
  const CallLevel& level = state_.levels.back();
  if (level.own_numbered) {
    std::copy_n(level.numbered.begin(), state_.locals(), state_.parameters.begin() + parameter::kFirst);
  }
  interpreter_.leave_level(places_.back());
  unit_ = calls_.back().caller;
  unit_->program.go_to(calls_.back().back);
  calls_.pop_back();
  places_.pop_back();
}

}  // namespace kadr::gcode
