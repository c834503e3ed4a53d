#include "gcode/flow/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "gcode/flow/evaluate.h"
#include "gcode/flow/macro_loops.h"
#include "gcode/interpret/words.h"

namespace kadr::gcode {
namespace {

std::string_view word_text(FlowWord word) {
  switch (word) {
    case FlowWord::sub:
      return "sub";
    case FlowWord::end_sub:
      return "endsub";
    case FlowWord::if_true:
      return "if";
    case FlowWord::else_if:
      return "elseif";
    case FlowWord::otherwise:
      return "else";
    case FlowWord::end_if:
      return "endif";
    case FlowWord::while_true:
      return "while";
    case FlowWord::end_while:
      return "endwhile";
    case FlowWord::do_once:
      return "do";
    case FlowWord::repeat:
      return "repeat";
    case FlowWord::end_repeat:
      return "endrepeat";
    case FlowWord::break_loop:
      return "break";
    case FlowWord::continue_loop:
      return "continue";
    case FlowWord::return_from:
      return "return";
    case FlowWord::call:
      return "call";
    case FlowWord::go_to:
      return "GOTO";
    case FlowWord::if_go_to:
    case FlowWord::if_then:
      return "IF";
    case FlowWord::while_do:
      return "WHILE";
    case FlowWord::do_loop:
      return "DO";
    case FlowWord::end_do:
      return "END";
    case FlowWord::label:
      break;
  }
  return "";
}

std::string_view end_text(FlowWord begin) {
  return begin == FlowWord::sub          ? "endsub"
         : begin == FlowWord::if_true    ? "endif"
         : begin == FlowWord::while_true ? "endwhile"
         : begin == FlowWord::do_once    ? "while [condition]"
                                         : "endrepeat";
}

/// The beginning that a word closes or continues.
FlowWord beginning_of(FlowWord word) {
  switch (word) {
    case FlowWord::end_sub:
      return FlowWord::sub;
    case FlowWord::end_while:
      return FlowWord::while_true;
    case FlowWord::end_repeat:
      return FlowWord::repeat;
    case FlowWord::label:
    case FlowWord::sub:
    case FlowWord::call:
    case FlowWord::return_from:
    case FlowWord::if_true:
    case FlowWord::else_if:
    case FlowWord::otherwise:
    case FlowWord::end_if:
    case FlowWord::while_true:
    case FlowWord::do_once:
    case FlowWord::repeat:
    case FlowWord::break_loop:
    case FlowWord::continue_loop:
    case FlowWord::go_to:
    case FlowWord::if_go_to:
    case FlowWord::if_then:
    case FlowWord::while_do:
    case FlowWord::do_loop:
    case FlowWord::end_do:
      break;
  }
  return FlowWord::if_true;
}

/// The controller skips everything else on the line of an O word, including messages.
void warn_comments(const Line& line, Report& report) {
  for (const Item& item : line.items) {
    if (item.kind != ItemKind::comment || active_comment(line.slice(item.bytes)).command.empty()) continue;
    report.warning(problem(Code::comment_not_run, line.span(item.bytes),
                           "a comment on the line of an O word is not run", "write it on a line of its own"));
  }
}

}  // namespace

/// State while the O words of one file are read in order.
struct Structure::Reader {
  Structure& structure;
  Names& names;
  std::vector<Diagnostic> problems = {};  ///< no more than are ever told
  std::vector<int> open = {};             ///< beginnings without an end so far, the innermost last
  std::vector<int> last_branch = {};      ///< [open], the latest branch of an if
  std::map<std::pair<FlowWord, std::int32_t>, std::vector<int>> open_of = {};  ///< `open` by word and label
  std::vector<int> open_subs = {};                    ///< those of `open` that are subs
  std::set<std::int32_t> labels_in_scope = {};        ///< of ifs and loops, in this sub or main program
  std::set<std::int32_t> labels_of_main = {};         ///< kept while a sub is read
  MacroLoops loops{structure.statements_, problems};  ///< of macro B

