#include <fmt/format.h>

#include <algorithm>

#include "gcode/flow/flow.h"

/// Where a program is entered, and where it is left: Reading::from_line and to_line.
namespace kadr::gcode {
namespace {

/// Nothing to run on a line but remarks.
bool is_bare(const Line& line) {
  return std::all_of(line.items.begin(), line.items.end(), [](const Item& item) {
    return item.kind != ItemKind::word && item.kind != ItemKind::setting && item.kind != ItemKind::o_word;
  });
}

std::string called_on(const std::vector<Span>& places) {
  return fmt::format("it stands in a subroutine, called on line {}", places.back().line);
}

}  // namespace

bool Flow::range_in_order() {
  const auto& [from, to] = std::pair(options_.from_line, options_.to_line);
  if (!from || !to || *from <= *to) return true;
  tell_exit({file_, *to, 1, 1}, fmt::format("it stands before line {}, where the program is entered", *from));
  return false;
}

void Flow::step_in_range(const Line& line) {
  if (interpreter_.passing()) arrive(line);
  if (stopped_) return;
  const bool last = options_.to_line && line.file == file_ && line.number == *options_.to_line;
  if (last && !exit_ && !interpreter_.passing())
    exit_ = {calls_.size(), line.span({0, static_cast<std::uint32_t>(line.text.size())})};
  step(line);
  if (!exit_ || calls_.size() > exit_->depth || interpreter_.ended()) return;
  if (const std::string refusal = interpreter_.not_left(); !refusal.empty()) {
    if (report_.errors() == 0) tell_exit(exit_->place, refusal);
    stopped_ = true;
    return;
  }
  interpreter_.leave(exit_->place);
}

/// A line is about to be run before the program is entered.
void Flow::arrive(const Line& line) {
  if (line.file != file_) return;
  if (entry_.met.size() <= line.number) entry_.met.resize(2 * std::size_t{line.number} + 1);
  if (entry_.met[line.number]) return;
  entry_.met[line.number] = true;
  const std::uint32_t wanted = *options_.from_line;
  const std::string refusal = not_entered(line);
  if (line.number == wanted) {
    if (refusal.empty()) return interpreter_.enter(line);
    entry_.place = line.span({0, static_cast<std::uint32_t>(line.text.size())});
    entry_.refusal = refusal;
  } else if (refusal.empty()) {
    if (line.number < wanted) entry_.before = std::max(entry_.before, line.number);
    if (line.number > wanted && (entry_.after == 0 || line.number < entry_.after)) entry_.after = line.number;
  }
  // the next line that can be entered is known: nothing more is run
  stopped_ = !entry_.refusal.empty() && entry_.after != 0;
}

/// Why the program can't be entered where a line is met for the first time; empty: it can.
std::string Flow::not_entered(const Line& line) const {
  if (!calls_.empty()) return called_on(places_);
  if (is_bare(line)) return "no block stands on this line";
  if (options_.block_delete && line.items.front().kind == ItemKind::block_delete)
    return "block delete skips this line";
  if (line.has_flow && !line.failed) {
    const FlowWord word = line.flow.word;
    const int index = straight_ ? -1 : unit_->structure.at_line(line.number);
    const bool begins = word == FlowWord::call || word == FlowWord::if_true || word == FlowWord::repeat ||
                        word == FlowWord::do_once ||
                        (word == FlowWord::while_true && index >= 0 && at(index).begin < 0);
    const FlowStatement& flow = line.flow;
    const Bytes words{flow.label.begin, std::max(flow.label.end, flow.keyword.end)};
    if (!begins) return fmt::format("{} begins nothing that is run", line.slice(words));
  }
  return interpreter_.not_entered(line);
}

std::uint32_t Flow::lines_of_program() const {
  const std::string_view text = sources_[file_].text();
  const auto ends = std::count(text.begin(), text.end(), '\n');
  return static_cast<std::uint32_t>(ends) + (text.ends_with('\n') ? 0 : 1);
}

void Flow::tell_range() {
  if (report_.errors() > 0) return;
  if (interpreter_.passing()) {
    if (!entry_.refusal.empty()) return tell_entry(entry_.place, entry_.refusal);
    const std::uint32_t wanted = *options_.from_line, lines = std::max(lines_of_program(), end_.line);
    if (wanted > lines)
      return tell_entry({file_, lines, 1, 1}, fmt::format("there is no line {}: this is the last", wanted));
    return tell_entry({file_, wanted, 1, 1},
                      fmt::format("the program never comes here; it ends on line {}", end_.line));
  }
  if (options_.to_line && !exit_) {
    const std::string_view since = options_.from_line ? " since it was entered" : "";
    tell_exit(end_,
              fmt::format("the program ends here, and has not come to line {}{}", *options_.to_line, since));
  }
}

void Flow::tell_entry(Span place, std::string label) {
  Diagnostic d = problem(Code::entry_line, place, std::move(label));
  const auto& [before, after] = std::pair(entry_.before, entry_.after);
  if (before != 0 && after != 0)
    d.help = fmt::format("the nearest lines that can be entered are {} and {}", before, after);
  else if (before != 0 || after != 0)
    d.help = fmt::format("the nearest line that can be entered is {}", std::max(before, after));
  error(std::move(d));
}

void Flow::tell_exit(Span place, std::string label) {
  error(problem(Code::exit_line, place, std::move(label)));
}

}  // namespace kadr::gcode
