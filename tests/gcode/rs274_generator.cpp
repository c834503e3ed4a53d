#include "rs274_generator.h"

#include <fmt/format.h>

#include <cmath>

namespace kadr::gcode::test {
namespace {

constexpr int kStatements = 50;
constexpr char kLetters[] = "XYZABC";

/// @param rotary  some tools have an offset in A, which rs274 forgets in G53, G28 and G30
ToolTable tool_table(Random& random, bool rotary) {
  ToolTable table;
  for (const int number : {1, 2, 7, 30}) {
    Tool tool;
    tool.number = number;
    tool.pocket = number % 5 + 1;
    tool.offset[2] = std::floor(random.real(-40, 40) * 8) / 8;
    if (random.chance(0.3)) tool.offset[0] = std::floor(random.real(-9, 9) * 8) / 8;
    if (rotary && random.chance(0.2)) tool.offset[3] = 15;
    tool.diameter_mm = std::floor(random.real(1, 20) * 4) / 4;
    table.tools.push_back(tool);
  }
  return table;
}

}  // namespace

Generator::Generator(Random& random, const Subjects& subjects)
    : random_(random), w_(random), subjects_(subjects) {
  add(&Generator::straight, 4);
  add(&Generator::arc, 4);
  add(&Generator::plane);
  add(&Generator::units);
  add(&Generator::distance);
  add(&Generator::feed);
  if (subjects.offsets) {
    add(&Generator::work_offset, 2);
    add(&Generator::reference);
    add(&Generator::machine_coordinates);
  }
  if (subjects.machine) {
    add(&Generator::machine_function, 2);
    add(&Generator::parameters);
    add(&Generator::feed_mode);
  }
  if (subjects.rotation) add(&Generator::rotation, 2);
  if (subjects.polar) add(&Generator::polar, 3);
  if (subjects.tools) add(&Generator::tool, 4);
  if (subjects.turning) add(&Generator::turning, 3);
  if (subjects.outputs) add(&Generator::output, 3);
  if (subjects.stored) add(&Generator::store, 3);
  if (subjects.cycles) add(&Generator::cycle, 3);
  if (subjects.splines) add(&Generator::spline, 3);
  if (subjects.threads) add(&Generator::thread, 3);
  if (subjects.probes) add(&Generator::probe, 3);
}

TestProgram Generator::program() {
  TestProgram program;
  if (subjects_.tools) program.tools = tool_table(random_, !subjects_.offsets);
  program.text = "G21 G90 G94 G17 F1000\n";
  if (subjects_.turning || subjects_.threads || subjects_.cycles) program.text += "M3 S500\n";
  for (int i = 0; i < kStatements; ++i) {
    text_.clear();
    (this->*statements_[random_.below(statements_.size())])();
    if (!text_.empty() && text_[0] != '/' && random_.chance(0.1)) program.text += fmt::format("N{} ", i);
    program.text += text_;
  }
  program.text += "M2\n";
  return program;
}

std::string Generator::value(double low, double high) {
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

std::string Generator::word(int axis, const std::string& delta) const {
  const char letter = kLetters[axis];
  const std::string to = modes_.incremental ? "[" + delta + "]" : fmt::format("[#{}+{}]", 5420 + axis, delta);
  // X is a diameter under G7
  return axis == 0 && modes_.diameter ? fmt::format("{}[2*{}] ", letter, to)
                                      : fmt::format("{}{} ", letter, to);
}

std::string Generator::axes(const std::vector<std::string>& letters, double chance) {
  std::string text;
  for (const std::string& letter : letters) {
    if (random_.chance(chance)) text += letter + value(-50, 50) + " ";
  }
  return text;
}

void Generator::straight() {
  text_ += random_.chance(0.5) ? "G1 " : random_.chance(0.5) ? "g0" : "G 0 1 ";
  text_ += axes({"X", "Y", "Z", "A", "B", "C"}, 0.4);
  if (modes_.inverse) text_ += "F" + number(1, 50);
  text_ += "\n";
}

std::string Generator::arc_center(double i, double j, const PlaneAxes& axes) {
  std::string text;
  const double offsets[] = {i, j};
  const int which[] = {axes.first, axes.second};
  for (int k = 0; k < 2; ++k) {
    const char letter = static_cast<char>('I' + which[k]);
    if (!modes_.absolute_centers) {
      text += fmt::format("{}{:.6f} ", letter, offsets[k]);
    } else {
      text += fmt::format("{}[#{}+{:.6f}] ", letter, 5420 + which[k], offsets[k]);
    }
  }
  return text;
}

void Generator::arc() {
  const PlaneAxes axes = plane_axes(modes_.plane);
  std::string line = random_.chance(0.5) ? "G2 " : "G3 ";
  const double radius = random_.real(1, 40);
  const double from = random_.real(0, 6.28), to = from + random_.real(0.2, 6.0);
  const double i = -radius * std::cos(from), j = -radius * std::sin(from);
  const double dx = i + radius * std::cos(to), dy = j + radius * std::sin(to);
  const bool r_format = random_.chance(0.4);
  if (r_format || random_.chance(0.8)) {
    line += word(axes.first, fmt::format("{:.6f}", dx)) + word(axes.second, fmt::format("{:.6f}", dy));
  }
  if (r_format) {
    const double least = std::hypot(dx, dy) / 2;
    line += fmt::format("R{:.6f} ", least * random_.real(1.01, 3) * (random_.chance(0.5) ? 1 : -1));
  } else {
    line += arc_center(i, j, axes);
  }
  if (random_.chance(0.3)) line += word(axes.normal, number(-5, 5));
  if (random_.chance(0.2)) line += fmt::format("P{} ", 1 + random_.below(4));
  if (random_.chance(0.2)) line += "A" + number(-90, 90);
  if (modes_.inverse) line += " F" + number(1, 50);
  text_ += line + "\n";
}

void Generator::plane() {
  modes_.plane = static_cast<Plane>(random_.below(3));
  text_ += modes_.plane == Plane::xy ? "G17\n" : modes_.plane == Plane::zx ? "G18\n" : "G19\n";
}

// G49 first: the stand-alone rs274 keeps the number of a tool length when its unit changes
void Generator::units() {
  modes_.inches = random_.chance(0.5);
  text_ += modes_.inches ? "G49\nG20\n" : "G49\nG21\n";
}

void Generator::distance() {
  modes_.incremental = random_.chance(0.4);
  modes_.absolute_centers = random_.chance(0.3);
  text_ +=
      fmt::format("{} {}\n", modes_.incremental ? "G91" : "G90", modes_.absolute_centers ? "G90.1" : "G91.1");
}

void Generator::feed_mode() {
  modes_.inverse = random_.chance(0.3);
  modes_.per_turn = false;
  text_ += modes_.inverse ? "G93\n" : "G94 F" + number(10, 2000) + "\n";
}

void Generator::feed() {
  if (!modes_.inverse) text_ += "F" + number(1, 3000) + "\n";
}

void Generator::work_offset() {
  const std::string words = "X" + number(-20, 20) + " Z" + number(-20, 20) + " A" + number(-20, 20);
  switch (random_.below(9)) {
    case 0:
      text_ += fmt::format("G10 L2 P{} {}\n", random_.below(10), words);
      break;
    case 1:
      text_ += fmt::format("G10 L20 P{} {}\n", random_.below(10), words);
      break;
    case 2:
      text_ += "G92 " + words + "\n";
      break;
    case 3:
      text_ += w_.pick({"G92.1", "G92.2", "G92.3", "G92.2 G28", "G30 G92.3", "G92.1 G4 P0.1"}) + "\n";
      break;
    case 4:
      text_ += "G43.1 Z" + number(-20, 20) + "\n";
      break;
    case 5:
      text_ += "G49\n";
      break;
    default:
      text_ += "G" + w_.pick({"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"}) + "\n";
  }
}

void Generator::reference() {
  static const char* const kCodes[] = {"G28", "G30", "G28.1", "G30.1"};
  const std::uint64_t which = random_.below(4);
  text_ += kCodes[which];
  if (which < 2 && random_.chance(0.6)) text_ += " Y" + number(-20, 20) + " Z" + number(-5, 5);
  text_ += "\n";
}

void Generator::machine_coordinates() {
  if (!modes_.incremental) text_ += "G53 G0 X" + number(-20, 20) + " B" + number(-9, 9) + "\n";
}

void Generator::machine_function() {
  std::vector<std::string> codes = {
      "M7",           "M8",     "M9",     "M0",          "M1",
      "G4 P0.25",     "M48",    "M49",    "M50 P0",      "M51 P1",
      "(MSG, hello)", "G61",    "G64",    "G61.1",       "G64 P0.1",
      "(plain)",      "; rest", "/ M9",   "#1=[#1+1.5]", "G40 G80 G0",
      "M53 P1",       "M53 P0", "M50",    "M51",         "G64 P0.02 Q0.01",
      "M3 S500",      "M4",     "M60",    "S1234.5",     "(DEBUG, #1 #5420)",
      "(x) (msg,y)",  "(msg,)", "M3 M8",  "M4 M7 G4 P1", "G0 G40 M5 (end)",
      "g80g40g49",    "M52 P1", "M52 P0", "G04p[1/8]",   "(print,%d#1 %.2f #2)"};
  if (!modes_.per_turn && !subjects_.threads && !subjects_.cycles) {
    codes.insert(codes.end(), {"M5", "M19 R45", "M19 R350.5 P2 Q1"});
  }
  text_ += w_.pick(codes) + "\n";
}

void Generator::parameters() {
  text_ += fmt::format("#{}={} #1=[#2*0.5 - {}]\n", 2 + random_.below(3), value(-9, 9), number(-2, 2));
  if (random_.chance(0.5)) text_ += "G0 X[#2 MOD 90] Y[#3**2 MOD 7]\n";
}

void Generator::rotation() {
  switch (random_.below(5)) {
    case 0:
    case 1:
      text_ += fmt::format("G10 L2 P{} R{}\n", random_.below(10), number(-180, 360));
      break;
    case 2:
      text_ += fmt::format("G10 L2 P{} X{} R{} Y{}\n", random_.below(3), number(-20, 20),
                           w_.pick({"0", "90", "45", "-30.5"}), number(-9, 9));
      break;
    case 3:
      text_ += "G52 X" + number(-20, 20) + " Y" + number(-20, 20) + "\n";
      break;
    default:
      text_ += fmt::format("G10 L20 P{} X{} Y{}\n", random_.below(3), number(-9, 9), number(-9, 9));
  }
}

void Generator::polar() {
  text_ += "G17\n";
  modes_.plane = Plane::xy;
  // a radius alone keeps the angle of the present point: there must be one
  const std::string line = random_.chance(0.7) ? "G1 " : "G0 ";
  const std::string end = (modes_.inverse ? "F20" : "") + std::string("\n");
  if (modes_.incremental || random_.chance(0.6)) {
    text_ += line + "@" + number(1, 40) + " ^" + value(-360, 360) + " " + axes({"Z", "A"}, 0.3) + end;
    return;
  }
  text_ += line + "X" + number(5, 20) + " Y" + number(5, 20) + end;
  text_ += line + (random_.chance(0.5) ? "@" + number(1, 40) : "^" + number(-90, 90)) + " " +
           axes({"Z", "C"}, 0.3) + end;
}

void Generator::tool() {
  const std::string number_word = w_.pick({"1", "2", "7", "30"});
  // G0 alone before M6 and M61: the stand-alone rs274 takes the position after a change from the last move,
  // and forgets what offsets have done to it since
  switch (random_.below(11)) {
    case 0:
    case 1:
      text_ += "G0\n" + (random_.chance(0.5) ? "T" + number_word + " M6\n" : "M6 T" + number_word + "\n");
      number_set_ = false;
      break;
    case 2:
      text_ += "T" + number_word + "\n";
      break;
    case 3:
      text_ += "G0\nM6\n";
      number_set_ = false;
      break;
    case 4:
      text_ += "G0\nM61 Q" + number_word + "\n";
      number_set_ = true;
      break;
    case 5:
      if (!number_set_) text_ += "G43\n";
      break;
    case 6:
      text_ += "G43 H" + number_word + "\n";
      break;
    case 7:
      text_ += "G43.1 Z" + number(-20, 20) + " X" + number(-5, 5) + "\n";
      break;
    case 8:
      text_ += "G43.2 H" + number_word + "\n";
      break;
    case 9:
      text_ += "G49\n";
      break;
    default:
      if (!number_set_) text_ += "(debug,#5400 #<_current_tool> #<_selected_tool> #<_tool_offset>)\n";
  }
}

void Generator::turning() {
  switch (random_.below(7)) {
    case 0:
      modes_.per_turn = true;
      modes_.inverse = false;
      text_ += "G95 F" + number(0.05, 3) + "\n";
      break;
    case 1:
      modes_.per_turn = modes_.inverse = false;
      text_ += "G94 F" + number(50, 3000) + "\n";
      break;
    case 2:
      text_ += "G96 S" + number(20, 300) + (random_.chance(0.5) ? " D" + number(500, 4000) : "") + "\n";
      break;
    case 3:
      text_ += "G97 S" + number(20, 3000) + "\n";
      break;
    case 4:
      modes_.diameter = random_.chance(0.5);
      text_ += modes_.diameter ? "G7\n" : "G8\n";
      break;
    case 5:
      text_ += "S" + number(20, 3000) + (random_.chance(0.5) ? " M4" : "") + "\n";
      break;
    default:
      text_ += "G0 X" + number(-40, 40) + " Z" + number(-40, 40) + "\n";
  }
}

void Generator::output() {
  const auto n = random_.below(20);
  switch (random_.below(6)) {
    case 0:
      text_ += fmt::format("M{} P{}\n", w_.pick({"62", "63", "64", "65"}), n);
      break;
    case 1:
      text_ += fmt::format("M{} E{} Q{}\n", w_.pick({"67", "68"}), n, number(-10, 10));
      break;
    case 2:
      text_ += fmt::format("M66 P{} L0\n", n);
      break;
    case 3:
      text_ += fmt::format("M66 P{} L{} Q{}\n", n, 1 + random_.below(4), number(0.1, 5));
      break;
    case 4:
      text_ += fmt::format("M66 E{} L0\n", n);
      break;
    default:
      text_ += fmt::format("M{} P{} G1 X{}{} M8\n", w_.pick({"62", "63", "64", "65"}), n, value(-9, 9),
                           modes_.inverse ? " F10" : "");
  }
}

void Generator::store() {
  switch (random_.below(4)) {
    case 0:
      text_ += "M70\n";
      stored_ = modes_;
      is_stored_ = true;
      break;
    case 1:
      // M72 runs G43, whose tool is another one in rs274 after M61
      if (!is_stored_ || number_set_) return;
      text_ += modes_.inches != stored_.inches ? "G49\nM72\n" : "M72\n";
      modes_ = stored_;
      break;
    case 2:
      if (random_.chance(0.3)) text_ += "M71\n";
      if (!text_.empty()) is_stored_ = false;
      break;
    default:
      text_ +=
          "(debug,#<_metric> #<_absolute> #<_plane> #<_feed> #<_rpm> #<_coord_system> #<_inverse_time>"
          " #<_mist> #<_flood> #<_spindle_on> #<_feed_override>)\n";
  }
}

void Generator::cycle() {
  if (modes_.inverse || modes_.per_turn) return;
  const PlaneAxes axes = plane_axes(modes_.plane);
  const std::string code = w_.pick({"G81", "G82", "G83", "G73", "G85", "G86", "G89"});
  if (code == "G86") text_ += "M3 S800\n";
  std::string line = w_.pick({"G98 ", "G99 ", ""}) + code + " ";
  const char normal = kLetters[axes.normal];
  // R above the bottom, both in the units of the line
  if (modes_.incremental) {
    line += fmt::format("{}{} R{} ", normal, number(-9, -1), number(-3, 9));
  } else {
    line += fmt::format("{}{} R{} ", normal, number(-20, -5), number(-4, 20));
  }
  line += fmt::format("{}{} {}{} ", kLetters[axes.first], number(-20, 20), kLetters[axes.second],
                      number(-20, 20));
  if (code == "G82" || code == "G86" || code == "G89") line += "P" + number(0, 2) + " ";
  if (code == "G83" || code == "G73") line += "Q" + number(1, 4) + " ";
  if (random_.chance(0.3)) line += fmt::format("L{} ", 1 + random_.below(3));
  text_ += line + "\n";
  const auto repeats = random_.below(3);
  for (std::uint64_t i = 0; i < repeats; ++i) {
    text_ += fmt::format("{}{}{}\n", kLetters[random_.chance(0.5) ? axes.first : axes.second],
                         number(-20, 20), random_.chance(0.2) ? " R" + number(-4, 20) : "");
  }
  text_ += random_.chance(0.5) ? "G80\n" : "G0\n";
}

void Generator::spline() {
  if (modes_.inverse || modes_.diameter) return;
  text_ += "G17\n";
  modes_.plane = Plane::xy;
  const std::string end = "X" + number(-30, 30) + " Y" + number(-30, 30);
  switch (random_.below(3)) {
    case 0:
      text_ += fmt::format("G5 I{} J{} P{} Q{} {}\n", number(-9, 9), number(1, 9), number(-9, 9),
                           number(1, 9), end);
      if (random_.chance(0.5))
        text_ +=
            fmt::format("G5 P{} Q{} X{} Y{}\n", number(-9, 9), number(1, 9), number(-9, 9), number(-9, 9));
      break;
    case 1:
      text_ += fmt::format("G5.1 I{} J{} {}\n", number(-9, 9), number(1, 9), end);
      break;
    default:
      text_ += "G5.2 P1 L3 " + end + "\n";
      for (int i = 0; i < 4; ++i)
        text_ += fmt::format("X{} Y{} P{}\n", number(-30, 30), number(-30, 30), number(0.5, 2));
      text_ += "G5.3\n";
  }
  text_ += "G0 X" + number(-9, 9) + " Y" + number(-9, 9) + "\n";
}

void Generator::thread() {
  if (modes_.inverse || modes_.per_turn) return;
  text_ += "M3\n";
  switch (random_.below(3)) {
    case 0:
      text_ += fmt::format("G33 {}K{}\n", axes({"X"}, 0.8) + "Z" + number(-40, -1) + " ", number(0.2, 3));
      break;
    case 1:
      text_ +=
          fmt::format("G33.1 Z{} K{}{}\n", number(-40, -1), number(0.2, 3), random_.chance(0.3) ? " I2" : "");
      break;
    default:
      text_ += "G0 X" + number(10, 20) + " Z" + number(0, 9) + "\n";
  }
}

void Generator::probe() {
  if (modes_.inverse || modes_.per_turn) return;
  text_ += fmt::format("{} X{} Z{}\n", w_.pick({"G38.2", "G38.3", "G38.4", "G38.5"}), number(-30, 30),
                       number(-30, 30));
  // the stand-alone rs274 ends a little before the end: every axis is given again
  text_ += "G90 G0 X1 Y1 Z1\n";
  modes_.incremental = false;
}

}  // namespace kadr::gcode::test