  void error(Code code, Span span, std::string label, std::string note = {}, std::string help = {}) {
    Diagnostic d = problem(code, span, std::move(label), std::move(help));
    if (!note.empty()) d.notes.push_back(std::move(note));
    if (problems.size() < Report::kMaxErrors) problems.push_back(std::move(d));
  }

  std::string name_of(std::int32_t name) const {
    const std::string& text = names[name];
    const bool digits = std::all_of(text.begin(), text.end(), is_digit);
    return digits ? "O" + text : "O<" + text + ">";
  }
  std::string told(int index) const {
    const Statement& s = structure[index];
    return fmt::format("{} {} on line {}", name_of(s.name), word_text(s.word), s.span.line);
  }

  void add(const Line& line, Program::Position at, Program::Position after) {
    const FlowStatement& flow = line.flow;
    Statement s;
    s.word = flow.word;
    s.name = flow.name;
    s.span = line.span({flow.label.begin, std::max(flow.label.end, flow.keyword.end)});
    s.at = at;
    s.after = after;
    if (is_macro_word(flow.word)) {
      s.name = flow.number;
      s.span = line.span({flow.keyword.begin, std::max({flow.keyword.end, flow.second.end, flow.label.end})});
    } else if (flow.word != FlowWord::call && flow.name < 0 && !fixed_label(line, s)) {
      return;
    }
    const int index = static_cast<int>(structure.statements_.size());
    structure.statements_.push_back(s);
    bind(index);
  }

  /// O[100] written as an expression without parameters is a fixed label, too.
  bool fixed_label(const Line& line, Statement& s) {
    const FlowStatement& flow = line.flow;
    for (std::int32_t i = flow.label_first; i <= flow.label_root; ++i) {
      const NodeKind kind = line.nodes[static_cast<std::size_t>(i)].kind;
      if (kind != NodeKind::parameter && kind != NodeKind::named && kind != NodeKind::exists &&
          kind != NodeKind::exists_named)
        continue;
      error(Code::o_label_computed, s.span,
            fmt::format("the label of this {} depends on a parameter", word_text(flow.word)));
      return false;
    }
    double value = 0;
    int number = 0;
    if (!Evaluator().evaluate(line, flow.label_first, flow.label_root, State(), nullptr, value) ||
        !near_integer(value, number) || number < 0) {
      error(Code::o_label_missing, s.span, fmt::format("the label is {}", figure(value)), {},
            "a label is a whole number, 0 or above");
      return false;
    }
    s.name = names.number(std::to_string(number));
    return true;
  }

  void bind(int index) {
    Statement& s = structure.statements_[static_cast<std::size_t>(index)];
    switch (s.word) {
      case FlowWord::label:
        structure.labels_.try_emplace(s.name, index);
        loops.end_program();
        structure.numbers_.begin_program(s.span.line);
        // what follows may be another program: its labels are its own
        if (open.empty()) labels_in_scope.clear();
        return;
      case FlowWord::call:
        return;
      case FlowWord::sub:
      case FlowWord::if_true:
      case FlowWord::do_once:
      case FlowWord::repeat:
        return begin(index);
      case FlowWord::while_true:
        if (!open.empty() && structure[open.back()].word == FlowWord::do_once &&
            structure[open.back()].name == s.name)
          return close(index);
        return begin(index);
      case FlowWord::end_sub:
      case FlowWord::end_if:
      case FlowWord::end_while:
      case FlowWord::end_repeat:
        return finish(index);
      case FlowWord::else_if:
      case FlowWord::otherwise:
        return branch(index);
      case FlowWord::return_from:
      case FlowWord::break_loop:
      case FlowWord::continue_loop:
        return leave(index);
      case FlowWord::go_to:
      case FlowWord::if_go_to:
      case FlowWord::if_then:
        return;
      case FlowWord::while_do:
      case FlowWord::do_loop:
        return loops.begin(index);
      case FlowWord::end_do:
        return loops.end(index);
    }
  }

