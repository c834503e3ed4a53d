#include <doctest/doctest.h>

#include <fmt/format.h>

#include "macro_support.h"

/// Random programs written twice, in macro B and in O words: kadr's reading of LinuxCNC, which is compared with rs274,
/// is the oracle for its reading of macro B.
namespace {

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

struct Twins {
  std::string macro, o_words;
};

/// Variables: #1 to #3 arguments, #11 to #16 and #101 to #106 values, #21 to #29 counters. All values are multiples of
/// 1/4, so that both compare them alike.
class TwinMaker {
 public:
  explicit TwinMaker(Random& random) : random_(random) {}

  Twins make() {
    both("G21 G90 G0 F100");
    for (int v = 11; v <= 16; ++v) set(v, number());
    for (int v = 101; v <= 106; ++v) set(v, number());
    block(3, true);
    both("M30");
    for (int sub = 1; sub <= kSubs; ++sub) {
      twins_.macro += fmt::format("O{}\n", 9000 + sub);
      twins_.o_words += fmt::format("o{} sub\n", 9000 + sub);
      for (int v = 11; v <= 16; ++v) set(v, "#" + std::to_string(1 + random_.below(3)));
      loops_ = 0;
      // a subprogram calls those behind it
      first_callable_ = sub + 1;
      block(2, true);
      twins_.macro += "M99\n";
      twins_.o_words += fmt::format("o{} endsub\n", 9000 + sub);
    }
    return twins_;
  }

 private:
  static constexpr int kSubs = 3;

