#include <doctest/doctest.h>

#include <fmt/format.h>

#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Programs of canned cycles: every cycle in every plane, G90 and G91, both units, L, G98 and G99, words left
/// out where they are kept, offsets and settings in between. What the bottom lies at follows from R, so that
/// holes go down.
class CyclePrograms {
 public:
  explicit CyclePrograms(Random& random) : random_(random) {}

  TestProgram make() {
    std::string text = "G21 G90 G94 G17 G99 F1000\nM3 S500\n";
    for (int i = 0; i < 12; ++i) {
      between();
      cycles();
    }
    TestProgram program;
    for (const int number : {1, 2}) {
      Tool tool;
      tool.number = tool.pocket = number;
      tool.offset[2] = 3.0173 * number;
      program.tools.tools.push_back(tool);
    }
    program.text = text + text_ + "M2\n";
    return program;
  }

 private:
  std::string number(double low, double high, int decimals = 3) {
    return fmt::format("{:.{}f}", random_.real(low, high), decimals);
  }
  /// Numbers that depths are often multiples of, so that the last peck ends where the hole does. Under G91
  /// levels are sums: whether an empty peck follows depends on their last bit, which both sides need not share.
  std::string step() {
    if (incremental_) return number(0.2, 3, 4);
    static const char* const kSteps[] = {"0.1", "0.25", "0.3", "0.5", "0.7", "1", "1.1", "1.25", "2", "3"};
    return kSteps[random_.below(std::size(kSteps))];
  }
  void line(const std::string& text) { text_ += text + "\n"; }

  void between() {
    static const char* const kLines[] = {
        "G98",
        "G99",
        "G98",
        "G99",
        "G61",
        "G61.1",
        "G64",
        "G64 P0.05",
        "M49",
        "M48",
        "M50 P0",
        "M51 P0",
        "G80",
        "G0",
        "G94 F250",
        "S1200",
        "G4 P0.1",
        "(comment)",
        "M8",
        "G10 L2 P1 X1",
        "G10 L2 P1 R30 X2",
        "G10 L2 P1 R0",
        "G92 X1 Z0.5",
        "G92.1",
        // not where a level may then be R up to its last bit
        "G43.1 Z2.0173",
        "G49",
        "G55",
        "G54",
        "G28",
        "#1=3",
        "G95 F0.2",
        "G94 F300",
        "G30 Z1",
        "G10 L20 P2 X5 Y1.0003",
        "G0 A30 C-5",
        "G90 G53 G0 Z20",
        "G59.1",
        "G59.3",
        "G52 X1.0137 Y2.0171",
        "G1 X2 Y1",
        // at M6 the stand-alone rs274 forgets a rotation that no move has followed
        "G0 X1 Y1\nT1 M6",
        "G43 H2",
        "M0",
        "M7",
        "(MSG, drill)",
        "G90.1",
        "G91.1",
        "G10 L20 P1 Z3.0171",
        "G28.1",
        "S800 M3",
        "G64 P0.1 Q0.05",
        "M62 P1",
        "M65 P2",
    };
    for (std::uint64_t n = random_.below(4); n > 0; --n) line(kLines[random_.below(std::size(kLines))]);
    if (random_.chance(0.3)) line(random_.chance(0.5) ? "G91" : "G90 G0 X" + number(-9, 9));
    if (random_.chance(0.2)) line("G90");
    if (random_.chance(0.15)) {
      // the stand-alone rs274 keeps the numbers of G43.1 and G64 P when their unit changes
      line("G49\nG64");
      line(random_.chance(0.5) ? "G20" : "G21");
    }
    if (random_.chance(0.4)) {
      static const char* const kPlanes[] = {"G17", "G18", "G19"};
      plane_ = random_.below(3);
      line(kPlanes[plane_]);
    }
    if (random_.chance(0.4)) line("G0 X" + number(-5, 5) + " Y" + number(-5, 9) + " Z" + number(-5, 9));
    // the generator must know which way R and Z count
    incremental_ = random_.chance(0.4);
    line(incremental_ ? "G91" : "G90");
  }

