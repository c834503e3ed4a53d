#include <doctest/doctest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// Differential test against LinuxCNC's stand-alone interpreter (Debian package linuxcnc-uspace), if it is
/// installed: KADR_RS274 names it, else it is looked for in PATH.
namespace {

namespace fs = std::filesystem;

/// One comparable call: a name and numbers in mm, machine coordinates.
struct Call {
  std::string name;
  std::vector<double> numbers;
  double tolerance = 0;  ///< of the numbers, from the four decimals of rs274
};

std::string text_of(const Call& call) {
  std::string text = call.name;
  for (const double v : call.numbers) text += fmt::format(" {:.5f}", v);
  return text;
}

std::string find_rs274() {
  if (const char* named = std::getenv("KADR_RS274")) return named;
  std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    if (fs::exists(fs::path(folder) / "rs274")) return (fs::path(folder) / "rs274").string();
  }
  return {};
}

/// rs274 prints relative to the offsets in force and in program units: this follows both.
class OracleReader {
 public:
  std::vector<Call> calls;
  bool refused = false;
  std::string refusal;  ///< first line that is neither a call nor known chatter

  void line(const std::string& text) {
    const std::size_t open = text.find('(');
    const std::size_t close = text.rfind(')');
    if (text.find(" N") == std::string::npos || open == std::string::npos || close == std::string::npos) {
      if (text.empty() || text == "executing") return;
      if (!refused) refusal = text;
      refused = true;
      return;
    }
    std::size_t begin = open;
    while (begin > 0 && (std::isupper(static_cast<unsigned char>(text[begin - 1])) ||
                         text[begin - 1] == '_' || std::isdigit(static_cast<unsigned char>(text[begin - 1]))))
      --begin;
    std::string name = text.substr(begin, open - begin);
    // a line number may touch the name: N123456STRAIGHT_FEED
    while (!name.empty() && std::isdigit(static_cast<unsigned char>(name[0]))) name.erase(0, 1);
    call(name, text.substr(open + 1, close - open - 1));
  }

 private:
  static std::vector<double> numbers(const std::string& inside) {
    std::vector<double> values;
    std::istringstream in(inside);
    for (std::string part; std::getline(in, part, ',');) {
      std::istringstream words(part);
      for (std::string word; words >> word;) {
        char* end = nullptr;
        const double v = std::strtod(word.c_str(), &end);
        if (end != word.c_str()) values.push_back(v);
      }
    }
    return values;
  }
  double machine(int axis, double value) const {
    return (axis < 3 ? value * unit_ : value) + g5x_[axis] + g92_[axis] + tool_[axis];
  }
  void set(std::array<double, 6>& offset, const std::vector<double>& v, std::size_t first) {
    for (std::size_t i = 0; i < 6 && first + i < v.size(); ++i)
      offset[i] = v[first + i] * (i < 3 ? unit_ : 1);
  }
  void call(const std::string& name, const std::string& inside) {
    const std::vector<double> v = numbers(inside);
    // a coordinate is the sum of four numbers of four decimals, some of them written in inches
    largest_unit_ = std::max(largest_unit_, unit_);
    const double tolerance = 4 * 0.51e-4 * largest_unit_;
    if (name == "USE_LENGTH_UNITS") {
      unit_ = inside.find("INCH") != std::string::npos ? 25.4 : 1;
    } else if (name == "SET_G5X_OFFSET") {
      set(g5x_, v, 1);
    } else if (name == "SET_G92_OFFSET") {
      set(g92_, v, 0);
    } else if (name == "USE_TOOL_LENGTH_OFFSET") {
      set(tool_, v, 0);
    } else if (name == "SELECT_PLANE") {
      plane_ = inside.find("XZ") != std::string::npos   ? Plane::zx
               : inside.find("YZ") != std::string::npos ? Plane::yz
                                                        : Plane::xy;
    } else if (name == "STRAIGHT_TRAVERSE" || name == "STRAIGHT_FEED") {
      Call c{name, {}, tolerance};
      for (int i = 0; i < 6; ++i) c.numbers.push_back(machine(i, v.at(static_cast<std::size_t>(i))));
      calls.push_back(c);
    } else if (name == "ARC_FEED") {
      const PlaneAxes axes = plane_axes(plane_);
      Call c{name, std::vector<double>(9), tolerance};
      c.numbers[static_cast<std::size_t>(axes.first)] = machine(axes.first, v.at(0));
      c.numbers[static_cast<std::size_t>(axes.second)] = machine(axes.second, v.at(1));
      c.numbers[static_cast<std::size_t>(axes.normal)] = machine(axes.normal, v.at(5));
      for (int i = 3; i < 6; ++i)
        c.numbers[static_cast<std::size_t>(i)] = machine(i, v.at(static_cast<std::size_t>(i + 3)));
      c.numbers[6] = machine(axes.first, v.at(2));
      c.numbers[7] = machine(axes.second, v.at(3));
      c.numbers[8] = v.at(4);
      calls.push_back(c);
    } else if (name == "SET_FEED_RATE") {
      if (!inverse_) calls.push_back({name, {v.at(0) * unit_}, tolerance});
    } else if (name == "COMMENT") {
      inverse_told_ = inside.find("inverse time") != std::string::npos;
    } else if (name == "SET_FEED_MODE") {
      // printed alike for every mode: a comment before it says G93
      inverse_ = inverse_told_;
      inverse_told_ = false;
    } else if (name == "DWELL") {
      calls.push_back({name, v, 1e-4});
    } else if (name == "SET_SPINDLE_SPEED") {
      calls.push_back({name, {v.at(1)}, 1e-4});
    } else if (name == "SET_MOTION_CONTROL_MODE") {
      calls.push_back({inside.find("STOP") != std::string::npos   ? "EXACT_STOP"
                       : inside.find("PATH") != std::string::npos ? "EXACT_PATH"
                                                                  : "CONTINUOUS",
                       {},
                       0});
    } else if (name == "MESSAGE") {
      calls.push_back({name + " " + inside, {}, 0});
    } else {
      static const char* const kPlain[] = {"START_SPINDLE_CLOCKWISE",
                                           "START_SPINDLE_COUNTERCLOCKWISE",
                                           "STOP_SPINDLE_TURNING",
                                           "MIST_ON",
                                           "MIST_OFF",
                                           "FLOOD_ON",
                                           "FLOOD_OFF",
                                           "PROGRAM_STOP",
                                           "OPTIONAL_PROGRAM_STOP",
                                           "PROGRAM_END"};
      for (const char* plain : kPlain) {
        if (name == plain) calls.push_back({name, {}, 0});
      }
    }
  }

