#include "gcode/flow/macro_loops.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace kadr::gcode {

void MacroLoops::error(Diagnostic d, std::string note) {
  if (!note.empty()) d.notes.push_back(std::move(note));
  if (problems_.size() < Report::kMaxErrors) problems_.push_back(std::move(d));
}

void MacroLoops::begin(int index) {
  const Statement& s = at(index);
  std::vector<int>& same = by_number_[s.name];
  if (!same.empty()) {
    error(problem(Code::macro_loop, s.span, fmt::format("DO{0} inside DO{0}", s.name),
                  "loops inside each other have different numbers"),
          fmt::format("the outer one is on line {}", at(same.back()).span.line));
  }
  same.push_back(index);
  open_.push_back(index);
}

void MacroLoops::end(int index) {
  Statement& s = at(index);
  const std::vector<int>& same = by_number_[s.name];
  if (same.empty())
    return error(problem(Code::macro_loop, s.span, fmt::format("no DO{} is open here", s.name)));
  const int loop = same.back();
  if (loop != open_.back()) {
    const Statement& inner = at(open_.back());
    error(problem(Code::macro_loop, s.span, fmt::format("DO{} is still open here", inner.name),
                  "the loop that begins last ends first"),
          fmt::format("it is on line {}", inner.span.line));
  }
  s.begin = loop;
  at(loop).end = index;
  // what is inside it ends with it
  while (!open_.empty() && open_.back() >= loop) {
    by_number_[at(open_.back()).name].pop_back();
    open_.pop_back();
  }
}

void MacroLoops::end_program() {
  for (const int loop : open_)
    error(problem(Code::macro_loop, at(loop).span, fmt::format("no END{} follows", at(loop).name)));
  open_.clear();
  by_number_.clear();
}

std::optional<Diagnostic> Structure::find_line(std::int32_t number, std::uint32_t line, Span place,
                                               const NumberedLine*& target) const {
  target = numbers_.find(number, line);
  if (target == nullptr)
    return problem(Code::sequence_number_missing, place, fmt::format("no line N{} in this program", number));
  if (const NumberedLine* again = numbers_.again(*target)) {
    Diagnostic d =
        problem(Code::sequence_number_twice, place, fmt::format("N{} is not the only one", number));
    d.notes.push_back(fmt::format("N{} begins line {} and line {}", number, target->at.line, again->at.line));
    return d;
  }
  if (target->loop < 0) return std::nullopt;
  const Statement& loop = statements_[static_cast<std::size_t>(target->loop)];
  if (loop.end < 0) return std::nullopt;  // reported
  const std::uint32_t last = statements_[static_cast<std::size_t>(loop.end)].span.line;
  if (line > loop.span.line && line <= last) return std::nullopt;
  Diagnostic d =
      problem(Code::jump_into_loop, place, fmt::format("N{} stands inside DO{}", number, loop.name));
  d.notes.push_back(fmt::format("the loop begins on line {}", loop.span.line));
  return d;
}

}  // namespace kadr::gcode
