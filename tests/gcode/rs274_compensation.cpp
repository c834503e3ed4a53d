#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "machine/base/numbers.h"
#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// How near to what the tool can't do a contour comes.
struct Difficulty {
  double least_length_radii;  ///< of lines and chords
  double sharpest_inside_deg;
  double sharpest_outside_deg;
};

/// A contour of lines and arcs with the words between them that may stand there.
class ContourGenerator {
 public:
  ContourGenerator(Random& random, const Difficulty& difficulty) : random_(random), difficulty_(difficulty) {}

  TestProgram program() {
    settings();
    const int contours = 1 + static_cast<int>(random_.below(3));
    for (int i = 0; i < contours; ++i) contour(i == 0 || random_.chance(0.8), i + 1 == contours);
    text_ += random_.chance(0.2) ? "M30\n" : "M2\n";
    program_.text = text_;
    return program_;
  }

 private:
  static constexpr double kMillimetres = 25.4;

  double unit_mm() const { return inches_ ? kMillimetres : 1; }
  std::string number(double value) const { return fmt::format("{:.{}f}", value, inches_ ? 5 : 4); }
  /// A length in mm as the program writes it.
  std::string length(double value_mm) const { return number(value_mm / unit_mm()); }
  /// What the program makes of that text.
  double rounded_mm(double value_mm) const { return std::stod(length(value_mm)) * unit_mm(); }

  void settings() {
    zx_ = random_.chance(0.3);
    inches_ = random_.chance(0.2);
    text_ = fmt::format("{} G90 G94 {} F{}\n", inches_ ? "G20" : "G21", zx_ ? "G18" : "G17",
                        number(random_.real(50, 900)));
    if (random_.chance(0.3))
      text_ += fmt::format("G10 L2 P1 X{} Y{} Z{}\n", length(random_.real(-9, 9)),
                           length(random_.real(-9, 9)), length(random_.real(-9, 9)));
    if (random_.chance(0.2)) text_ += "G54 G92 X1 Y2 Z-1\n";
    if (random_.chance(0.15)) text_ += "G43.1 X0.5 Z2\n";
    if (random_.chance(0.15)) text_ += "G10 L2 P1 R" + number(random_.real(-180, 180)) + "\n";
    if (random_.chance(0.2)) text_ += "G64 P0.01\n";
    text_ += "M3 S1000\n";
  }

  std::string point(double first_mm, double second_mm) {
    const double from_first = incremental_ ? first_mm_ : 0, from_second = incremental_ ? second_mm_ : 0;
    const double first = first_mm - from_first, second = second_mm - from_second;
    first_mm_ = from_first + rounded_mm(first);
    second_mm_ = from_second + rounded_mm(second);
    return fmt::format("{}{} {}{} ", zx_ ? 'Z' : 'X', length(first), zx_ ? 'X' : 'Y', length(second));
  }
  std::string off_plane() {
    std::string words;
    if (random_.chance(0.15)) words += fmt::format("{}{} ", zx_ ? 'Y' : 'Z', length(random_.real(-3, 3)));
    if (random_.chance(0.1)) words += (random_.chance(0.5) ? "A" : "C") + number(random_.real(-90, 90)) + " ";
    return words;
  }
  std::string feed_word() {
    if (inverse_) return "F" + number(random_.real(1, 50));
    return random_.chance(0.1) ? "F" + number(random_.real(50, 900)) : "";
  }

  /// @param last  the program may end next to it
  void contour(bool from_new_place, bool last) {
    if (from_new_place) {
      const double start_first = random_.real(-20, 20), start_second = random_.real(-20, 20);
      text_ += "G0 " + point(start_first, start_second) + "\n";
    }
    radius_mm_ = random_.real(0.3, 4);
    left_ = random_.chance(0.5);
    turn_on();
    inverse_ = false;
    heading_rad_ = random_.real(-kPi, kPi);
    // rs274 trims the short line before a lathe tool's entry arc together with the arc
    if (!nose_beside_point_ && from_new_place && random_.chance(0.3)) {
      arc();
    } else {
      line(0);
    }
    const int moves = 3 + static_cast<int>(random_.below(8));
    for (int i = 0; i < moves; ++i) {
      between();
      if (random_.chance(0.4)) {
        arc();
      } else {
        line(corner_rad());
      }
    }
    between();
    if (!last || random_.chance(0.8)) turn_off(last || random_.chance(0.8));
  }

