#include <fmt/format.h>

#include <utility>

#include "gcode/flow/flow.h"

/// Statements of macro B: IF, GOTO, WHILE, DO and END, and calls of lines.
namespace kadr::gcode {

void Flow::step_macro(const Line& line) {
  const bool deleted =
      options_.block_delete && !line.items.empty() && line.items.front().kind == ItemKind::block_delete;
  if (deleted || line.items.empty()) return;
  if (line.reads_inputs && !line.failed) interpreter_.read_inputs(line);
  if (line.has_flow && !line.failed) return statement(line);
  if (line.only_settings && !line.failed) return interpreter_.assign(line);
  run_words(line);
}

/// A line of words, or those behind THEN, and the call that they make.
void Flow::run_words(const Line& line) {
  if (!line.failed && (line.macro_call == MacroCall::once || line.macro_call == MacroCall::modal)) {
    interpreter_.macro_call(line);
  } else {
    if (line.macro_call == MacroCall::cancel) interpreter_.cancel_modal_call();
    interpreter_.run(line);
  }
  if (const std::optional<CallRequest> request = interpreter_.take_call()) return call_code(*request);
  if (line.macro_call != MacroCall::none) return;
  if (const std::optional<CallRequest> request = interpreter_.modal_call_due()) call_code(*request);
}

void Flow::control(const Line& line, int index) {
  const Statement& s = at(index);
  switch (s.word) {
    case FlowWord::go_to:
    case FlowWord::if_go_to:
      return go_to(line, index);
    case FlowWord::if_then:
      return if_then(line);
    case FlowWord::while_do:
      return while_do(line, index);
    case FlowWord::do_loop:
      count_pass(index);
      return;
    case FlowWord::end_do:
      return next_pass(s.begin);
    case FlowWord::label:
    case FlowWord::sub:
    case FlowWord::end_sub:
    case FlowWord::call:
    case FlowWord::return_from:
    case FlowWord::if_true:
    case FlowWord::else_if:
    case FlowWord::otherwise:
    case FlowWord::end_if:
    case FlowWord::while_true:
    case FlowWord::end_while:
    case FlowWord::do_once:
    case FlowWord::repeat:
    case FlowWord::end_repeat:
    case FlowWord::break_loop:
    case FlowWord::continue_loop:
      break;
  }
}

/// An O number alone heads the next program of the file: the one before ends here.
void Flow::begin_program(const Line& line) {
  if (straight_ || (line.number == unit_->structure.head_line() && calls_.empty())) return;
  stopped_ = true;
  if (calls_.empty()) return;
  error(problem(Code::sub_without_end, line.span(line.flow.label), "the next program begins before an M99",
                "end the subprogram with M99"));
}

/// A condition with a vacant value does not hold.
bool Flow::holds(const Line& line, bool& known) {
  double condition = 0;
  known = argument(line, condition);
  if (!known) interpreter_.lose_track();
  return known && condition != 0;
}

void Flow::if_then(const Line& line) {
  bool known = false;
  if (!holds(line, known)) return;
  if (line.only_settings) return interpreter_.assign(line);
  run_words(line);
}

void Flow::while_do(const Line& line, int index) {
  bool known = false;
  if (holds(line, known)) {
    count_pass(index);
    return;
  }
  leave_loop(index);
}

void Flow::go_to(const Line& line, int index) {
  const Statement& s = at(index);
  bool known = true;
  if (s.word == FlowWord::if_go_to && !holds(line, known)) return;
  if (s.target != nullptr) return jump(*s.target, s.span.line, s.span);
  double number = 0;
  int whole = 0;
  if (!value(line, line.flow.label_first, line.flow.label_root, number)) return interpreter_.lose_track();
  if (near_integer(number, whole) && whole >= 0) return jump_to_number(whole, s.span.line, s.span);
  interpreter_.lose_track();
  error(problem(Code::sequence_number_missing, s.span,
                number == number ? fmt::format("the number is {}", figure(number)) : "the number is vacant"));
}

/// A jump back is a pass of a loop.
void Flow::jump(const NumberedLine& target, std::uint32_t line, Span place) {
  if (target.at.line <= line) {
    // after an error nothing moves: one pass reports everything
    if (report_.errors() > 0) return interpreter_.lose_track();
    if (!count_pass(place)) return;
  }
  unit_->program.go_to(target.at);
}

void Flow::jump_to_number(std::int64_t number, std::uint32_t line, Span place) {
  const NumberedLine* target = nullptr;
  std::optional<Diagnostic> fault =
      unit_->structure.find_line(static_cast<std::int32_t>(number), line, place, target);
  if (!fault) return jump(*target, line, place);
  interpreter_.lose_track();
  error(std::move(*fault));
}

/// M97 P: the lines from N of this program to M99.
void Flow::call_line(const CallRequest& request) {
  const NumberedLine* line = nullptr;
  std::optional<Diagnostic> fault = unit_->structure.find_line(static_cast<std::int32_t>(request.number),
                                                               request.place.line, request.place, line);
  if (fault) {
    interpreter_.lose_track();
    return error(std::move(*fault));
  }
  if (!enter({unit_, -1, line->at}, CallKind::code, request.place, {})) return interpreter_.lose_track();
  calls_.back().repeats_left = request.repeats - 1;
}

}  // namespace kadr::gcode
