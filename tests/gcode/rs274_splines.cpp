#include <doctest/doctest.h>

#include <fmt/format.h>

#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Splines and probing moves among straight ones, in every distance mode, unit and work system. rs274 prints
/// no points of a spline: where it ended shows in the single-axis moves behind it.
class CurvePrograms {
 public:
  explicit CurvePrograms(Random& random) : random_(random) {}

  TestProgram make() {
    text_ = "G21 G90 G94 G17 F300\n";
    line("G5 X1 Y1 I0 J1 P0 Q-1");
    for (int i = 0; i < 14; ++i) {
      between();
      switch (random_.below(5)) {
        case 0:
          cubics();
          break;
        case 1:
          line("G5.1" + end(0.8) + " I" + number(-9, 9) + " J" + number(-9, 9));
          break;
        case 2:
          nurbs();
          break;
        case 3:
          probe();
          break;
        default:
          line("G1" + end(0.7) + maybe(0.3, " Z" + number(-9, 9)));
          break;
      }
      line((random_.chance(0.5) ? "G0 X" : "G1 Y") + number(-9, 9));
    }
    TestProgram program;
    program.text = text_ + "M2\n";
    return program;
  }

 private:
  std::string number(double low, double high) { return fmt::format("{:.3f}", random_.real(low, high)); }
  void line(const std::string& text) { text_ += text + "\n"; }
  std::string maybe(double chance, const std::string& text) { return random_.chance(chance) ? text : ""; }
  /// X, Y or both.
  std::string end(double both) {
    if (random_.chance(both)) return " X" + number(-9, 9) + " Y" + number(-9, 9);
    return (random_.chance(0.5) ? " X" : " Y") + number(-9, 9);
  }

  void between() {
    static const char* const kLines[] = {"G61",
                                         "G64 P0.01",
                                         "M3 S500",
                                         "G92 X1 Y2",
                                         "G55",
                                         "G54",
                                         "M8",
                                         "G10 L2 P1 X3 R30",
                                         "G10 L2 P2 Y4",
                                         "G43.1 Z1 X2",
                                         "G49",
                                         "G92.1",
                                         "F250",
                                         "G10 L2 P2 R-15 Z0.5",
                                         "G52 X1 Y-1",
                                         "M9",
                                         "G59.1",
                                         "G92.2",
                                         "G92.3",
                                         "G61.1",
                                         "G4 P0.1",
                                         "M49",
                                         "M48",
                                         "(spline)",
                                         "G90.1",
                                         "G91.1",
                                         "S300",
                                         "G10 L20 P1 X1 Y-2",
                                         "G28.1",
                                         "G0 A20 C3",
                                         "G17",
                                         "M7",
                                         "(DEBUG,#5420 #5421)",
                                         "G94 F300",
                                         "S400 G95 F0.4",
                                         "G94 F120",
                                         "N20 G40",
                                         "G80",
                                         "#3=1"};
    for (std::uint64_t n = random_.below(3); n > 0; --n) line(kLines[random_.below(std::size(kLines))]);
    if (random_.chance(0.3)) line(random_.chance(0.5) ? "G91" : "G90");
    // the stand-alone rs274 keeps the number of a length when its unit changes
    if (random_.chance(0.1)) line(random_.chance(0.5) ? "G49\nG20" : "G49\nG21");
  }

  void cubics() {
    for (std::uint64_t n = 1 + random_.below(3); n > 0; --n) {
      const std::string first = maybe(0.6, " I" + number(-9, 9) + " J" + number(-9, 9));
      line("G5" + end(0.8) + first + " P" + number(-9, 9) + " Q" + number(-9, 9) +
           maybe(0.1, " F" + number(90, 200)));
    }
  }

  void nurbs() {
    const std::uint64_t order = 3 + random_.below(5);
    std::string head = "G5.2";
    if (random_.chance(0.7)) head += " P" + number(0.2, 3);
    if (order != 3 || random_.chance(0.3)) head += fmt::format(" L{}", order);
    if (random_.chance(0.2)) head += " X" + number(-9, 9) + " Y" + number(-9, 9);
    line(head);
    for (std::uint64_t n = order - 1 + random_.below(4); n > 0; --n)
      line("X" + number(-9, 9) + " Y" + number(-9, 9) + " P" + number(0.2, 3));
    if (random_.chance(0.2)) line("(weights)\n#7=1");
    line("G5.3");
  }

  /// rs274 stands 0.254 mm before the contact: the next move names X, Y and Z.
  void probe() {
    line("G90 G94 F150");
    line("G38." + std::to_string(2 + random_.below(4)) + " Z" + number(10, 20) +
         maybe(0.3, " X" + number(-9, 9)));
    line("G0 X" + number(-9, 9) + " Y" + number(-9, 9) + " Z" + number(-9, 9));
    if (random_.chance(0.5)) line("#1=[#5063+#5061]\nG1 X[#5063/2] Y[#5061]\nG1 Z#1");
  }

  Random& random_;
  std::string text_;
};

}  // namespace

TEST_CASE("random programs of splines and probing moves make the same calls as rs274") {
  compare_with_rs274("curves", 60, [](Random& random) { return CurvePrograms(random).make(); });
}

TEST_CASE("words beside splines and probing moves are accepted or refused as rs274 does") {
  static const char* const kWords[] = {"G5", "G5.1", "G5.3", "G38.2", "G93", "G95", "G94", "G1",  "G0", "X2",
                                       "Y3", "X-2",  "Y-3",  "I1",    "J2",  "P1",  "Q2",  "K1",  "R2", "L3",
                                       "L2", "L4",   "P0.5", "F50",   "S90", "M3",  "G53", "G91", "G4", "H1",
                                       "D1", "P-1",  "P0",   "Z-1",   "A5",  "M9",  "G80", "G17", "T1", "E1"};
  compare_verdict_with_rs274("curvewords", 60, [](Random& random) {
    TestProgram program;
    std::string& text = program.text;
    text = random.chance(0.8) ? "F100\nG0 X20 Z5\n" : "G0 Z5\n";
    static const char* const kStarts[] = {"G5 X3 Y1 I1 J1 P1 Q1 ",
                                          "G5 X3 P1 Q1 ",
                                          "G5.1 X4 I1 J1 ",
                                          "G5.2 P1\nX1 Y1 P1\nX2 Y2 P1\nG5.3 ",
                                          "G38.2 ",
                                          "G38.5 ",
                                          ""};
    for (int lines = 0; lines < 2; ++lines) {
      const std::string start = kStarts[random.below(std::size(kStarts))];
      text += start;
      // rs274 stands before the contact, so the same point would be no error there
      if (start.size() == 6) text += fmt::format("Z-{} ", lines + 5);
      const bool ends_nurbs = start.find("G5.3") != std::string::npos;
      for (std::uint64_t k = random.chance(0.5) ? 1 + random.below(2) : 0; k > 0; --k) {
        const std::string word = kWords[random.below(std::size(kWords))];
        // rs274 does something with some axis words behind G5.3 that makes no sense; kadr refuses them, and
        // a curve whose feed the line of G5.3 takes away
        const bool senseless =
            std::string("XYZA").find(word[0]) != std::string::npos || word == "G94" || word == "G95";
        if (!ends_nurbs || !senseless) text += word + " ";
      }
      text += "\n";
    }
    text += "G1 X1 F10\nM2\n";
    return program;
  });
}