  void turn_on() {
    const bool by_table = random_.chance(0.4);
    const double diameter = rounded_mm(2 * radius_mm_);
    radius_mm_ = diameter / 2;
    std::string words = left_ ? "G41" : "G42";
    if (by_table) {
      const int number = 10 + static_cast<int>(program_.tools.tools.size());
      Tool tool;
      tool.number = tool.pocket = number;
      tool.diameter_mm = diameter;
      tool.orientation = zx_ ? static_cast<int>(random_.below(10)) : random_.chance(0.3) ? 9 : 0;
      nose_beside_point_ = tool.orientation % 9 != 0;
      if (random_.chance(0.1)) {
        tool.diameter_mm = -diameter;
        left_ = !left_;
      }
      program_.tools.tools.push_back(tool);
      program_.diameter_unit_mm = kMillimetres;
      if (random_.chance(0.3)) {
        text_ += fmt::format("T{} M6\n", number);
        if (random_.chance(0.3)) words += " D0";
      } else {
        words += fmt::format(" D{}", number);
      }
    } else {
      words += fmt::format(".1 D{}", length(diameter));
      const std::uint64_t orientation = zx_ && random_.chance(0.6) ? random_.below(10) : 0;
      if (orientation != 0) words += fmt::format(" L{}", orientation);
      nose_beside_point_ = orientation % 9 != 0;
    }
    text_ += words + (random_.chance(0.3) ? " " : "\n");
  }

  /// @param leaves  moves away from the contour, so that an arc may follow
  void turn_off(bool leaves) {
    if (!leaves && !inverse_) {
      text_ += "G40\n";
      return;
    }
    text_ += random_.chance(0.2) ? "G40 " : "G40\n";
    text_ += random_.chance(0.5) ? "G0 " : inverse_ ? "G1 F2 " : "G1 ";
    text_ += point(random_.real(-20, 20), random_.real(-20, 20)) + "\n";
    if (inverse_) text_ += "G94 F100\n";
    inverse_ = false;
  }

  /// Change of direction at a corner: positive to the left.
  double corner_rad() {
    if (random_.chance(0.15)) return 0;
    const bool outside = random_.chance(0.5);
    const double degrees = outside ? random_.real(0, difficulty_.sharpest_outside_deg)
                                   : random_.real(0, difficulty_.sharpest_inside_deg);
    const double towards_left = outside == left_ ? -1 : 1;
    return towards_left * degrees * kPi / 180;
  }
  double chord_mm() {
    return radius_mm_ * random_.real(difficulty_.least_length_radii, difficulty_.least_length_radii + 8);
  }

  void line(double corner) {
    heading_rad_ += corner;
    const double size = chord_mm();
    const double from_first = first_mm_, from_second = second_mm_;
    const std::string words =
        point(first_mm_ + size * std::cos(heading_rad_), second_mm_ + size * std::sin(heading_rad_));
    heading_rad_ = std::atan2(second_mm_ - from_second, first_mm_ - from_first);
    const bool rapid = random_.chance(0.1);
    text_ += (rapid ? "G0 " : "G1 ") + words + off_plane() + (rapid ? "" : feed_word()) + "\n";
  }

