#include <doctest/doctest.h>

#include <fmt/format.h>

#include <vector>

#include "rs274_oracle.h"
#include "rs274_writer.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

constexpr int kStatementsEach = 40;

/// Programs of nothing but offsets and short moves: whatever one offset does to another shows in the next
/// move, which names some axes only.
class OffsetPrograms {
 public:
  explicit OffsetPrograms(Random& random) : w_(random) {}

  TestProgram program() {
    TestProgram program;
    for (const int number : {1, 2, 12}) {
      Tool tool;
      tool.number = number;
      tool.pocket = number;
      for (const std::size_t axis : {0, 1, 2}) {
        if (w_.random.chance(0.6)) tool.offset[axis] = eighths();
      }
      program.tools.tools.push_back(tool);
    }
    // with an empty spindle the stand-alone rs274 takes the first changed tool for the one in it
    text_ = "G21 G90 G17 F500\nG0 T" + tool_number() + " M6\n";
    for (int i = 0; i < kStatementsEach; ++i) statement();
    program.text = text_ + "M2\n";
    return program;
  }

 private:
  double eighths() { return static_cast<double>(w_.random.below(320)) / 8 - 20; }
  std::string words(const std::string& letters, double chance) {
    std::string out;
    for (const char letter : letters) {
      if (w_.random.chance(chance)) out += fmt::format("{}{} ", letter, w_.number(-30, 30));
    }
    return out;
  }
  /// At least one axis word.
  std::string some(const std::string& letters) {
    std::string out = words(letters, 0.4);
    return out.empty() ? fmt::format("{}{} ", letters[w_.random.below(letters.size())], w_.number(-9, 9))
                       : out;
  }
  std::string tool_number() { return w_.pick({"1", "2", "12"}); }
  std::string system() { return fmt::format("P{} ", w_.random.below(10)); }
  std::string angle() { return w_.pick({"0", "90", "180", "-90", "30", "-45.5", w_.number(-360, 360)}); }

  void statement() {
    switch (w_.random.below(20)) {
      case 0:
        text_ += "G10 L2 " + system() + words("XYZABC", 0.4) + "\n";
        break;
      case 1:
        text_ += "G10 L2 " + system() + words("XYZ", 0.4) + "R" + angle() + "\n";
        break;
      case 2:
        text_ += "G10 L20 " + system() + words("XYZABC", 0.4) + "\n";
        break;
      case 3:
        text_ += "G92 " + some("XYZABC") + "\n";
        break;
      case 4:
        text_ += "G52 " + some("XYZABC") + "\n";
        break;
      case 5:
        text_ += w_.pick({"G92.1", "G92.2", "G92.3"}) + "\n";
        break;
      case 6:
        text_ += "G" + w_.pick({"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"}) + "\n";
        break;
      case 7:
        text_ += w_.pick({"G28 ", "G30 "}) + words("XYZABC", 0.3) + "\n";
        break;
      case 8:
        text_ += w_.pick({"G28.1\n", "G30.1\n"});
        break;
      case 9:
        text_ += "G90 G53 " + w_.pick({"G0 ", "G1 "}) + words("XYZABC", 0.5) + "\n";
        break;
      case 10:
        length();
        break;
      case 11:
        table();
        break;
      case 12:
        // the stand-alone rs274 keeps the number of a tool length when its unit changes, and takes the
        // position after M6 from the last move
        text_ += w_.pick({"G49\nG20\n", "G49\nG21\n", "G0\nT" + tool_number() + " M6\n", "G0\nM6\n"});
        break;
      case 13:
        text_ += w_.pick({"G90\n", "G91\n"});
        break;
      case 14:
        text_ += "G0 X[#5420+1] Y[#5421/2] Z[#5422-#5220] A[#5423+#5210]\n";
        break;
      default:
        text_ += w_.pick({"G0 ", "G1 ", ""}) + some("XYZABC") + "\n";
    }
  }
  void length() {
    text_ += w_.pick({"G43 H" + tool_number(), "G43", "G43 H0", "G49", "G43.1 " + words("XYZ", 0.5),
                      "G43.2 H" + tool_number(), "G43.2 H0"}) +
             "\n";
  }
  void table() {
    const std::string tool = "P" + tool_number() + " ";
    text_ += w_.pick({"G10 L1 ", "G10 L10 ", "G10 L11 "}) + tool + some("XYZ") + "\n";
  }

  Writer w_;
  std::string text_;
};

}  // namespace

TEST_CASE("offsets of tools and work systems act on each other as in rs274") {
  compare_with_rs274("offsets", 60, [](Random& random) { return OffsetPrograms(random).program(); });
}