  void both(const std::string& line) {
    twins_.macro += line + "\n";
    twins_.o_words += line + "\n";
  }
  std::string number() { return fmt::format("{}", 0.25 * static_cast<double>(random_.below(200)) - 20); }
  int variable() {
    return static_cast<int>(random_.chance(0.5) ? 11 + random_.below(6) : 101 + random_.below(6));
  }
  /// One text for both; `depth` operators at most.
  std::string expression(int depth) {
    if (depth == 0 || random_.chance(0.3))
      return random_.chance(0.4) ? number() : fmt::format("#{}", variable());
    switch (random_.below(6)) {
      case 0:
        return fmt::format("[{}]", expression(depth - 1));
      case 1:
        return fmt::format("ABS[{}]", expression(depth - 1));
      case 2:
        return fmt::format("{}[{}]", in_word_ ? "ABS" : "ROUND", expression(depth - 1));
      case 3:
        return fmt::format("-[{}]", expression(depth - 1));
      default: {
        static const char* const kSigns[] = {"+", "-", "*"};
        return fmt::format("{} {} {}", expression(depth - 1), kSigns[random_.below(3)],
                           expression(depth - 1));
      }
    }
  }
  /// Kept small, so that products of products do not grow without bound.
  void set(int variable, const std::string& value) {
    twins_.macro += random_.chance(0.7) ? fmt::format("#{}={}\n", variable, value)
                                        : fmt::format("#{}=[{}]\n", variable, value);
    twins_.o_words += fmt::format("#{}=[{}]\n", variable, value);
    const std::string bound = fmt::format("[ABS[#{}] GT 1000]", variable);
    const int label = ++labels_;
    twins_.macro += fmt::format("IF {} THEN #{}=1.5\n", bound, variable);
    twins_.o_words += fmt::format("o{0} if {1}\n#{2}=1.5\no{0} endif\n", label, bound, variable);
  }
  struct Condition {
    std::string holds, fails;
  };
  Condition condition() {
    static const char* const kSigns[][2] = {{"LT", "GE"}, {"GT", "LE"}, {"EQ", "NE"}};
    const std::size_t kind = random_.below(3);
    const auto* signs = kSigns[kind];
    const std::size_t turned = random_.below(2);
    // LinuxCNC takes values closer than 1e-4 for equal
    const char* whole = kind == 2 ? "ROUND" : "";
    const std::string a = fmt::format("{}[{}]", whole, expression(1));
    const std::string b = fmt::format("{}[{}]", whole, expression(1));
    return {fmt::format("[{} {} {}]", a, signs[turned], b),
            fmt::format("[{} {} {}]", a, signs[1 - turned], b)};
  }
  void move() {
    static const char* const kLetters[] = {"X", "Y", "Z", "U"};
    std::string line = random_.chance(0.5) ? "G1" : "G0";
    const std::uint64_t first = random_.below(4);
    in_word_ = true;  // where ROUND of macro B goes to 0.001
    line += fmt::format(" {}[{}]", kLetters[first], expression(2));
    in_word_ = false;
    line += fmt::format(" {}#{}", kLetters[(first + 1) % 4], variable());
    both(line);
  }
  void block(int depth, bool calls) {
    for (std::uint64_t i = 1 + random_.below(4); i > 0; --i) statement(depth, calls);
  }
  void statement(int depth, bool calls) {
    const std::uint64_t kind = random_.below(depth > 0 ? 8 : 3);
    if (kind == 0 || kind == 1) return move();
    if (kind == 2) return set(variable(), expression(2));
    if (kind == 3) return branch(depth);
    if (kind == 4) return counted_while(depth);
    if (kind == 5) return counted_jump(depth);
    if (kind == 6) return guarded();
    if (calls) call();
  }
  /// IF [not] GOTO n ... Nn
  void branch(int depth) {
    const Condition c = condition();
    const int label = ++labels_;
    const bool otherwise = random_.chance(0.5);
    twins_.macro += fmt::format("IF {} GOTO {}\n", c.fails, label);
    twins_.o_words += fmt::format("o{} if {}\n", label, c.holds);
    block(depth - 1, false);
    if (otherwise) {
      const int end = ++labels_;
      twins_.macro += fmt::format("GOTO {}\nN{}\n", end, label);
      twins_.o_words += fmt::format("o{} else\n", label);
      block(depth - 1, false);
      twins_.macro += fmt::format("N{}\n", end);
    } else {
      twins_.macro += fmt::format("N{}\n", label);
    }
    twins_.o_words += fmt::format("o{} endif\n", label);
  }
  void counted_while(int depth) {
    if (loops_ == 3) return move();
    const int loop = ++loops_;
    const int label = ++labels_;
    const int times = static_cast<int>(random_.below(4));
    const int count = 20 + 3 * loop;
    both(fmt::format("#{}=0", count));
    twins_.macro += fmt::format("WHILE [#{} LT {}] DO{}\n", count, times, loop);
    twins_.o_words += fmt::format("o{} while [#{} LT {}]\n", label, count, times);
    block(depth - 1, false);
    count_up(count);
    twins_.macro += fmt::format("END{}\n", loop);
    twins_.o_words += fmt::format("o{} endwhile\n", label);
    --loops_;
  }
  /// Nn ... IF [..] GOTO n
  void counted_jump(int depth) {
    if (loops_ == 3) return move();
    const int loop = ++loops_;
    const int label = ++labels_;
    const int times = 1 + static_cast<int>(random_.below(3));
    const int count = 20 + 3 * loop;
    both(fmt::format("#{}=0", count));
    twins_.macro += fmt::format("N{}\n", label);
    twins_.o_words += fmt::format("o{} do\n", label);
    block(depth - 1, false);
    count_up(count);
    const bool computed = random_.chance(0.3);
    twins_.macro += computed ? fmt::format("IF [#{} LT {}] GOTO [{}+1]\n", count, times, label - 1)
                             : fmt::format("IF [#{} LT {}] GOTO {}\n", count, times, label);
    twins_.o_words += fmt::format("o{} while [#{} LT {}]\n", label, count, times);
    --loops_;
  }
  void count_up(int count) {
    twins_.macro += fmt::format("#{0}=#{0}+1\n", count);
    twins_.o_words += fmt::format("#{0}=[#{0}+1]\n", count);
  }
  void guarded() {
    const Condition c = condition();
    const int target = variable();
    const std::string value = number();
    const int label = ++labels_;
    twins_.macro += fmt::format("IF {} THEN #{}={}\n", c.holds, target, value);
    twins_.o_words += fmt::format("o{0} if {1}\n#{2}={3}\no{0} endif\n", label, c.holds, target, value);
  }
  void call() {
    if (first_callable_ > kSubs) return move();
    const int sub = 9000 + first_callable_ + static_cast<int>(random_.below(kSubs - first_callable_ + 1));
    const std::string a = expression(1), b = expression(1), c = expression(1);
    twins_.macro += fmt::format("G65 P{} A[{}] B[{}] C[{}]\n", sub, a, b, c);
    twins_.o_words += fmt::format("o{} call [{}] [{}] [{}]\n", sub, a, b, c);
  }

  Random& random_;
  Twins twins_;
  bool in_word_ = false;
  int labels_ = 0;
  int loops_ = 0;
  int first_callable_ = 1;
};

}  // namespace

TEST_CASE("random programs of macro B do what the same programs in O words do") {
  Random random(seed());
  std::size_t moves = 0;
  for (std::uint64_t i = 0; i < count(400); ++i) {
    const Twins twins = TwinMaker(random).make();
    CAPTURE(twins.macro);
    CAPTURE(twins.o_words);
    const Outcome expected = run(twins.o_words);
    CAPTURE(expected.rendered);
    REQUIRE_FALSE(expected.diagnostics.has_errors());
    const Outcome outcome = run(twins.macro, random.chance(0.5) ? of_fanuc() : of_haas());
    CAPTURE(outcome.rendered);
    REQUIRE_FALSE(outcome.diagnostics.has_errors());
    REQUIRE(outcome.trace == expected.trace);
    moves += outcome.moves().size();
  }
  CHECK(moves > count(400));
}