  /// An arc that begins with a corner, mostly tangentially.
  void arc() {
    const bool counterclockwise = random_.chance(0.5);
    const double corner = random_.chance(0.6) ? 0 : corner_rad();
    const double turn = counterclockwise ? 1 : -1;
    const bool inside = counterclockwise == left_;
    const double chord = chord_mm();
    const double least = inside ? std::fmax(1.3 * radius_mm_, chord / 2) : chord / 2;
    const double arc_radius = least * random_.real(1.02, 3);
    double sweep = 2 * std::asin(chord / 2 / arc_radius);
    if (random_.chance(0.2)) sweep = 2 * kPi - sweep;
    // the centre lies left of the direction of a counter-clockwise arc
    const double start = heading_rad_ + corner - turn * kPi / 2;
    const double i = rounded_mm(-arc_radius * std::cos(start)), j = rounded_mm(-arc_radius * std::sin(start));
    const double at_first = first_mm_, at_second = second_mm_;
    const double center_first = at_first + i, center_second = at_second + j;
    const double end = start + turn * sweep;
    std::string words = counterclockwise ? "G3 " : "G2 ";
    const double radius = std::hypot(i, j);
    const bool whole = random_.chance(0.05);
    if (!whole) {
      words += point(center_first + radius * std::cos(end), center_second + radius * std::sin(end));
    }
    if (!whole && random_.chance(0.3)) {
      words += "R" + length(sweep > kPi ? -radius : radius) + " ";
    } else {
      const double from_first = absolute_centers_ ? at_first : 0;
      const double from_second = absolute_centers_ ? at_second : 0;
      words += fmt::format("{}{} {}{} ", zx_ ? 'K' : 'I', length(from_first + i), zx_ ? 'I' : 'J',
                           length(from_second + j));
    }
    if (random_.chance(0.1)) words += "P2 ";
    text_ += words + off_plane() + feed_word() + "\n";
    heading_rad_ = std::atan2(second_mm_ - center_second, first_mm_ - center_first) + turn * kPi / 2;
  }

  /// Words between two moves.
  void between() {
    static const char* const kWords[] = {"M3",
                                         "M4",
                                         "M5",
                                         "S200",
                                         "M7",
                                         "M8",
                                         "M9",
                                         "G4 P0.5",
                                         "(a)",
                                         "(MSG,b)",
                                         "(DEBUG,#5420 #5421 #5422)",
                                         "#1=2",
                                         "G97 S300",
                                         "G90.1",
                                         "G91.1",
                                         "G91",
                                         "G90",
                                         "O1 if [1]\nG4 P1\nO1 endif",
                                         "G17"};
    // rs274 scales the point where waiting moves began once for each call that waits: so only one may wait
    if (random_.chance(0.04)) {
      inches_ = !inches_;
      text_ += inches_ ? "G20\n" : "G21\n";
    }
    while (random_.chance(0.25)) {
      const std::string word = kWords[random_.below(std::size(kWords))];
      if (word == "G90" || word == "G91") incremental_ = word == "G91";
      if (word == "G90.1" || word == "G91.1") absolute_centers_ = word == "G90.1";
      text_ += (word == "G17" && zx_ ? "G18" : word) + "\n";
    }
    if (!inverse_ && random_.chance(0.03)) text_ += "G95 F0.3\n";
    if (!inverse_ && random_.chance(0.1)) text_ += "F" + number(random_.real(50, 900)) + "\n";
    if (random_.chance(0.05)) {
      inverse_ = !inverse_;
      text_ += inverse_ ? "G93\n" : "G94 F" + number(random_.real(50, 900)) + "\n";
    }
    if (random_.chance(0.1)) {
      text_ += random_.chance(0.4) ? "G0 " : inverse_ ? "G1 F5 " : "G1 ";
      text_ += fmt::format("{}{}\n", zx_ ? 'Y' : 'Z', length(random_.real(-3, 3)));
    }
    if (random_.chance(0.03)) text_ += "M0\n";
  }

  Random& random_;
  Difficulty difficulty_;
  TestProgram program_;
  std::string text_;
  bool zx_ = false, inches_ = false, inverse_ = false, left_ = true, nose_beside_point_ = false;
  bool incremental_ = false, absolute_centers_ = false;
  double radius_mm_ = 1, first_mm_ = 0, second_mm_ = 0, heading_rad_ = 0;
};

}  // namespace