  std::array<double, 6> g5x_{}, g92_{}, tool_{};
  double unit_ = 1, largest_unit_ = 1;
  Plane plane_ = Plane::xy;
  bool inverse_ = false, inverse_told_ = false;
};

std::vector<Call> own_calls(const Outcome& outcome) {
  std::vector<Call> calls;
  bool inverse = false;
  for (const Block& b : outcome.blocks) {
    std::string line;
    append_canon(line, b);
    const std::string name = line.substr(0, line.find(' '));
    switch (b.kind) {
      case BlockKind::traverse:
      case BlockKind::feed:
        calls.push_back({name, {b.end.begin(), b.end.begin() + 6}, 0});
        break;
      case BlockKind::arc: {
        Call c{name, {b.end.begin(), b.end.begin() + 6}, 0};
        c.numbers.insert(c.numbers.end(),
                         {b.center_first_mm, b.center_second_mm, static_cast<double>(b.turns)});
        calls.push_back(c);
        break;
      }
      case BlockKind::set_feed_mode:
        inverse = b.feed_mode == FeedMode::inverse_time;
        break;
      case BlockKind::set_feed_rate:
        if (!inverse) calls.push_back({name, {b.value}, 0});
        break;
      case BlockKind::dwell:
        calls.push_back({name, {b.dwell_s}, 0});
        break;
      case BlockKind::spindle_speed:
        calls.push_back({name, {b.value}, 0});
        break;
      case BlockKind::set_path_mode:
        calls.push_back({b.path_mode == PathMode::exact_stop   ? "EXACT_STOP"
                         : b.path_mode == PathMode::exact_path ? "EXACT_PATH"
                                                               : "CONTINUOUS",
                         {},
                         0});
        break;
      case BlockKind::message:
        calls.push_back({"MESSAGE \"" + b.text + "\"", {}, 0});
        break;
      case BlockKind::select_tool:
      case BlockKind::change_tool:
      case BlockKind::comment:
      case BlockKind::feed_override:
      case BlockKind::speed_override:
        break;
      default:
        calls.push_back({name, {}, 0});
        break;
    }
  }
  return calls;
}

/// A valid program over everything that both interpreters run. Positions are taken from #5420.. so that arcs
/// fit whatever the offsets, units and distance mode.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed) {}

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

  Random random_;
  std::string text_;
  Plane plane_ = Plane::xy;
  bool incremental_ = false, absolute_centers_ = false, inverse_ = false;
};

