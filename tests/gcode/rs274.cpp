#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// A valid program over everything that both interpreters run. Positions are taken from #5420.. so that arcs
/// fit whatever the offsets, units and distance mode.
class Generator {
 public:
  explicit Generator(Random& random) : random_(random) {}

  std::string program() {
    text_ = "G21 G90 G94 G17 F1000\n";
    std::string program = text_;
    for (int i = 0; i < 60; ++i) {
      text_.clear();
      (this->*kStatements[random_.below(std::size(kStatements))])();
      if (!text_.empty() && text_[0] != '/' && random_.chance(0.1)) program += fmt::format("N{} ", i);
      program += text_;
    }
    return program + "M2\n";
  }

 private:
  std::string number(double low, double high) { return fmt::format("{:.3f}", random_.real(low, high)); }
  std::string value(double low, double high) {
    switch (random_.below(6)) {
      case 0:
        return fmt::format("[{}+{}]", number(low, high), number(-1, 1));
      case 1:
        return fmt::format("[{}*COS[{}]]", number(low, high), number(-360, 360));
      case 2:
        return fmt::format("[{} MOD {} - #1/3]", number(low, high), number(1, 9));
      case 3:
        return fmt::format("-{}", number(0, high));
      default:
        return number(low, high);
    }
  }
  void straight() {
    text_ += random_.chance(0.5) ? "G1 " : random_.chance(0.5) ? "g0" : "G 0 1 ";
    for (const char letter : {'X', 'Y', 'Z', 'A', 'B', 'C'}) {
      if (random_.chance(0.4)) text_ += letter + value(-50, 50) + " ";
    }
    if (inverse_) text_ += "F" + number(1, 50);
    text_ += "\n";
  }
  /// Word of an axis that lies `delta` from the present point.
  std::string word(char letter, int axis, const std::string& delta) {
    return incremental_ ? fmt::format("{}{} ", letter, delta)
                        : fmt::format("{}[#{}+{}] ", letter, 5420 + axis, delta);
  }
  void arc() {
    const PlaneAxes axes = plane_axes(plane_);
    const char first = kAxisLetters[static_cast<std::size_t>(axes.first)];
    const char second = kAxisLetters[static_cast<std::size_t>(axes.second)];
    std::string line = random_.chance(0.5) ? "G2 " : "G3 ";
    const double radius = random_.real(1, 40);
    const double from = random_.real(0, 6.28), to = from + random_.real(0.2, 6.0);
    const double i = -radius * std::cos(from), j = -radius * std::sin(from);
    const double dx = i + radius * std::cos(to), dy = j + radius * std::sin(to);
    const bool r_format = random_.chance(0.4);
    if (r_format || random_.chance(0.8)) {
      line += word(first, axes.first, fmt::format("{:.6f}", dx)) +
              word(second, axes.second, fmt::format("{:.6f}", dy));
    }
    if (r_format) {
      const double least = std::hypot(dx, dy) / 2;
      line += fmt::format("R{:.6f} ", least * random_.real(1.01, 3) * (random_.chance(0.5) ? 1 : -1));
    } else {
      const auto center = [&](int axis, double offset) {
        const char letter = static_cast<char>('I' + axis);
        return absolute_centers_ ? fmt::format("{}[#{}+{:.6f}] ", letter, 5420 + axis, offset)
                                 : fmt::format("{}{:.6f} ", letter, offset);
      };
      line += center(axes.first, i) + center(axes.second, j);
    }
    if (random_.chance(0.3))
      line += word(kAxisLetters[static_cast<std::size_t>(axes.normal)], axes.normal, number(-5, 5));
    if (random_.chance(0.2)) line += fmt::format("P{} ", 1 + random_.below(4));
    if (random_.chance(0.2)) line += "A" + number(-90, 90);
    if (inverse_) line += " F" + number(1, 50);
    text_ += line + "\n";
  }
  void plane() {
    plane_ = static_cast<Plane>(random_.below(3));
    text_ += plane_ == Plane::xy ? "G17\n" : plane_ == Plane::zx ? "G18\n" : "G19\n";
  }
  // G49 first: the stand-alone rs274 keeps the number of a tool length when its unit changes
  void units() { text_ += random_.chance(0.5) ? "G49\nG20\n" : "G49\nG21\n"; }
  void distance() {
    incremental_ = random_.chance(0.4);
    absolute_centers_ = random_.chance(0.3);
    text_ += fmt::format("{} {}\n", incremental_ ? "G91" : "G90", absolute_centers_ ? "G90.1" : "G91.1");
  }
  void feed_mode() {
    inverse_ = random_.chance(0.3);
    text_ += inverse_ ? "G93\n" : "G94 F" + number(10, 2000) + "\n";
  }
  void feed() {
    if (!inverse_) text_ += "F" + number(1, 3000) + "\n";
  }
  void offsets() {
    const std::string axes = "X" + number(-20, 20) + " Z" + number(-20, 20) + " A" + number(-20, 20);
    switch (random_.below(9)) {
      case 0:
        text_ += fmt::format("G10 L2 P{} {}\n", random_.below(10), axes);
        break;
      case 1:
        text_ += fmt::format("G10 L20 P{} {}\n", random_.below(10), axes);
        break;
      case 2:
        text_ += "G92 " + axes + "\n";
        break;
      case 3:
        text_ += "G92.1\n";
        break;
      case 4:
        text_ += "G92.2\n";
        break;
      case 5:
        text_ += "G92.3\n";
        break;
      case 6:
        text_ += "G43.1 Z" + number(-20, 20) + "\n";
        break;
      case 7:
        text_ += "G49\n";
        break;
      default: {
        static const char* const kSystems[] = {"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"};
        text_ += fmt::format("G{}\n", kSystems[random_.below(9)]);
      }
    }
  }
  void reference() {
    static const char* const kCodes[] = {"G28", "G30", "G28.1", "G30.1"};
    const std::uint64_t which = random_.below(4);
    text_ += kCodes[which];
    if (which < 2 && random_.chance(0.6)) text_ += " Y" + number(-20, 20) + " Z" + number(-5, 5);
    text_ += "\n";
  }
  void machine_coordinates() {
    if (!incremental_) text_ += "G53 G0 X" + number(-20, 20) + " B" + number(-9, 9) + "\n";
  }
  void machine_function() {
    static const char* const kCodes[] = {
        "M3 S500", "M4",       "M5",       "S1234.5", "M7",     "M8",          "M9",           "M0",
        "M1",      "G4 P0.25", "M48",      "M49",     "M50 P0", "M51 P1",      "(MSG, hello)", "G61",
        "G64",     "G61.1",    "G64 P0.1", "(plain)", "; rest", "#1=[#1+1.5]", "/ M9",         "G40 G80 G0"};
    text_ += std::string(kCodes[random_.below(std::size(kCodes))]) + "\n";
  }
  void parameters() {
    text_ += fmt::format("#{}={} #1=[#2*0.5 - {}]\n", 2 + random_.below(3), value(-9, 9), number(-2, 2));
    if (random_.chance(0.5)) text_ += "G0 X#2 Y[#3**2 MOD 7]\n";
  }