TEST_CASE("words beside cutter compensation are accepted or refused as rs274 does") {
  static const char* const kWords[] = {"G0",
                                       "G1",
                                       "G2 I1",
                                       "G3 R9",
                                       "X9",
                                       "Y-9",
                                       "Z2",
                                       "A5",
                                       "G17",
                                       "G18",
                                       "G19",
                                       "G40",
                                       "G41",
                                       "G42",
                                       "G41.1",
                                       "G42.1",
                                       "D3",
                                       "D1",
                                       "D0",
                                       "L1",
                                       "L3",
                                       "G43",
                                       "G43.1 Z1",
                                       "G49",
                                       "G54",
                                       "G55",
                                       "G61",
                                       "G64",
                                       "G90",
                                       "G91",
                                       "G90.1",
                                       "G92 X1",
                                       "G92.1",
                                       "G92.2",
                                       "G92.3",
                                       "G52 X1",
                                       "G10 L2 P1 X1",
                                       "G10 L2 P2 X1",
                                       "G10 L20 P1 X1",
                                       "G10 L1 P1 R1",
                                       "G28",
                                       "G28.1",
                                       "G30 Z1",
                                       "G30.1",
                                       "G53",
                                       "G93",
                                       "G94",
                                       "G95",
                                       "F9",
                                       "G98",
                                       "G99",
                                       "G81 Z-1 R1",
                                       "G83 Z-3 R1 Q1",
                                       "G80",
                                       "G38.2 Z-9",
                                       "G5 X9 Y9 I1 J1 P1 Q1",
                                       "G5.1 X9 I1 J1",

                                       "G5.3",
                                       "G33 Z-1 K1",
                                       "G33.1 Z-1 K1",
                                       "G76 P1 Z-9 I-1 J0.3 K1",
                                       "G4 P1",
                                       "G20",
                                       "G21",
                                       "G7",
                                       "G8",
                                       "G96 S9",
                                       "G97 S9",
                                       "M0",
                                       "M1",
                                       "M2",
                                       "M3",
                                       "M5",
                                       "M6",
                                       "T1",
                                       "T1 M6",
                                       "M61 Q1",
                                       "M7",
                                       "M8",
                                       "M9",
                                       "M48",
                                       "M49",
                                       "M50 P0",
                                       "M51 P1",
                                       "M52",
                                       "M53 P1",
                                       "M60",
                                       "M62 P1",
                                       "M64 P1",
                                       "M66 P1 L0",
                                       "M67 E1 Q1",
                                       "M68 E1 Q1",
                                       "M70",
                                       "M71",
                                       "M72",
                                       "M73",
                                       "S50",
                                       "(MSG,a)",
                                       "#1=2",
                                       "G4 P0",
                                       "$0"};
  compare_verdict_with_rs274("compensationwords", 60, [](Random& random) {
    TestProgram program;
    for (const int number : {1, 3}) {
      Tool tool;
      tool.number = tool.pocket = number;
      tool.diameter_mm = number;
      program.tools.tools.push_back(tool);
    }
    program.diameter_unit_mm = 25.4;
    std::string& text = program.text;
    static const char* const kHeads[] = {"F100 S9 M3\nG0 X-20 Y0 Z5\n", "G18 F100 S9 M3\nG0 Z-20 X0\n",
                                         "T1 M6 F100 S9 M3\nG0 X-20\n"};
    const std::size_t head = random.below(std::size(kHeads));
    text = kHeads[head];
    static const char* const kOn[] = {"G41.1 D4\n", "G42.1 D4\n", "G41 D1\n",
                                      "G42 D3\n",   "G41.1 D0\n", "G41\n"};
    text += kOn[random.below(std::size(kOn))];
    const char first = head == 1 ? 'Z' : 'X', second = head == 1 ? 'X' : 'Y';
    const auto words = [&] {
      for (std::uint64_t k = random.chance(0.6) ? 1 + random.below(2) : 0; k > 0; --k)
        text += std::string(kWords[random.below(std::size(kWords))]) + " ";
      text += "\n";
    };
    if (random.chance(0.2)) words();
    text += fmt::format("G1 {}0 {}0\n", first, second);
    words();
    text += fmt::format("{}30 {}1\n", first, second);
    if (random.chance(0.5)) words();
    text += random.chance(0.5) ? "G40\n" : "";
    if (random.chance(0.5)) words();
    text += fmt::format("G0 {}60 {}1\nM2\n", first, second);
    return program;
  });
}

TEST_CASE("random contours that are tight for the tool are run or refused as rs274 does") {
  compare_verdict_with_rs274("compensation_tight", 60, [](Random& random) {
    return ContourGenerator(random, {0.2, 180, 180}).program();
  });
}

TEST_CASE("random compensated contours make the same canonical calls as rs274") {
  compare_with_rs274("compensation", 60, [](Random& random) {
    return ContourGenerator(random, {4, 80, 170}).program();
  });
}