  void find_targets() {
    structure.numbers_.finish();
    for (Statement& s : structure.statements_) {
      const bool goes = s.word == FlowWord::go_to || s.word == FlowWord::if_go_to;
      if (!goes || s.name < 0) continue;
      std::optional<Diagnostic> fault = structure.find_line(s.name, s.span.line, s.span, s.target);
      if (fault && problems.size() < Report::kMaxErrors) problems.push_back(std::move(*fault));
    }
  }

  /// N of a line, and the O number that names the main program.
  void note(const Line& line, Program::Position at, bool words) {
    if (const std::optional<std::int32_t> number = sequence_number(line))
      structure.numbers_.add(*number, at, loops.innermost());
    if (!words && line.has_flow && line.flow.word == FlowWord::label) structure.head_line_ = line.number;
  }

  void begin(int index) {
    const Statement& s = structure[index];
    if (s.word == FlowWord::sub) {
      if (!open_subs.empty()) {
        error(Code::o_misplaced, s.span, "a sub inside a sub",
              fmt::format("{} is still open", told(open_subs.front())));
      }
      open_subs.push_back(index);
      const auto [it, is_new] = structure.subs_.try_emplace(s.name, index);
      if (!is_new) {
        error(Code::o_label_twice, s.span, "a second sub of this name",
              fmt::format("the first one is on line {}", structure[it->second].span.line));
      }
      labels_of_main.swap(labels_in_scope);
      labels_in_scope.clear();
    } else if (!labels_in_scope.insert(s.name).second) {
      error(Code::o_label_twice, s.span, fmt::format("{} already begins something else", name_of(s.name)), {},
            "give it a label of its own, and the words that belong to it as well");
    }
    open.push_back(index);
    open_of[{s.word, s.name}].push_back(index);
    last_branch.push_back(index);
  }

  /// The innermost open beginning of that word and label, -1 if there is none.
  int innermost(FlowWord word, std::int32_t name) const {
    const auto it = open_of.find({word, name});
    return it == open_of.end() || it->second.empty() ? -1 : it->second.back();
  }

  /// An end word: it must name the innermost thing that is open.
  void finish(int index) {
    const Statement& s = structure[index];
    const bool fits = !open.empty() && structure[open.back()].name == s.name &&
                      structure[open.back()].word == beginning_of(s.word);
    if (fits) return close(index);
    if (s.word == FlowWord::end_while && !open.empty() && structure[open.back()].word == FlowWord::do_once) {
      // the foot of a do loop is a while
      error(Code::o_not_opened, s.span, "no while of this label is open here",
            fmt::format("open here: {}, which ends with while [condition]", told(open.back())));
      return close(index);
    }
    not_opened(index);
  }

  void not_opened(int index) {
    const Statement& s = structure[index];
    error(Code::o_not_opened, s.span,
          fmt::format("no {} {} is open here", name_of(s.name), word_text(beginning_of(s.word))),
          open.empty() ? "nothing is open here" : fmt::format("open here: {}", told(open.back())));
    // an end that fits something further out also ends what is inside it, or one slip would be reported often
    const int fitting = innermost(beginning_of(s.word), s.name);
    while (fitting >= 0 && !open.empty() && open.back() >= fitting) drop();
  }

  void close(int index) {
    const int first = open.back();
    Statement& s = structure.statements_[static_cast<std::size_t>(index)];
    s.begin = first;
    structure.statements_[static_cast<std::size_t>(first)].end = index;
    structure.statements_[static_cast<std::size_t>(last_branch.back())].next = index;
    drop();
  }

  void drop() {
    const Statement& s = structure[open.back()];
    if (s.word == FlowWord::sub) {
      labels_in_scope.swap(labels_of_main);
      labels_of_main.clear();
      open_subs.pop_back();
    }
    open_of[{s.word, s.name}].pop_back();
    open.pop_back();
    last_branch.pop_back();
  }

