#include "gcode/flow/flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gcode/read/other_kind.h"
#include "machine/base/require.h"

namespace kadr::gcode {

namespace {

std::uint64_t count_lines(std::string_view text) {
  return 1 + static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

Flow::Flow(SourceSet& sources, std::uint32_t file, const InterpretOptions& options, Report& report,
           Interpreter& interpreter)
    : sources_(sources),
      file_(file),
      options_(options),
      report_(report),
      interpreter_(interpreter),
      state_(interpreter.state()),
      beside_(FolderTexts::beside(sources[file].name(), options.sub_folders, options.bounds.file_bytes,
                                  options.allowed_folders)),
      called_(options.called_files ? *options.called_files : beside_),
      end_{file, 1, 1, 1} {
  report_.set_call_chain(&places_);
}

void Flow::run() {
  report_.watch_kind(file_, sources_[file_].text());
  if (!readable(file_) || !add_unit(file_, {})) return;
  unit_ = units_.front().get();
  while (!interpreter_.ended() && !report_.full() && !stopped_) {
    const Line* line = unit_->program.next();
    if (line != nullptr) {
      end_ = {line->file, line->number, 1, 1};
      if (count_line(*line)) step(*line);
      continue;
    }
    ran_out_ = calls_.empty();
    if (ran_out_) return;
    const Statement& head = calls_.back().target.unit->structure[calls_.back().target.statement];
    return error(problem(Code::sub_without_end, head.span, "no M99 follows",
                         "end the subroutine with M99, or the program with M2 or M30"));
  }
  const bool ends_all = straight_ || interpreter_.ended_by_percent();
  if (interpreter_.ended() && ends_all && report_.errors() == 0) tell_words_behind_end();
}

/// The end of a program without O words ends everything, and so does a closing %.
void Flow::tell_words_behind_end() {
  // fillers of punched tapes, and the end of a file under DOS
  constexpr std::string_view kNothing(" \t\r%\0\x1A", 6);
  const std::uint32_t file = unit_->program.file();
  Program::Position at = unit_->program.position();
  std::string_view rest = sources_[file].text();
  rest.remove_prefix(std::min(at.offset, rest.size()));
  for (; !rest.empty(); ++at.line) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::size_t first = line.find_first_not_of(kNothing);
    if (first == std::string_view::npos || line[first] == '(' || line[first] == ';') continue;
    const auto column = static_cast<std::uint32_t>(first) + 1;
    Diagnostic d = problem(Code::words_behind_end, {file, at.line, column, 1}, "never reached");
    d.notes.push_back(fmt::format("the program ends on line {}", end_.line));
    return report_.warning(std::move(d));
  }
}

/// A program without O words runs each of its lines once: only what goes back or is called needs a bound.
bool Flow::count_line(const Line& line) {
  const std::uint64_t most = options_.bounds.lines;
  if (straight_ || most == 0) return true;
  lines_ += weight_of(line.text.size());
  if (lines_ <= most) return true;
  Diagnostic d = problem(Code::too_many_lines, line.span({0, 1}), fmt::format("line {} of the run", lines_),
                         "check what calls and repeats it");
  d.notes.push_back(fmt::format("allowed: {} (--limit lines=N)", most));
  error(std::move(d));
  stopped_ = true;
  return false;
}

void Flow::step(const Line& line) {
  const bool deleted =
      options_.block_delete && !line.items.empty() && line.items.front().kind == ItemKind::block_delete;
  if (line.has_flow && !line.failed) {
    if (!deleted) statement(line);
    return;
  }
  interpreter_.run(line);
  if (const std::optional<CallRequest> request = interpreter_.take_call()) call_code(*request);
}

/// Whether the text is small enough, and one of bytes that stand for letters.
bool Flow::readable(std::uint32_t file) {
  const std::uint64_t bytes = sources_[file].text().size();
  const std::uint64_t most = options_.bounds.file_bytes;
  if (most == 0 || bytes <= most) {
    std::optional<Diagnostic> encoding = encoding_problem(file, sources_[file].text());
    if (encoding) report_.last_error(std::move(*encoding));
    return !encoding;
  }
  Diagnostic d = problem(Code::file_too_large, {file, 1, 1, 1}, fmt::format("{} bytes", bytes));
  d.notes.push_back(fmt::format("allowed: {} (--limit file_bytes=N)", most));
  error(std::move(d));
  return false;
}

bool Flow::add_unit(std::uint32_t file, std::string name) {
  units_.push_back(std::make_unique<Unit>(
      Unit{Program(sources_, file, options_.bounds, state_.names, report_, options_.dialect),
           {},
           std::move(name)}));
  Unit& unit = *units_.back();
  // a called file contains a subroutine, even if its O word looks like a program number
  const bool is_main = unit.name.empty();
  straight_ = is_main && !unit.program.has_o_words();
  interpreter_.add_text(count_lines(sources_[file].text()), straight_);
  if (straight_) return true;
  if (!unit.structure.read(unit.program, options_.block_delete, state_.names, report_)) return false;
  unit.passes_left.assign(unit.structure.size(), kNoPasses);
  unit.defined.assign(unit.structure.size(), false);
  make_known(unit);
  return true;
}

void Flow::statement(const Line& line) {
  interpreter_.start();
  if (line.flow.word == FlowWord::call) return call_statement(line);
  // a program number at the head of a file without other O words
  if (line.flow.word == FlowWord::label) return;
  const int index = unit_->structure.at_line(line.number);
  if (index < 0) {
    // nothing is bound after an M2 that a mistake kept from ending the program
    require(report_.errors() > 0, "every O word that is run was bound before");
    stopped_ = true;
    return;
  }
  const Statement& s = at(index);
  switch (line.flow.word) {
    case FlowWord::sub:
      return pass_definition(index);
    case FlowWord::end_sub:
    case FlowWord::return_from:
      return give_back(line);
    case FlowWord::if_true:
      return branch(line, index);
    case FlowWord::else_if:
    case FlowWord::otherwise:
      // reached from the branch before, which has been run
      return unit_->program.go_to(at(at(s.begin).end).after);
    case FlowWord::while_true:
      return s.begin < 0 ? while_head(line, index) : do_foot(line, index);
    case FlowWord::end_while:
      return next_pass(s.begin);
    case FlowWord::do_once:
      count_pass(index);
      return;
    case FlowWord::repeat:
      return repeat(line, index);
    case FlowWord::end_repeat:
      return repeat_end(index);
    case FlowWord::break_loop:
      return break_loop(index);
    case FlowWord::continue_loop:
      return continue_loop(index);
    case FlowWord::label:
    case FlowWord::call:
    case FlowWord::end_if:
      break;
  }
}

/// Skipping a definition still evaluates the value after endsub, in the caller's parameters.
void Flow::pass_definition(int index) {
  const Statement& s = at(index);
  if (unit_->defined[static_cast<std::size_t>(index)]) {
    unit_->program.go_to(at(s.end).after);
    return error(problem(Code::o_misplaced, s.span,
                         fmt::format("{} is already known here", label_text(s.name)),
                         "write a subroutine above the lines that call it, or after the program's end"));
  }
  unit_->defined[static_cast<std::size_t>(index)] = true;
  unit_->program.go_to(at(s.end).at);
  const Line& end = *unit_->program.next();
  double returned = 0;
  state_.value_returned = !end.flow.arguments.empty();
  // names that only the sub sets are 0 here
  evaluator_.begin_line();
  for (const ExpressionNode& node : end.nodes) {
    if (node.kind == NodeKind::named) evaluator_.declare(node.left);
  }
  const bool known =
      state_.value_returned &&
      evaluator_.evaluate(end, end.flow.first, end.flow.arguments.front(), state_, nullptr, returned);
  state_.returned_value = known ? returned : 0;
  evaluator_.begin_line();
}

bool Flow::value(const Line& line, std::int32_t first, std::int32_t root, double& result) {
  return evaluator_.evaluate(line, first, root, state_, &report_, result) && !evaluator_.doubtful();
}

void Flow::branch(const Line& line, int index) {
  double condition = 0;
  bool known = argument(line, condition);
  int at_branch = index;
  while (known && condition == 0) {
    at_branch = at(at_branch).next;
    const FlowWord word = at(at_branch).word;
    if (word != FlowWord::else_if) return unit_->program.go_to(at(at_branch).after);
    unit_->program.go_to(at(at_branch).at);
    const Line& next = *unit_->program.next();
    known = count_line(next) && argument(next, condition);
  }
  if (known) return unit_->program.go_to(at(at_branch).after);
  // without a value no branch is right: all are skipped
  interpreter_.lose_track();
  unit_->program.go_to(at(at(index).end).after);
}

}  // namespace kadr::gcode