  static constexpr void (Generator::*kStatements[])() = {&Generator::straight,
                                                         &Generator::straight,
                                                         &Generator::straight,
                                                         &Generator::arc,
                                                         &Generator::arc,
                                                         &Generator::arc,
                                                         &Generator::plane,
                                                         &Generator::units,
                                                         &Generator::distance,
                                                         &Generator::feed_mode,
                                                         &Generator::feed,
                                                         &Generator::offsets,
                                                         &Generator::offsets,
                                                         &Generator::reference,
                                                         &Generator::machine_coordinates,
                                                         &Generator::machine_function,
                                                         &Generator::machine_function,
                                                         &Generator::parameters};

  Random& random_;
  std::string text_;
  Plane plane_ = Plane::xy;
  bool incremental_ = false, absolute_centers_ = false, inverse_ = false;
};

}  // namespace

TEST_CASE("random valid programs make the same canonical calls as rs274") {
  compare_with_rs274("basic", 60, [](Random& random) {
    TestProgram program;
    program.text = Generator(random).program();
    return program;
  });
}

TEST_CASE("random combinations of words on one line are accepted or refused as rs274 does") {
  static const char* const kWords[] = {
      "G0",    "G1",   "G2",  "G3",   "G4",      "G10",   "G17", "G18",   "G20",   "G21", "G28",
      "G28.1", "G30",  "G40", "G43",  "G43.1",   "G49",   "G53", "G54",   "G59.3", "G61", "G61.1",
      "G64",   "G80",  "G90", "G91",  "G90.1",   "G91.1", "G92", "G92.1", "G92.3", "G93", "X1",
      "Y2",    "Z3",   "A4",  "I1",   "J1",      "K1",    "R5",  "P1",    "P0",    "L2",  "L20",
      "F50",   "S100", "H0",  "Q1",   "D1",      "M3",    "M5",  "M6",    "M7",    "M9",  "M0",
      "M48",   "M50",  "M60", "#1=2", "(MSG,a)", "N7",    "X#1", "F0",    "Y[1/0]"};
  compare_verdict_with_rs274("words", 60, [](Random& random) {
    TestProgram program;
    std::string& text = program.text;
    text = random.chance(0.5) ? "F100 G1 X0\n" : random.chance(0.5) ? "F100 G2 X1 R5\n" : "";
    const std::uint64_t words = 1 + random.below(5);
    for (std::uint64_t k = 0; k < words; ++k)
      text += std::string(kWords[random.below(std::size(kWords))]) + " ";
    text += "\nM2\n";
    return program;
  });
}
