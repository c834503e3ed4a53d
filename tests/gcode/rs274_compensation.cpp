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
    const int contours = 1 + static_cast<int>(random_.below(2));
    for (int i = 0; i < contours; ++i) contour();
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
    if (random_.chance(0.2)) text_ += "G64 P0.01\n";
    text_ += "M3 S1000\n";
  }

  std::string point(double first_mm, double second_mm) {
    first_mm_ = rounded_mm(first_mm);
    second_mm_ = rounded_mm(second_mm);
    return fmt::format("{}{} {}{} ", zx_ ? 'Z' : 'X', length(first_mm), zx_ ? 'X' : 'Y', length(second_mm));
  }
  std::string off_plane() {
    std::string words;
    if (random_.chance(0.15)) words += fmt::format("{}{} ", zx_ ? 'Y' : 'Z', length(random_.real(-3, 3)));
    if (random_.chance(0.1)) words += "A" + number(random_.real(-90, 90)) + " ";
    return words;
  }
  std::string feed_word() {
    if (inverse_) return "F" + number(random_.real(1, 50));
    return random_.chance(0.1) ? "F" + number(random_.real(50, 900)) : "";
  }

  void contour() {
    const double start_first = random_.real(-20, 20), start_second = random_.real(-20, 20);
    text_ += "G0 " + point(start_first, start_second) + "\n";
    radius_mm_ = random_.real(0.3, 4);
    left_ = random_.chance(0.5);
    turn_on();
    inverse_ = false;
    heading_rad_ = random_.real(-kPi, kPi);
    // rs274 trims the short line before a lathe tool's entry arc together with the arc
    if (!nose_beside_point_ && random_.chance(0.3)) {
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
    turn_off();
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

  void turn_off() {
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
    const double center_first = first_mm_ + i, center_second = second_mm_ + j;
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
      words += fmt::format("{}{} {}{} ", zx_ ? 'K' : 'I', length(i), zx_ ? 'I' : 'J', length(j));
    }
    if (random_.chance(0.1)) words += "P2 ";
    text_ += words + off_plane() + feed_word() + "\n";
    heading_rad_ = std::atan2(second_mm_ - center_second, first_mm_ - center_first) + turn * kPi / 2;
  }

  /// Words between two moves.
  void between() {
    static const char* const kWords[] = {
        "M3",  "M4", "M5", "S200", "M7", "M8", "M9", "G4 P0.5", "(a)", "(MSG,b)", "(DEBUG,#5420 #5421 #5422)",
        "#1=2"};
    // rs274 scales the point where waiting moves began once for each call that waits: so only one may wait
    if (random_.chance(0.04)) {
      inches_ = !inches_;
      text_ += inches_ ? "G20\n" : "G21\n";
    }
    while (random_.chance(0.25)) text_ += std::string(kWords[random_.below(std::size(kWords))]) + "\n";
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
  double radius_mm_ = 1, first_mm_ = 0, second_mm_ = 0, heading_rad_ = 0;
};

}  // namespace

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