  /// A sequence of one cycle: all words on its first line, then a few of them.
  void cycles() {
    static const char* const kCodes[] = {"G73", "G74", "G81", "G82", "G83", "G84", "G85", "G86", "G89"};
    static const char kAlong[] = {'Z', 'Y', 'X'};
    const std::string code = kCodes[random_.below(std::size(kCodes))];
    const char along = kAlong[plane_];
    if (code == "G74") line("M4");
    if (code == "G84" || code == "G86") line("M3");
    const bool pecks = code == "G73" || code == "G83";
    const bool dwells = code != "G81" && code != "G85" && !pecks;
    const std::uint64_t lines = 1 + random_.below(4);
    const bool loops = random_.chance(0.1);
    for (std::uint64_t i = 0; i < lines; ++i) {
      std::string text = i == 0 || random_.chance(0.2) ? code : "";
      bool axis = false;
      if (loops && i + 1 == lines) line(fmt::format("o{} repeat [{}]", ++labels_, 2 + random_.below(2)));
      if (random_.chance(0.1)) text = "N" + std::to_string(10 * (i + 1)) + " " + text;
      for (const char letter : {'X', 'Y', 'Z'}) {
        if (letter == along || (random_.chance(0.5) && (axis || i == 0 || letter != first_of_plane())))
          continue;
        text += fmt::format(" {}{}", letter, number(-9, 9));
        axis = true;
      }
      if (i == 0 || (random_.chance(0.4) && (axis || true))) {
        const double retract = random_.real(-2, 4);
        text += incremental_ ? fmt::format(" {}-{} R{:.1f}", along, number(0, 6, 1), retract)
                             : fmt::format(" {}{} R{:.1f}", along, number(-9, -2, 1), retract);
      }
      if (pecks && (i == 0 || random_.chance(0.3))) text += " Q" + step();
      if (dwells && ((i == 0 && code != "G74" && code != "G84") || random_.chance(0.3)))
        text += " P" + number(0, 1);
      if (code != "G74" && random_.chance(0.25)) text += fmt::format(" L{}", 1 + random_.below(4));
      if (random_.chance(0.1)) text += " F" + number(50, 900);
      if (random_.chance(0.1)) text += random_.chance(0.5) ? " G98" : " G99";
      if (random_.chance(0.05)) text += " S700";
      if (random_.chance(0.05)) text += " M8 (cool)";
      line(text);
      if (i + 1 < lines && random_.chance(0.15)) interruption();
    }
    if (loops) line(fmt::format("o{} endrepeat", labels_));
    if (random_.chance(0.5)) line("G80");
  }
  /// Between the lines of a sequence, which continues after it.
  void interruption() {
    static const char* const kLines[] = {"G4 P0.1",
                                         "F300",
                                         "S600",
                                         "M8",
                                         "M9",
                                         "(comment)",
                                         "#5=1",
                                         "G98",
                                         "G99",
                                         "M49",
                                         "M48",
                                         "G28.1",
                                         "G61",
                                         "G64",
                                         "G92.2",
                                         "G10 L2 P5 X1",
                                         "G90.1",
                                         "G91.1",
                                         "(DEBUG,#5420 #5422)",
                                         "G94 F90"};
    line(kLines[random_.below(std::size(kLines))]);
  }
  char first_of_plane() const { return "XZY"[plane_]; }

  Random& random_;
  std::string text_;
  std::uint64_t plane_ = 0;
  bool incremental_ = false;
  int labels_ = 100;
};

}  // namespace

TEST_CASE("random programs of canned cycles make the same calls as rs274") {
  compare_with_rs274("cycles", 60, [](Random& random) { return CyclePrograms(random).make(); });
}

TEST_CASE("words beside canned cycles are accepted or refused as rs274 does") {
  static const char* const kWords[] = {"G73", "G74", "G80", "G81", "G82", "G83", "G84", "G85", "G86", "G89",
                                       "G98", "G99", "G18", "G19", "X1",  "Y2",  "Z-3", "Z3",  "Z-3", "R1",
                                       "R1",  "R-9", "Q1",  "Q0",  "P1",  "P0",  "L2",  "L0",  "A1",  "F50",
                                       "F0",  "M3",  "M4",  "M5",  "G91", "G93", "$0",  "I1",  "D1",  "H1",
                                       "G0",  "G53", "G4",  "G28", "G95", "L1",  "G92", "G20", "S9",  "E1"};
  compare_verdict_with_rs274("cyclewords", 60, [](Random& random) {
    TestProgram program;
    std::string& text = program.text;
    text = random.chance(0.8) ? "F100 S100 M3\n" : random.chance(0.5) ? "F100 M4\n" : "";
    static const char* const kStarts[] = {"G81 X1 Z-5 R2 ",
                                          "G83 X1 Z-5 R2 Q1 ",
                                          "G84 X1 Z-5 R2 ",
                                          "G82 Z-5 R2 P1 ",
                                          "G19 G86 X-1 R1 P0 ",
                                          "G73 R3 ",
                                          "G89 Z-1 ",
                                          "X2 ",
                                          "Y1 Z-9 ",
                                          ""};
    for (int lines = 0; lines < 3; ++lines) {
      text += kStarts[random.below(std::size(kStarts))];
      for (std::uint64_t k = random.chance(0.3) ? 1 + random.below(2) : 0; k > 0; --k)
        text += std::string(kWords[random.below(std::size(kWords))]) + " ";
      text += "\n";
    }
    text += "M2\n";
    return program;
  });
}
