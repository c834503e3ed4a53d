#include <doctest/doctest.h>

#include <fmt/format.h>

#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Programs of a lathe: threads of every kind, feeds per turn, surface speeds, in both units, distance modes
/// and directions of the spindle.
class ThreadPrograms {
 public:
  explicit ThreadPrograms(Random& random) : random_(random) {}

  TestProgram make() {
    text_ = "G21 G90 G94 G18 F300\nM3 S500\n";
    for (int i = 0; i < 14; ++i) {
      between();
      switch (random_.below(4)) {
        case 0:
          threads();
          break;
        case 1:
          thread_cycle();
          break;
        case 2:
          feeds();
          break;
        default:
          cuts();
          break;
      }
    }
    TestProgram program;
    program.text = text_ + "M2\n";
    return program;
  }

 private:
  std::string number(double low, double high, int decimals = 3) {
    return fmt::format("{:.{}f}", random_.real(low, high), decimals);
  }
  void line(const std::string& text) { text_ += text + "\n"; }
  std::string maybe(double chance, const std::string& text) { return random_.chance(chance) ? text : ""; }

  void between() {
    // no M49: rs274 enables the feed override after G76 even so
    static const char* const kLines[] = {"G17",
                                         "G18",
                                         "G19",
                                         "G61",
                                         "G64 P0.01",
                                         "M3",
                                         "M4 S250",
                                         "S800",
                                         "G92 Z1 X2",
                                         "G55",
                                         "G54",
                                         "M8",
                                         "G10 L2 P1 Z-3",
                                         "G10 L2 P2 X.5",
                                         "G43.1 Z1",
                                         "G49",
                                         "G92.1",
                                         "#1=2",
                                         "G8",
                                         "G7",
                                         "G59.2",
                                         "G10 L2 P9 X1 Z-2",
                                         "G52 Z2",
                                         "M7",
                                         "M9",
                                         "G4 P0.2",
                                         "M48",
                                         "M51 P1",
                                         "G64",
                                         "G61.1",
                                         "(cut)",
                                         "G28.1",
                                         "G90.1",
                                         "G91.1",
                                         "G40",
                                         "G80",
                                         "M53 P1",
                                         "G10 L20 P1 X12"};
    for (std::uint64_t n = random_.below(3); n > 0; --n) line(kLines[random_.below(std::size(kLines))]);
    if (random_.chance(0.3)) {
      incremental_ = random_.chance(0.5);
      line(incremental_ ? "G91" : "G90");
    }
    // the stand-alone rs274 keeps the number of a length when its unit changes
    if (random_.chance(0.15)) line(random_.chance(0.5) ? "G49\nG20" : "G49\nG21");
  }

  void threads() {
    for (std::uint64_t n = 1 + random_.below(3); n > 0; --n) {
      if (random_.chance(0.7)) {
        line("G33 Z" + number(-9, 9) + maybe(0.3, " X" + number(-5, 5)) + maybe(0.1, " A" + number(-9, 9)) +
             " K" + number(0.1, 3) + maybe(0.2, " $0"));
        if (random_.chance(0.3)) line("Z" + number(-9, 9) + " K" + number(0.1, 2));
      } else {
        line("G33.1 Z" + number(-9, 9) + maybe(0.2, " Y" + number(-5, 5)) + " K" + number(0.1, 3) +
             maybe(0.3, " I" + number(0.5, 4)) + maybe(0.1, " X" + number(-5, 5)));
      }
    }
  }

  void thread_cycle() {
    if (random_.chance(0.7)) line("G0 X" + number(8, 20) + " Z" + number(-3, 9));
    const double first = random_.real(0.05, 0.5);
    std::string text = fmt::format("G76 P{} Z{} I{} J{:.3f} K{:.3f}", number(0.2, 4), number(-30, 20),
                                   number(0.1, 2).insert(0, random_.chance(0.5) ? "-" : ""), first,
                                   first * random_.real(1.01, 3));
    text += maybe(0.5, " R" + number(1, 3, 1)) + maybe(0.5, " Q" + number(-35, 35, 1));
    text += maybe(0.3, fmt::format(" H{}", random_.below(4))) + maybe(0.1, " $0");
    text += maybe(0.5, fmt::format(" E{} L{}", number(0.05, 3), random_.below(4)));
    text += maybe(0.1, " X" + number(5, 9)) + maybe(0.1, " Y" + number(-2, 2)) +
            maybe(0.1, " F" + number(90, 200));
    line(text);
  }

  void feeds() {
    switch (random_.below(6)) {
      case 0:
        line("G94 F" + number(50, 500));
        break;
      case 1:
      case 2:
        line("G95 F" + number(0.05, 0.5));
        break;
      case 3:
        line("G96 S" + number(20, 300) + maybe(0.5, " D" + number(-900, 2000)));
        break;
      case 4:
        line("G97 S" + number(100, 900));
        break;
      default:
        line("G97");
        break;
    }
  }

  void cuts() {
    line("G1 X" + number(-9, 9) + maybe(0.5, " Z" + number(-9, 9)));
    if (!incremental_ && random_.chance(0.4)) line("G18 G2 X[#5420+1] Z[#5422+1] R1.5");
    if (random_.chance(0.3)) line("G0 Z" + number(-9, 9));
  }

  Random& random_;
  std::string text_;
  bool incremental_ = false;
};

}  // namespace

TEST_CASE("random programs of threads and feeds per turn make the same calls as rs274") {
  compare_with_rs274("threads", 60, [](Random& random) { return ThreadPrograms(random).make(); });
}

TEST_CASE("words beside threads, feed modes and surface speeds are accepted or refused as rs274 does") {
  static const char* const kWords[] = {
      "G33",  "G33.1", "G76",  "G95",  "G96", "G97", "G94", "G93",  "G1",  "G0",  "X20", "Z-9", "Z-9", "K1.5",
      "K1.5", "K0.9",  "J0.3", "J0.3", "I-1", "I-1", "P1",  "P1.5", "R2",  "Q29", "H2",  "E1",  "L3",  "$0",
      "$1",   "F2",    "S90",  "D500", "M3",  "M5",  "A5",  "Y1",   "G80", "G91", "G4",  "R0.5"};
  compare_verdict_with_rs274("threadwords", 60, [](Random& random) {
    TestProgram program;
    std::string& text = program.text;
    text = random.chance(0.8) ? "F100 S100 M3 G18\nG0 X20 Z5\n" : "F100 S100\n";
    if (random.chance(0.2)) text += "G95 F1\n";
    static const char* const kStarts[] = {"G33 Z-5 K1 ", "G76 Z-9 P1 I-1 J0.3 K1 ", "G96 ", "G33.1 Z-5 K1 ",
                                          ""};
    for (int lines = 0; lines < 2; ++lines) {
      text += kStarts[random.below(std::size(kStarts))];
      for (std::uint64_t k = random.chance(0.3) ? 1 + random.below(2) : 0; k > 0; --k)
        text += std::string(kWords[random.below(std::size(kWords))]) + " ";
      text += "\n";
    }
    text += "G1 X1\nM2\n";
    return program;
  });
}
