#include <doctest/doctest.h>

#include <fmt/format.h>

#include "rs274_oracle.h"
#include "rs274_writer.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

constexpr int kDeepest = 3;                     // loops and conditions within each other
constexpr std::size_t kLongestArguments = 140;  // characters, before the last one
constexpr int kFirstCounter = 20;               // #20 .. count the passes of loops, one for each depth

/// Programs of O-words: every loop counts, and a subroutine calls only those written before
/// it, so that each program ends.
class FlowPrograms {
 public:
  explicit FlowPrograms(Random& random) : w_(random) {}

  TestProgram program() {
    const auto subs = w_.random.below(4);
    for (std::uint64_t i = 0; i < subs; ++i) define(i);
    if (w_.random.chance(0.5)) define_recursive();
    if (w_.random.chance(0.4)) define_in_file();
    w_.named.clear();
    block(12, 0, false);
    program_.text += "M2\n";
    return program_;
  }

 private:
  struct Sub {
    std::string name;  ///< "100" or "<pocket>"
    int arguments = 0;
    bool recursive = false;  ///< #1 is how deep
  };

  void line(const std::string& words) {
    std::string& text = *out_;
    if (w_.random.chance(0.1)) text += fmt::format("N{} ", 10 * ++block_number_);
    text += words + "\n";
  }
  /// "o<name> keyword rest", spelled somehow.
  void o_line(const std::string& label, const std::string& keyword, const std::string& rest = "") {
    *out_ += fmt::format("{}{} {}{}{}{}\n", w_.random.chance(0.8) ? "o" : "O", w_.respelled(label),
                         w_.respelled(keyword), rest.empty() ? "" : " ", rest,
                         w_.random.chance(0.1) ? " (note)" : "");
  }
  std::string new_label() {
    const int number = ++labels_;
    return w_.random.chance(0.7) ? fmt::format("{}", number) : fmt::format("<label {}>", number);
  }

  void define(std::uint64_t index) {
    Sub sub;
    sub.name = w_.random.chance(0.5) ? fmt::format("{}", 100 + index) : fmt::format("<sub_{}>", index);
    sub.arguments = static_cast<int>(w_.random.below(5));
    body(sub);
  }
  void body(const Sub& sub) {
    w_.named.clear();
    o_line(sub.name, "sub");
    current_ = sub.name;
    block(5, 1, true);
    current_.clear();
    // rs274 works out this value where it passes over the definition, too, and reads memory that nobody wrote for a name
    // that no line has set yet
    w_.named.clear();
    const bool returns = w_.random.chance(0.5);
    o_line(sub.name, "endsub", returns ? "[" + w_.expression(1) + "]" : "");
    subs_.push_back(sub);
  }
  void define_recursive() {
    Sub sub;
    sub.name = "<deeper>";
    sub.arguments = 2;
    sub.recursive = true;
    w_.named.clear();
    o_line(sub.name, "sub");
    const std::string label = new_label();
    line("#5=[#1*2] #<own>=#2");
    o_line(label, "if", "[#1 GT 0]");
    o_line(sub.name, "call", "[#1-1] [#2*0.5]");
    line("(debug,back #1 #2 #5 #<own> #<_value> #<_value_returned> #<_call_level>)");
    o_line(label, "else");
    line("G1 X#2 F100");
    o_line(label, "endif");
    o_line(sub.name, "endsub", w_.random.chance(0.7) ? "[#<_value> + #1]" : "");
    subs_.push_back(sub);
  }
  void define_in_file() {
    Sub sub;
    const bool numbered = w_.random.chance(0.3);
    sub.name = numbered ? "900" : "<beside>";
    sub.arguments = static_cast<int>(w_.random.below(4));
    std::string text;
    std::string* before = out_;
    out_ = &text;
    if (w_.random.chance(0.3)) text += "(a file of its own)\n";
    body(sub);
    if (w_.random.chance(0.5)) text += "M2\n";
    out_ = before;
    program_.files[numbered ? "900.ngc" : "beside.ngc"] = text;
  }

