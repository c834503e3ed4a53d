#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "gcode/flow/structure.h"
#include "gcode/interpret/interpreter.h"
#include "gcode/read/program.h"
#include "gcode/read/text_resolver.h"

namespace kadr::gcode {

/// Runs a program line by line in the order that its O words, M98 and M99 say: subroutines of its own and of
/// files next to it, conditions, loops. The Interpreter runs the lines themselves.
class Flow {
 public:
  Flow(SourceSet& sources, std::uint32_t file, const InterpretOptions& options, Report& report,
       Interpreter& interpreter);
  void run();
  /// Where the run ended.
  Span end() const { return end_; }
  /// Whether all of the text was read and no M2, M30 or % has ended the program.
  bool ran_out() const { return ran_out_; }
  /// Reports that the run has not met Reading::from_line or to_line.
  void tell_range();

 private:
  struct Unit {
    Program program;
    Structure structure;
    std::string name;  ///< file name without folder and ending; empty for the main program
    std::vector<std::int64_t> passes_left = {};  ///< [statements] of a repeat; kNoPasses: it is not under way
    std::vector<bool> defined = {};              ///< [statements] subs that were called or passed over
  };
  /// A subroutine in a unit.
  struct Target {
    Unit* unit = nullptr;
    int statement = -1;  ///< its head; -1: a line of M97
    Program::Position begin = {};
  };
  enum class CallKind : std::uint8_t {
    o_word,
    code,   ///< M97 or M98: the variables are those of the caller
    macro,  ///< G65 or G66
  };
  /// A call that has not returned.
  struct Call {
    Unit* caller = nullptr;
    Program::Position back;
    Target target;
    bool by_code = false;                ///< M98, G65, ...: ends with M99
    std::uint64_t repeats_left = 0;      ///< L
    std::vector<double> arguments = {};  ///< of G65: each repetition begins with them
  };
  bool add_unit(std::uint32_t file, std::string name);
  void make_known(Unit& unit);
  bool count_line(const Line& line);
  bool readable(std::uint32_t file);
  void tell_words_behind_end();
  void warn_other_file(const Target& target, std::int32_t name, Span place);
  void step(const Line& line);
  // macros.cpp
  void step_macro(const Line& line);
  void control(const Line& line, int index);
  void begin_program(const Line& line);
  void if_then(const Line& line);
  void run_words(const Line& line);
  void while_do(const Line& line, int index);
  bool holds(const Line& line, bool& known);
  void go_to(const Line& line, int index);
  void jump(const NumberedLine& target, std::uint32_t line, Span place);
  void jump_to_number(std::int64_t number, std::uint32_t line, Span place);
  void call_line(const CallRequest& request);
  void statement(const Line& line);
  void branch(const Line& line, int index);
  void pass_definition(int index);

  // line_range.cpp: where the program is entered, and where it is left
  /// What is known of the lines that were met before the program is entered.
  struct Entry {
    std::vector<bool> met;     ///< by line
    std::uint32_t before = 0;  ///< the nearest lines around from_line that can be entered; 0: none
    std::uint32_t after = 0;
    Span place;           ///< of from_line, if it was met and
    std::string refusal;  ///< why it can't be entered
  };
  /// to_line is being run: the program ends when all that it calls has returned.
  struct Exit {
    std::size_t depth = 0;  ///< of calls
    Span place;
  };
  void step_in_range(const Line& line);
  void arrive(const Line& line);
  std::string not_entered(const Line& line) const;
  void tell_entry(Span place, std::string label);
  void tell_exit(Span place, std::string label);
  bool range_in_order();
  std::uint32_t lines_of_program() const;

  // loops.cpp
  void while_head(const Line& line, int index);
  void do_foot(const Line& line, int index);
  void repeat(const Line& line, int index);
  void repeat_end(int index);
  void break_loop(int index);
  void continue_loop(int index);
  void pass_over_breaks(int from, int loop);
  void leave_loop(int loop);
  void next_pass(int loop);
  bool count_pass(int beginning) { return count_pass(at(beginning).span); }
  bool count_pass(Span beginning);
  void warn_kept(int index, std::string label, std::string cause);

  void call_statement(const Line& line);
  void call_code(const CallRequest& request);
  void call_owner(const CallRequest& request);
  Target find(std::int32_t name, bool by_code, Span place);
  Target find_known(std::int32_t name, bool by_code) const;
  bool load(std::int32_t name, Span place);
  FoundText find_text(const std::string& name) const;
  bool enter(Target target, CallKind kind, Span place, const std::vector<double>& arguments);
  void take_arguments(const std::vector<double>& arguments);
  void give_back(const Line& line);
  void leave_call();
  void return_code(const CallRequest& request);

  bool value(const Line& line, std::int32_t first, std::int32_t root, double& result);
  /// A vacant one of macro B is 0.
  bool argument(const Line& line, double& result) {
    const bool known = value(line, line.flow.first, line.flow.arguments.front(), result);
    if (result != result) result = 0;
    return known;
  }
  std::string label_text(std::int32_t name) const;
  void error(Diagnostic d) { report_.error(std::move(d)); }
  const Statement& at(int index) const { return unit_->structure[index]; }

  SourceSet& sources_;
  std::uint32_t file_;
  const InterpretOptions& options_;
  Report& report_;
  Interpreter& interpreter_;
  State& state_;
  Evaluator evaluator_;
  std::vector<std::unique_ptr<Unit>> units_;
  std::unordered_map<std::int32_t, Target> subs_, labels_;  ///< by name, of all units: the first that has it
  std::unordered_map<std::int32_t, FoundText> unusable_;    ///< names of files that are not there or refused
  FolderTexts beside_;          ///< the program's folder, and those of the options
  const TextResolver& called_;  ///< where called files come from
  Unit* unit_ = nullptr;
  std::vector<Call> calls_;
  std::vector<Span> places_;  ///< [calls], where each was made
  static constexpr std::int64_t kNoPasses = -1;
  int repeat_gone_back_to_ = -1;  ///< the repeat whose endrepeat was just reached
  bool break_kept_ = false;       ///< a break was met, and no foot of a do since
  bool continue_kept_ = false;  ///< a continue was met, and no end of a while or repeat was passed over since
  std::uint64_t passes_ = 0;
  std::uint64_t lines_ = 0;  ///< run, weighed
  Entry entry_;
  std::optional<Exit> exit_;
  Span end_;
  bool macros_ = false;    ///< of the dialect
  bool straight_ = false;  ///< no O words: nothing leads past the program's end
  bool stopped_ = false;
  bool ran_out_ = false;
};

}  // namespace kadr::gcode
