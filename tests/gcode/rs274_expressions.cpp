#include <doctest/doctest.h>

#include <fmt/format.h>

#include "rs274_oracle.h"
#include "rs274_writer.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Parameters of the interpreter's state that the stand-alone rs274 has too.
const std::vector<std::string>& state_parameters() {
  static const std::vector<std::string> kNames = {"_x",
                                                  "_y",
                                                  "_z",
                                                  "_a",
                                                  "_b",
                                                  "_c",
                                                  "_u",
                                                  "_v",
                                                  "_w",
                                                  "_abs_x",
                                                  "_abs_y",
                                                  "_abs_z",
                                                  "_abs_a",
                                                  "_abs_b",
                                                  "_abs_c",
                                                  "_feed",
                                                  "_rpm",
                                                  "_metric",
                                                  "_imperial",
                                                  "_absolute",
                                                  "_incremental",
                                                  "_inverse_time",
                                                  "_units_per_minute",
                                                  "_units_per_rev",
                                                  "_coord_system",
                                                  "_plane",
                                                  "_motion_mode",
                                                  "_ccomp",
                                                  "_line",
                                                  "_tool_offset",
                                                  "_retract_r_plane",
                                                  "_retract_old_z",
                                                  "_spindle_rpm_mode",
                                                  "_spindle_css_mode",
                                                  "_ijk_absolute_mode",
                                                  "_lathe_diameter_mode",
                                                  "_lathe_radius_mode",
                                                  "_spindle_on",
                                                  "_spindle_cw",
                                                  "_mist",
                                                  "_flood",
                                                  "_speed_override",
                                                  "_feed_override",
                                                  "_feed_hold",
                                                  "_current_tool",
                                                  "_selected_tool",
                                                  "_value",
                                                  "_value_returned",
                                                  "_task",
                                                  "_call_level",
                                                  "_vmajor"};
  return kNames;
}

class ExpressionPrograms {
 public:
  explicit ExpressionPrograms(Random& random) : w_(random) {}

  std::string program() {
    std::string text;
    for (int i = 0; i < 40; ++i) {
      const std::vector<std::string> before = w_.named;
      const std::string line = statement();
      // rs274 reads lines of up to 255 characters
      if (line.size() < 250) {
        text += line + "\n";
      } else {
        w_.named = before;
      }
    }
    return text + "M2\n";
  }

 private:
  std::string setting() {
    std::string line;
    const std::uint64_t settings = 1 + w_.random.below(3);
    const std::vector<std::string> before = w_.named;
    std::vector<std::string> after = before;
    for (std::uint64_t i = 0; i < settings; ++i) {
      w_.named = after;
      const std::string target = w_.settable_parameter();
      after = w_.named;
      w_.named = before;  // a name has its value behind the line only
      line += fmt::format("{}={} ", target, w_.random.chance(0.4) ? w_.word_value() : bracketed(2));
    }
    if (w_.random.chance(0.3)) line += move();
    w_.named = after;
    return line;
  }
  std::string bracketed(int depth) { return "[" + w_.expression(depth) + "]"; }
  std::string move() {
    std::string line = w_.pick({"G0", "G1 F100", "g 0", "G01F250.", "G00"});
    const auto axes = 1 + w_.random.below(3);
    for (std::uint64_t i = 0; i < axes; ++i) {
      line += fmt::format(" {}{}", std::string("XYZABC")[i * 2 + w_.random.below(2)], w_.word_value());
    }
    return line;
  }
  std::string shown() {
    std::string line = "(" + w_.pick({"debug", "DEBUG", " Debug ", "print", "PRINT"}) + ",";
    const auto values = 1 + w_.random.below(4);
    for (std::uint64_t i = 0; i < values; ++i) {
      if (w_.random.chance(0.2)) line += w_.pick({"%d", "%f", "%lf", "%.2f", "%.0f", "text ", "% ", "100%"});
      switch (w_.random.below(4)) {
        case 0:
          line +=
              fmt::format(" a#{} ", w_.random.chance(0.5) ? 1 + w_.random.below(5) : 31 + w_.random.below(5));
          break;
        case 1:
          line += fmt::format("#<{}>", w_.named.empty() ? "_feed" : w_.pick(w_.named));
          break;
        default:
          line += fmt::format("#<{}> ", w_.pick(state_parameters()));
      }
    }
    return line + ")";
  }
  std::string mode() {
    return w_.pick(
        {"G20",          "G21",   "G90",      "G91",   "G17",     "G18",     "G19",   "G55",
         "G54",          "G59.3", "G90.1",    "G91.1", "M3 S100", "M4 S200", "M5",    "M7",
         "M8",           "M9",    "M48",      "M49",   "M50 P0",  "M51 P0",  "F200",  "S50",
         "G94 F10",      "G93",   "G80",      "G98",   "G99",     "G92 X1",  "G92.1", "G10 L2 P1 X1 Y2",
         "G10 L2 P1 R0", "G61",   "G64 P0.1", "M0",    "G4 P0.1", "G28.1",   "(note)"});
  }
  std::string statement() {
    switch (w_.random.below(8)) {
      case 0:
      case 1:
      case 2:
        return setting();
      case 3:
        return "G94 " + move();
      case 4:
        return mode();
      case 5:
        return fmt::format("G0 Y[#<{}> MOD 40]", w_.pick(state_parameters()));
      default:
        return shown();
    }
  }

  Writer w_;
};

}  // namespace

TEST_CASE("expressions and parameters have the values that rs274 gives them") {
  compare_with_rs274("expressions", 40, [](Random& random) {
    TestProgram program;
    program.text = ExpressionPrograms(random).program();
    return program;
  });
}