OracleReader oracle(const std::string& rs274, const fs::path& folder, const std::string& program) {
  std::ofstream(folder / "program.ngc") << program;
  std::ofstream(folder / "tools.tbl") << "";
  std::ofstream(folder / "parameters.var") << "";
  const std::string command =
      fmt::format("'{}' -t '{}' -v '{}' -g '{}' 2>&1", rs274, (folder / "tools.tbl").string(),
                  (folder / "parameters.var").string(), (folder / "program.ngc").string());
  OracleReader reader;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c == '\n') {
      reader.line(line);
      line.clear();
    } else {
      line += static_cast<char>(c);
    }
  }
  pclose(pipe);
  return reader;
}

std::string first_difference(const std::vector<Call>& own, const std::vector<Call>& other) {
  for (std::size_t i = 0; i < std::max(own.size(), other.size()); ++i) {
    if (i >= own.size()) return "missing: " + text_of(other[i]);
    if (i >= other.size()) return "too many: " + text_of(own[i]);
    bool same = own[i].name == other[i].name && own[i].numbers.size() == other[i].numbers.size();
    for (std::size_t k = 0; same && k < own[i].numbers.size(); ++k) {
      same = std::fabs(own[i].numbers[k] - other[i].numbers[k]) <= other[i].tolerance;
    }
    if (!same) return fmt::format("call {}: {}\n    rs274: {}", i, text_of(own[i]), text_of(other[i]));
  }
  return {};
}

}  // namespace

TEST_CASE("random valid programs make the same canonical calls as rs274") {
  const std::string rs274 = find_rs274();
  if (rs274.empty()) {
    MESSAGE("skipped: rs274 (package linuxcnc-uspace) is not installed; KADR_RS274 may name it");
    return;
  }
  const fs::path folder = fs::path(KADR_BINARY_DIR) / "rs274_test";
  fs::create_directories(folder);
  const std::uint64_t programs = count(60);
  for (std::uint64_t i = 0; i < programs; ++i) {
    const std::string program = Generator(seed() * 1000003 + i).program();
    const Outcome own = run(program);
    const OracleReader other = oracle(rs274, folder, program);
    CAPTURE(program);
    CAPTURE(own.rendered);
    CHECK_FALSE(own.diagnostics.has_errors());
    CHECK(other.refusal == "");
    const std::string difference = first_difference(own_calls(own), other.calls);
    CHECK(difference == "");
  }
  MESSAGE(programs << " programs compared");
}

TEST_CASE("random combinations of words on one line are accepted or refused as rs274 does") {
  const std::string rs274 = find_rs274();
  if (rs274.empty()) {
    MESSAGE("skipped: rs274 (package linuxcnc-uspace) is not installed; KADR_RS274 may name it");
    return;
  }
  static const char* const kWords[] = {
      "G0",    "G1",   "G2",  "G3",   "G4",      "G10",   "G17", "G18",   "G20",   "G21", "G28",
      "G28.1", "G30",  "G40", "G43",  "G43.1",   "G49",   "G53", "G54",   "G59.3", "G61", "G61.1",
      "G64",   "G80",  "G90", "G91",  "G90.1",   "G91.1", "G92", "G92.1", "G92.3", "G93", "X1",
      "Y2",    "Z3",   "A4",  "I1",   "J1",      "K1",    "R5",  "P1",    "P0",    "L2",  "L20",
      "F50",   "S100", "H0",  "Q1",   "D1",      "M3",    "M5",  "M6",    "M7",    "M9",  "M0",
      "M48",   "M50",  "M60", "#1=2", "(MSG,a)", "N7",    "X#1", "F0",    "Y[1/0]"};
  const fs::path folder = fs::path(KADR_BINARY_DIR) / "rs274_words_test";
  fs::create_directories(folder);
  Random random(seed() + 9);
  const std::uint64_t programs = count(60);
  for (std::uint64_t i = 0; i < programs; ++i) {
    std::string program = random.chance(0.5) ? "F100 G1 X0\n" : random.chance(0.5) ? "F100 G2 X1 R5\n" : "";
    const std::uint64_t words = 1 + random.below(5);
    for (std::uint64_t k = 0; k < words; ++k)
      program += std::string(kWords[random.below(std::size(kWords))]) + " ";
    program += "\nM2\n";
    const Outcome own = run(program);
    CAPTURE(program);
    CAPTURE(own.rendered);
    const OracleReader other = oracle(rs274, folder, program);
    CAPTURE(other.refusal);
    CHECK(own.diagnostics.has_errors() == other.refused);
  }
  MESSAGE(programs << " lines compared");
}