  void branch(int index) {
    Statement& s = structure.statements_[static_cast<std::size_t>(index)];
    const bool fits = !open.empty() && structure[open.back()].name == s.name &&
                      structure[open.back()].word == FlowWord::if_true;
    if (!fits) return not_opened(index);
    const int last = last_branch.back();
    if (structure[last].word == FlowWord::otherwise) {
      error(Code::o_misplaced, s.span, fmt::format("{} after else", word_text(s.word)),
            fmt::format("{} is the last branch", told(last)));
    }
    s.begin = open.back();
    structure.statements_[static_cast<std::size_t>(last)].next = index;
    last_branch.back() = index;
  }

  /// return, break, continue.
  void leave(int index) {
    Statement& s = structure.statements_[static_cast<std::size_t>(index)];
    if (s.word == FlowWord::return_from) {
      if (open_subs.empty()) return error(Code::o_misplaced, s.span, "no sub is open here");
      s.begin = open_subs.back();
      return;
    }
    const int loop = std::max(innermost(FlowWord::while_true, s.name), innermost(FlowWord::do_once, s.name));
    if (loop >= 0) {
      s.begin = loop;
      if (s.word == FlowWord::break_loop)
        structure.statements_[static_cast<std::size_t>(loop)].last_break = index;
      return;
    }
    error(Code::o_misplaced, s.span, fmt::format("no while or do loop {} is open here", name_of(s.name)),
          open.empty() ? "nothing is open here" : fmt::format("open here: {}", told(open.back())));
  }

  void end_of_file() {
    loops.end_program();
    find_targets();
    for (const int index : open) {
      const Statement& s = structure[index];
      error(Code::o_not_closed, s.span, fmt::format("no {} {} follows", name_of(s.name), end_text(s.word)));
    }
  }
};

bool begins_subroutine(const Line& line) {
  return line.has_flow && (line.flow.word == FlowWord::sub || line.flow.word == FlowWord::label);
}

bool ends_program(const Line& line) {
  return std::any_of(line.items.begin(), line.items.end(), [](const Item& item) {
    return item.kind == ItemKind::word && item.letter == 'M' && item.value < 0 &&
           (item.number == code::m2 || item.number == code::m30);
  });
}

bool Structure::read(Program& program, bool block_delete, bool macros, Names& names, Report& report) {
  Reader reader{*this, names};
  bool words = false;  // something stands before, a % perhaps
  bool code = false;   // and something that acts
  bool unread = false;
  bool behind_end = false;
  for (;;) {
    program.mute(behind_end);
    const Program::Position at = program.position();
    const Line* line = program.next();
    if (line == nullptr) break;
    if (line->items.empty()) continue;
    if (block_delete && line->items.front().kind == ItemKind::block_delete) continue;
    // unreadable text after M2 is a remark, until a subroutine begins
    if (behind_end && (line->failed || !begins_subroutine(*line))) continue;
    behind_end = !macros && reader.open.empty() && ends_program(*line);
    if (macros) reader.note(*line, at, code);
    if (line->has_flow && line->failed) unread = true;
    if (line->has_flow && !line->failed) {
      reader.add(*line, at, program.position());
      warn_comments(*line, report);
    }
    const bool percent = std::any_of(line->items.begin(), line->items.end(),
                                     [](const Item& item) { return item.kind == ItemKind::percent; });
    if (percent && words) break;
    code =
        code || line->has_flow || std::any_of(line->items.begin(), line->items.end(), [](const Item& item) {
          return item.kind == ItemKind::word || item.kind == ItemKind::setting;
        });
    words = words || percent || code;
  }
  reader.end_of_file();
  program.rewind();
  // an unreadable O word leaves others without a partner: only it is reported
  if (unread || report.full()) return false;
  for (Diagnostic& problem : reader.problems) report.error(std::move(problem));
  return reader.problems.empty();
}

int Structure::at_line(std::uint32_t line) const {
  const auto it =
      std::lower_bound(statements_.begin(), statements_.end(), line,
                       [](const Statement& s, std::uint32_t wanted) { return s.span.line < wanted; });
  const bool bound = it != statements_.end() && it->span.line == line;
  return bound ? static_cast<int>(it - statements_.begin()) : -1;
}

}  // namespace kadr::gcode