  void block(int statements, int depth, bool in_sub) {
    for (int i = 0; i < statements; ++i) statement(depth, in_sub);
  }
  void statement(int depth, bool in_sub) {
    switch (w_.random.below(depth < kDeepest ? 13 : 7)) {
      case 0:
      case 1:
        line(fmt::format("G1 F100 X{} Y{}", w_.word_value(), w_.word_value()));
        break;
      case 2:
      case 3:
        show();
        break;
      case 4:
      case 5: {
        const std::vector<std::string> before = w_.named;
        const std::string target = w_.settable_parameter();
        std::vector<std::string> after = w_.named;
        w_.named = before;
        line(fmt::format("{}=[[{}] MOD 100]", target, w_.expression(1)));
        if (depth <= (in_sub ? 1 : 0)) w_.named = after;  // what a branch sets may not be set behind it
        break;
      }
      case 6:
        call(in_sub);
        break;
      case 7:
      case 8:
        condition(depth, in_sub);
        break;
      default:
        loop(depth, in_sub);
    }
  }
  void show() {
    std::string text = "(debug, #1 #2 #3 #31 #32 #<_call_level> #<_value> #<_value_returned>";
    if (!w_.named.empty()) text += " #<" + w_.pick(w_.named) + ">";
    line(text + ")");
  }
  /// Body of a branch or loop: names set in it are forgotten.
  void inner(int statements, int depth, bool in_sub) {
    const std::vector<std::string> before = w_.named;
    block(statements, depth + 1, in_sub);
    w_.named = before;
  }
  void call(bool in_sub) {
    std::vector<Sub> known = subs_;
    if (known.empty()) return;
    const Sub sub = known[w_.random.below(known.size())];
    if (in_sub && sub.recursive) return;
    std::string arguments;
    const int count = w_.random.chance(0.1) ? 30 : sub.arguments;
    // rs274 reads lines of up to 255 characters
    for (int i = 0; i < count && arguments.size() < kLongestArguments; ++i) {
      const std::string value = sub.recursive && i == 0 ? fmt::format("{}", w_.random.below(5))
                                : count == 30           ? fmt::format("{}", w_.random.below(100))
                                                        : "[" + w_.expression(1) + "] MOD 20";
      arguments += fmt::format("[{}]{}", value, w_.random.chance(0.8) ? " " : "");
    }
    const bool numbered = sub.name[0] != '<';
    if (numbered && w_.random.chance(0.4)) {
      line(fmt::format("#40={}", std::stoi(sub.name) - 7));
      o_line("[#40+7]", "call", arguments);
    } else {
      o_line(sub.name, "call", arguments);
    }
    line("(debug,called #<_value> #<_value_returned> #1 #2 #31)");
  }
  std::string truth() {
    return fmt::format("[{} {} {}]", w_.parameter(), w_.pick({"GT", "LT", "GE", "LE", "EQ", "NE"}),
                       w_.spelled_number(-9, 9));
  }
  void condition(int depth, bool in_sub) {
    const std::string label = new_label();
    o_line(label, "if", truth());
    inner(1 + static_cast<int>(w_.random.below(2)), depth, in_sub);
    while (w_.random.chance(0.3)) {
      o_line(label, "elseif", truth());
      inner(1, depth, in_sub);
    }
    if (w_.random.chance(0.5)) {
      o_line(label, "else");
      inner(1, depth, in_sub);
    }
    if (in_sub && !current_.empty() && w_.random.chance(0.15)) {
      o_line(current_, "return", w_.random.chance(0.6) ? "[" + w_.expression(1) + "]" : "");
    }
    o_line(label, "endif");
  }
  /// Leaves the loop or begins its next pass, at some pass.
  void leave(const std::string& label, int counter) {
    if (!w_.random.chance(0.4)) return;
    const std::string test = new_label();
    o_line(test, "if", fmt::format("[#{} EQ {}]", counter, 1 + w_.random.below(4)));
    o_line(label, w_.random.chance(0.5) ? "break" : "continue");
    o_line(test, "endif");
  }
  void loop(int depth, bool in_sub) {
    const std::string label = new_label();
    const int counter = kFirstCounter + depth;
    const auto passes = w_.random.below(4);
    const std::string goes_on = fmt::format("[#{} LT {}]", counter, passes);
    const std::string count = fmt::format("#{0}=[#{0}+1]", counter);
    line(fmt::format("#{}=0", counter));
    switch (w_.random.below(3)) {
      case 0:
        o_line(label, "while", goes_on);
        line(count);
        inner(1, depth, in_sub);
        leave(label, counter);
        inner(1, depth, in_sub);
        o_line(label, "endwhile");
        break;
      case 1:
        o_line(label, "do");
        line(count);
        inner(1, depth, in_sub);
        leave(label, counter);
        inner(1, depth, in_sub);
        o_line(label, "while", goes_on);
        break;
      default:
        o_line(label, "repeat",
               fmt::format("[{}]", w_.random.chance(0.8) ? fmt::format("{}", passes) : "#31 MOD 4"));
        inner(2, depth, in_sub);
        o_line(label, "endrepeat");
    }
  }

  Writer w_;
  TestProgram program_;
  std::string* out_ = &program_.text;
  std::vector<Sub> subs_;
  std::string current_;
  int labels_ = 0, block_number_ = 0;
};

/// Main program and numbered subprograms behind it: M98, M99.
class FanucPrograms {
 public:
  explicit FanucPrograms(Random& random) : w_(random) {}

  TestProgram program() {
    const auto subprograms = 1 + w_.random.below(3);
    std::string& text = program_.text;
    if (w_.random.chance(0.5)) text += w_.random.chance(0.5) ? "O1 (main)\n" : "o 1\n";
    statements(0, subprograms);
    text += w_.random.chance(0.5) ? "M30\n" : "M2\n";
    for (std::uint64_t i = 1; i <= subprograms; ++i) {
      text += fmt::format("O{}{}\n", 100 * i, w_.random.chance(0.3) ? " (part)" : "");
      statements(i, subprograms);
      text += w_.random.chance(0.2) ? "m 99\n" : "M99\n";
    }
    return program_;
  }

 private:
  /// A subprogram calls only those behind it, so that each program ends.
  void statements(std::uint64_t index, std::uint64_t last) {
    std::string& text = program_.text;
    for (int i = 0; i < 5; ++i) {
      switch (w_.random.below(5)) {
        case 0:
          text += "G1 F100 X" + w_.word_value() + "\n";
          break;
        case 1:
          text += fmt::format("#{}=[#1 + {}]\n", 1 + w_.random.below(3), w_.spelled_number(-9, 9));
          break;
        case 2:
          text += "(debug,#1 #2 #3 #<_call_level>)\n";
          break;
        default:
          if (index >= last) break;
          text += fmt::format("M98 P{}", 100 * (index + 1 + w_.random.below(last - index)));
          // not L0: the stand-alone rs274 skips the call but returns from it at the next M99
          if (w_.random.chance(0.5)) text += fmt::format(" L{}", 1 + w_.random.below(4));
          text += "\n";
      }
    }
  }

  Writer w_;
  TestProgram program_;
};

}  // namespace

TEST_CASE("O-words lead through a program as in rs274") {
  compare_with_rs274("flow", 40, [](Random& random) { return FlowPrograms(random).program(); });
}

TEST_CASE("numbered subprograms are called as in rs274") {
  compare_with_rs274("fanuc", 20, [](Random& random) { return FanucPrograms(random).program(); });
}
