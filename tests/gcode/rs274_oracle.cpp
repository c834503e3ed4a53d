#include "rs274_oracle.h"

#include <doctest/doctest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "gcode/state.h"

namespace kadr::gcode::test {
namespace {

namespace fs = std::filesystem;

constexpr double kHalfDecimal = 0.51e-4;  // rounding of one number of four decimals
constexpr double kTextTolerance = 2e-6;
constexpr double kNoSpeedBound_rpm = 1e20;
constexpr int kOracleSeconds = 4;
constexpr int kShorteningRuns = 150;
constexpr std::size_t kKindsShown = 8;  // of a family
constexpr int kTimedOut = 124;          // exit status of `timeout`
constexpr std::size_t kContext = 5;

std::string text_of(const Call& call) {
  std::string text = call.name;
  for (const double v : call.numbers) text += fmt::format(" {:.5f}", v);
  return text;
}

/// Numbers between the brackets of a call.
std::vector<double> numbers_in(const std::string& inside) {
  std::vector<double> values;
  std::string spaced = inside;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream words(spaced);
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double v = std::strtod(word.c_str(), &end);
    if (end != word.c_str()) values.push_back(v);
  }
  return values;
}

/// Follows the offsets, units and modes that rs274 tells.
class OracleReader {
 public:
  std::vector<Call> calls;

  /// A line of standard output: "   12 N..... NAME(numbers)", or what a (PRINT, ...) says.
  void line(const std::string& text) {
    const std::size_t open = text.find('(');
    const std::size_t close = text.rfind(')');
    std::size_t at = text.find_first_not_of(" 0123456789");
    if (at == std::string::npos || text[at] != 'N' || open == std::string::npos ||
        close == std::string::npos) {
      calls.push_back({"PRINT " + text, {}, 0, text});
      return;
    }
    std::size_t begin = open;
    while (begin > 0 && (std::isalnum(static_cast<unsigned char>(text[begin - 1])) || text[begin - 1] == '_'))
      --begin;
    // a line number may touch the name: N123456STRAIGHT_FEED
    while (begin < open && (std::isdigit(static_cast<unsigned char>(text[begin])) != 0 ||
                            (text[begin] == 'N' && begin + 1 < open && std::isdigit(text[begin + 1]) != 0)))
      ++begin;
    source_ = text.substr(begin, close + 1 - begin);
    call(text.substr(begin, open - begin), text.substr(open + 1, close - open - 1));
  }

 private:
  using Offsets = std::array<double, 6>;

  void add(std::string name, std::vector<double> numbers = {}, double tolerance = 0) {
    calls.push_back({std::move(name), std::move(numbers), tolerance, source_});
  }
  double tolerance() const { return 4 * kHalfDecimal * largest_unit_; }
  void read_offset(Offsets& offset, const std::vector<double>& v, std::size_t first) const {
    for (std::size_t i = 0; i < 6 && first + i < v.size(); ++i)
      offset[i] = v[first + i] * (i < 3 ? unit_ : 1);
  }
  /// machine = g5x + R (program + g92) + tool
  Offsets machine(const Offsets& program) const {
    Offsets at;
    for (std::size_t i = 0; i < 6; ++i) at[i] = (i < 3 ? program[i] * unit_ : program[i]) + g92_[i];
    const double x = at[0], y = at[1];
    at[0] = x * cosine_ - y * sine_;
    at[1] = x * sine_ + y * cosine_;
    for (std::size_t i = 0; i < 6; ++i) at[i] += g5x_[i] + tool_[i];
    return at;
  }
  double tolerance_at(const Offsets& at) const {
    if (sine_ == 0) return tolerance();
    // x and y mix, and the angle has four decimals too: 1e-6 rad
    const double radius = std::hypot(at[0] - g5x_[0], at[1] - g5x_[1]);
    return 1.5 * tolerance() + 1e-6 * radius;
  }
  void straight(const std::string& name, const std::vector<double>& v, std::size_t axes) {
    Offsets program{};
    for (std::size_t i = 0; i < axes; ++i) program[i] = v.at(i);
    const Offsets at = machine(program);
    add(name, {at.begin(), at.begin() + static_cast<std::ptrdiff_t>(axes)}, tolerance_at(at));
  }
  void arc(const std::vector<double>& v) {
    const PlaneAxes axes = plane_axes(plane_);
    const auto first = static_cast<std::size_t>(axes.first);
    const auto second = static_cast<std::size_t>(axes.second);
    const auto normal = static_cast<std::size_t>(axes.normal);
    Offsets end{}, center{};
    end[first] = v.at(0);
    end[second] = v.at(1);
    end[normal] = center[normal] = v.at(5);
    center[first] = v.at(2);
    center[second] = v.at(3);
    for (std::size_t i = 3; i < 6; ++i) end[i] = v.at(i + 3);
    end = machine(end);
    center = machine(center);
    std::vector<double> numbers(end.begin(), end.end());
    numbers.insert(numbers.end(), {center[first], center[second], v.at(4)});
    add("ARC_FEED", numbers, std::max(tolerance_at(end), tolerance_at(center)));
  }
  void path_mode(const std::string& inside) {
    if (inside.find("CONTINUOUS") != std::string::npos) {
      add("CONTINUOUS", {numbers_in(inside).at(0) * unit_}, tolerance());
    } else {
      add(inside.find("STOP") != std::string::npos ? "EXACT_STOP" : "EXACT_PATH");
    }
  }
  void feed_mode(const std::vector<double>& v) {
    // printed alike for G93 and G94: a comment before it says G93
    inverse_ = inverse_told_;
    inverse_told_ = false;
    add(inverse_ ? "SET_FEED_MODE G93" : v.at(1) != 0 ? "SET_FEED_MODE G95" : "SET_FEED_MODE G94");
  }
  bool setting(const std::string& name, const std::string& inside, const std::vector<double>& v) {
    if (name == "USE_LENGTH_UNITS") {
      unit_ = inside.find("INCH") != std::string::npos ? kMillimetresPerInch : 1;
      // a coordinate is the sum of four numbers of four decimals, some of them written in inches
      largest_unit_ = std::max(largest_unit_, unit_);
    } else if (name == "SET_G5X_OFFSET") {
      read_offset(g5x_, v, 1);
    } else if (name == "SET_G92_OFFSET") {
      read_offset(g92_, v, 0);
    } else if (name == "SET_XY_ROTATION") {
      const double radians = v.at(0) * std::acos(-1.0) / 180;
      sine_ = v.at(0) == 0 ? 0 : std::sin(radians);
      cosine_ = v.at(0) == 0 ? 1 : std::cos(radians);
    } else if (name == "USE_TOOL_LENGTH_OFFSET") {
      read_offset(tool_, v, 0);
    } else if (name == "SELECT_PLANE") {
      plane_ = inside.find("XZ") != std::string::npos   ? Plane::zx
               : inside.find("YZ") != std::string::npos ? Plane::yz
                                                        : Plane::xy;
    } else {
      return false;
    }
    return true;
  }
  void call(const std::string& name, const std::string& inside) {
    const std::vector<double> v = numbers_in(inside);
    if (setting(name, inside, v)) return;
    if (name == "STRAIGHT_TRAVERSE" || name == "STRAIGHT_FEED" || name == "STRAIGHT_PROBE") {
      straight(name, v, 6);
    } else if (name == "RIGID_TAP") {
      straight(name, v, 3);
    } else if (name == "ARC_FEED") {
      arc(v);
    } else if (name == "NURBS_FEED") {
      add(name, {v.at(0)});
    } else if (name == "SET_FEED_RATE") {
      // under G93 rs274 tells the feed of each move, kadr the F that was written
      if (!inverse_) add(name, {v.at(0) * unit_}, tolerance());
    } else if (name == "SET_FEED_MODE") {
      feed_mode(v);
    } else if (name == "COMMENT") {
      inverse_told_ = inside.find("feed mode set to inverse time") != std::string::npos;
    } else if (name == "START_SPEED_FEED_SYNC") {
      add(name, {v.at(0) * unit_, v.at(1)}, tolerance());
    } else if (name == "STOP_SPEED_FEED_SYNCH") {
      add("STOP_SPEED_FEED_SYNC");
    } else if (name == "SET_SPINDLE_SPEED" || name == "SET_SPINDLE_MODE") {
      // G96 without D is told as a bound that no spindle reaches
      const bool unbound = name == "SET_SPINDLE_MODE" && v.at(1) > kNoSpeedBound_rpm;
      add(name, {unbound ? 0.0 : v.at(1)}, kHalfDecimal);
    } else if (name == "SET_MOTION_CONTROL_MODE") {
      path_mode(inside);
    } else if (name == "CHANGE_TOOL") {
      add(name);  // with the place in the table, not the number
    } else if (name == "MESSAGE") {
      add(name + " " + inside);
    } else {
      plain(name, v);
    }
  }
  /// Calls whose name and numbers are compared as they stand.
  void plain(const std::string& name, const std::vector<double>& v) {
    static const char* const kWithNumbers[] = {"DWELL",
                                               "SELECT_TOOL",
                                               "CHANGE_TOOL_NUMBER",
                                               "SET_MOTION_OUTPUT_BIT",
                                               "CLEAR_MOTION_OUTPUT_BIT",
                                               "SET_AUX_OUTPUT_BIT",
                                               "CLEAR_AUX_OUTPUT_BIT",
                                               "SET_MOTION_OUTPUT_VALUE",
                                               "SET_AUX_OUTPUT_VALUE",
                                               "ORIENT_SPINDLE"};
    static const char* const kNamesOnly[] = {"START_SPINDLE_CLOCKWISE",
                                             "START_SPINDLE_COUNTERCLOCKWISE",
                                             "STOP_SPINDLE_TURNING",
                                             "MIST_ON",
                                             "MIST_OFF",
                                             "FLOOD_ON",
                                             "FLOOD_OFF",
                                             "ENABLE_FEED_OVERRIDE",
                                             "DISABLE_FEED_OVERRIDE",
                                             "ENABLE_SPEED_OVERRIDE",
                                             "DISABLE_SPEED_OVERRIDE",
                                             "PROGRAM_STOP",
                                             "OPTIONAL_PROGRAM_STOP",
                                             "PROGRAM_END"};
    const auto same = [&](const char* known) { return name == known; };
    if (std::any_of(std::begin(kWithNumbers), std::end(kWithNumbers), same)) add(name, v, 2 * kHalfDecimal);
    if (std::any_of(std::begin(kNamesOnly), std::end(kNamesOnly), same)) add(name);
  }

  Offsets g5x_{}, g92_{}, tool_{};
  double sine_ = 0, cosine_ = 1;
  double unit_ = 1, largest_unit_ = 1;
  Plane plane_ = Plane::xy;
  bool inverse_ = false, inverse_told_ = false;
  std::string source_;
};

/// What M2 tells again differs: rs274 always sets the spindle mode, and leaves the speed override as it is
/// where the documentation says that both overrides are enabled. Neither is part of the canonical trace.
void drop_resets_of_the_end(std::vector<Call>& calls) {
  if (calls.empty() || calls.back().name != "PROGRAM_END") return;
  for (std::size_t i = calls.size(); i-- > 0 && calls[i].name != "SET_FEED_RATE";) {
    if (calls[i].name == "SET_SPINDLE_MODE" || calls[i].name == "ENABLE_SPEED_OVERRIDE")
      calls.erase(calls.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

std::vector<double> first_numbers(const AxisValues& values, std::ptrdiff_t axes) {
  return {values.begin(), values.begin() + axes};
}

/// The comparable call of a block, none if rs274 has no such call.
std::optional<Call> call_of(const Block& b, const std::string& name) {
  switch (b.kind) {
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::probe:
      return Call{name, first_numbers(b.end, 6), 0, {}};
    case BlockKind::rigid_tap:
      return Call{name, first_numbers(b.end, 3), 0, {}};
    case BlockKind::arc: {
      std::vector<double> numbers = first_numbers(b.end, 6);
      numbers.insert(numbers.end(), {b.center_first_mm, b.center_second_mm, static_cast<double>(b.turns)});
      return Call{name, numbers, 0, {}};
    }
    case BlockKind::spline:
      return Call{name, {static_cast<double>(b.control_points.size())}, 0, {}};
    case BlockKind::set_feed_mode:
      return Call{b.feed_mode == FeedMode::inverse_time           ? "SET_FEED_MODE G93"
                  : b.feed_mode == FeedMode::units_per_revolution ? "SET_FEED_MODE G95"
                                                                  : "SET_FEED_MODE G94",
                  {},
                  0,
                  {}};
    case BlockKind::sync_start:
      return Call{name, {b.value, static_cast<double>(b.number)}, 0, {}};
    case BlockKind::spindle_mode:
      return Call{"SET_SPINDLE_MODE", {b.maximum_rpm}, 0, {}};
    case BlockKind::spindle_stop:
      if (!b.on) return Call{name, {}, 0, {}};
      if (b.number < 0) return std::nullopt;
      return Call{name, {0, b.value, static_cast<double>(b.number)}, 0, {}};
    case BlockKind::dwell:
      return Call{name, {b.dwell_s}, 0, {}};
    case BlockKind::set_feed_rate:
    case BlockKind::spindle_speed:
      return Call{name, {b.value}, 0, {}};
    case BlockKind::set_path_mode:
      if (b.path_mode == PathMode::continuous) return Call{"CONTINUOUS", {b.path_tolerance_mm}, 0, {}};
      return Call{b.path_mode == PathMode::exact_stop ? "EXACT_STOP" : "EXACT_PATH", {}, 0, {}};
    case BlockKind::select_tool:
    case BlockKind::set_tool_number:
      return Call{name, {static_cast<double>(b.number)}, 0, {}};
    case BlockKind::digital_output:
      return Call{fmt::format("{}_{}_OUTPUT_BIT", b.on ? "SET" : "CLEAR", b.with_motion ? "MOTION" : "AUX"),
                  {static_cast<double>(b.number)},
                  0,
                  {}};
    case BlockKind::analog_output:
      return Call{fmt::format("SET_{}_OUTPUT_VALUE", b.with_motion ? "MOTION" : "AUX"),
                  {static_cast<double>(b.number), b.value},
                  0,
                  {}};
    case BlockKind::message:
      return Call{"MESSAGE \"" + b.text + "\"", {}, 0, {}};
    case BlockKind::comment:
      return Call{"PRINT " + b.text, {}, 0, {}};
    case BlockKind::feed_override:
      return Call{b.number != 0 ? "ENABLE_FEED_OVERRIDE" : "DISABLE_FEED_OVERRIDE", {}, 0, {}};
    case BlockKind::speed_override:
      return Call{b.number != 0 ? "ENABLE_SPEED_OVERRIDE" : "DISABLE_SPEED_OVERRIDE", {}, 0, {}};
    case BlockKind::program_end:
      if (b.number == 1) return std::nullopt;
      return Call{name, {}, 0, {}};
    case BlockKind::wait_input:
      return std::nullopt;
    default:
      return Call{name, {}, 0, {}};
  }
}

std::vector<Call> own_calls(const std::vector<Block>& blocks) {
  std::vector<Call> calls;
  bool inverse = false;
  for (const Block& b : blocks) {
    if (b.kind == BlockKind::set_feed_mode) inverse = b.feed_mode == FeedMode::inverse_time;
    if (b.kind == BlockKind::set_feed_rate && inverse) continue;
    std::string line;
    append_canon(line, b);
    std::optional<Call> call = call_of(b, line.substr(0, line.find(' ')));
    if (!call) continue;
    call->source = line;
    calls.push_back(std::move(*call));
  }
  drop_resets_of_the_end(calls);
  return calls;
}

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "kadr_rs274_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void write_files(const fs::path& folder, const TestProgram& program) {
  std::ofstream(folder / "program.ngc") << program.text;
  for (const auto& [name, text] : program.files) std::ofstream(folder / name) << text;
}

/// The stand-alone rs274 takes the lengths of its table as inches.
std::string oracle_table(const ToolTable& table, double diameter_unit_mm) {
  std::string text;
  for (const Tool& tool : table.tools) {
    text += fmt::format("T{} P{}", tool.number, tool.pocket);
    for (std::size_t axis = 0; axis < kProgramAxes; ++axis) {
      const char letter = kAxisLetters[axis];
      const double offset = tool.offset[axis];
      if (offset == 0) continue;
      text +=
          fmt::format(" {}{:.12f}", letter, is_rotary_letter(letter) ? offset : offset / kMillimetresPerInch);
    }
    text += fmt::format(" D{:.12f} I{:.6f} J{:.6f} Q{}\n", tool.diameter_mm / diameter_unit_mm,
                        tool.front_angle_deg, tool.back_angle_deg, tool.orientation);
  }
  return text;
}

/// rs274 tells the row of the table where M61 has changed the number of the tool.
void name_tools(std::vector<Call>& calls, const ToolTable& table) {
  for (Call& call : calls) {
    if (call.name != "CHANGE_TOOL_NUMBER" || call.numbers.at(0) < 1) continue;
    const auto row = static_cast<std::size_t>(call.numbers[0]) - 1;
    if (row < table.tools.size()) call.numbers[0] = table.tools[row].number;
  }
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Texts with numbers in them: these may differ in the last of their six decimals.
bool same_text(const std::string& own, const std::string& other) {
  if (own == other) return true;
  std::istringstream a(own), b(other);
  for (std::string left, right; true;) {
    const bool more_left = static_cast<bool>(a >> left), more_right = static_cast<bool>(b >> right);
    if (!more_left || !more_right) return more_left == more_right;
    if (left == right) continue;
    const std::size_t digit = left.find_first_of("+-.0123456789");
    if (digit == std::string::npos || left.substr(0, digit) != right.substr(0, digit)) return false;
    const double x = std::strtod(left.c_str() + digit, nullptr);
    const double y = std::strtod(right.c_str() + digit, nullptr);
    if (!(std::fabs(x - y) <= kTextTolerance * std::max(1.0, std::fabs(x)))) return false;
  }
}

bool same_call(const Call& own, const Call& other) {
  const bool text = other.name.rfind("MESSAGE ", 0) == 0 || other.name.rfind("PRINT ", 0) == 0;
  if (text) return same_text(own.name, other.name);
  if (own.name != other.name || own.numbers.size() != other.numbers.size()) return false;
  for (std::size_t k = 0; k < own.numbers.size(); ++k) {
    if (!(std::fabs(own.numbers[k] - other.numbers[k]) <= other.tolerance)) return false;
  }
  return true;
}

/// Whether a family is asked for by KADR_FAMILIES.
bool family_chosen(std::string_view family) {
  const char* chosen = std::getenv("KADR_FAMILIES");
  if (chosen == nullptr || *chosen == '\0') return true;
  std::istringstream names(chosen);
  for (std::string name; std::getline(names, name, ',');) {
    if (!name.empty() && family.substr(0, name.size()) == name) return true;
  }
  return false;
}

/// One comparison; the two kinds of families differ in what counts as a disagreement.
struct Comparison {
  std::string rs274;
  bool verdict_only = false;

  /// Empty if both interpreters agree.
  std::string disagreement(const TestProgram& program) const {
    const Trace other = oracle_trace(rs274, program);
    if (other.timed_out) return {};
    const Trace own = own_trace(program);
    if (verdict_only && own.refused == other.refused) return {};
    return first_difference(own, other);
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The same class of disagreement: which side refuses, or the names of the differing calls.
std::string kind_of(const std::string& difference) {
  std::string kind;
  std::size_t end = difference.find('\n');
  if (difference.find(" refuses ") < end) end = difference.find('\n', end + 1);
  for (const char c : difference.substr(0, end)) {
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') kind += c;
  }
  return kind.substr(0, 120);
}

/// Leaves out lines, halves first, as long as the same disagreement remains.
TestProgram shortened(const Comparison& comparison, TestProgram program, const std::string& difference) {
  int runs_left = kShorteningRuns;
  std::vector<std::string> lines = lines_of(program.text);
  for (std::size_t piece = std::max<std::size_t>(lines.size() / 2, 1); piece >= 1 && runs_left > 0;) {
    bool shorter = false;
    for (std::size_t at = 0; at < lines.size() && runs_left > 0;) {
      std::vector<std::string> fewer = lines;
      const std::size_t end = std::min(at + piece, lines.size());
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at),
                  fewer.begin() + static_cast<std::ptrdiff_t>(end));
      TestProgram candidate = program;
      candidate.text = joined(fewer);
      --runs_left;
      const std::string now = comparison.disagreement(candidate);
      if (!now.empty() && kind_of(now) == kind_of(difference)) {
        lines = fewer;
        shorter = true;
      } else {
        at += piece;
      }
    }
    if (!shorter) {
      if (piece == 1) break;
      piece /= 2;
    }
  }
  program.text = joined(lines);
  return program;
}

std::string shown(const TestProgram& program) {
  std::string text;
  const std::vector<std::string> lines = lines_of(program.text);
  for (std::size_t i = 0; i < lines.size(); ++i) text += fmt::format("{:5} | {}\n", i + 1, lines[i]);
  for (const Tool& tool : program.tools.tools) {
    text += fmt::format("tool T{} P{} X{} Y{} Z{} A{} D{} I{} J{} Q{}\n", tool.number, tool.pocket,
                        tool.offset[0], tool.offset[1], tool.offset[2], tool.offset[3], tool.diameter_mm,
                        tool.front_angle_deg, tool.back_angle_deg, tool.orientation);
  }
  for (const auto& [name, content] : program.files) text += "file " + name + ":\n" + content;
  return text;
}

void compare(std::string_view family, std::uint64_t fallback, const MakeProgram& make, bool verdict_only) {
  if (!family_chosen(family)) return;
  const Comparison comparison{find_rs274(), verdict_only};
  if (comparison.rs274.empty()) {
    MESSAGE("skipped: rs274 (package linuxcnc-uspace) is not installed; KADR_RS274 may name it");
    return;
  }
  const std::uint64_t programs = count(fallback);
  std::uint64_t agreed = 0, refused = 0, timed_out = 0, differing = 0;
  // for writing generators: what does rs274 refuse?
  const bool oracle_only = environment("KADR_ORACLE_ONLY", 0) != 0;
  std::set<std::string> kinds;  // each is shown once
  for (std::uint64_t i = 0; i < programs; ++i) {
    Random random(seed() * 1000003 + i);
    const TestProgram program = make(random);
    const Trace other = oracle_trace(comparison.rs274, program);
    if (other.timed_out) {
      ++timed_out;
      continue;
    }
    if (other.refused) ++refused;
    if (oracle_only) {
      if (other.refused) MESSAGE(i << ": " << other.refusal);
      continue;
    }
    const Trace own = own_trace(program);
    std::string difference =
        verdict_only && own.refused == other.refused ? std::string() : first_difference(own, other);
    if (difference.empty()) {
      ++agreed;
      continue;
    }
    ++differing;
    if (kinds.size() >= kKindsShown || !kinds.insert(kind_of(difference)).second) continue;
    const TestProgram minimal = shortened(comparison, program, difference);
    difference = comparison.disagreement(minimal);
    FAIL_CHECK(family, " ", i, " (seed ", seed(), "): ", difference, "\n", shown(minimal));
  }
  MESSAGE(family << ": " << programs << " programs compared, " << agreed << " agree, " << refused
                 << " refused by rs274, " << timed_out << " without end in rs274");
  CHECK(differing == 0);
  // a generator of valid programs that mostly makes refused ones tests nothing
  if (!verdict_only && programs >= 20) CHECK(refused * 10 <= programs);
}

}  // namespace

std::string find_rs274() {
  if (const char* named = std::getenv("KADR_RS274")) return named;
  std::istringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    if (fs::exists(fs::path(folder) / "rs274")) return (fs::path(folder) / "rs274").string();
  }
  return {};
}

Trace oracle_trace(const std::string& rs274, const TestProgram& program) {
  const TemporaryFolder folder;
  write_files(folder.path(), program);
  std::ofstream(folder.path() / "tools.tbl") << oracle_table(program.tools, program.diameter_unit_mm);
  std::ofstream(folder.path() / "parameters.var") << "";
  // HOME: rs274 maps its tool table to a file there, which other runs must not share
  // the trace comes by standard output, errors by standard error
  const std::string command = fmt::format(
      "cd '{0}' && HOME='{0}' timeout {1} '{2}' -t tools.tbl -v parameters.var -g program.ngc >out 2>err",
      folder.path().string(), kOracleSeconds, rs274);
  const int status = std::system(command.c_str());
  Trace trace;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  trace.timed_out = code == kTimedOut;
  trace.refused = code != 0;
  if (trace.timed_out) return trace;
  OracleReader reader;
  for (const std::string& line : lines_of(read_text(folder.path() / "out"))) reader.line(line);
  // a program ends at M2; behind it rs274 only resets
  trace.calls = std::move(reader.calls);
  name_tools(trace.calls, program.tools);
  drop_resets_of_the_end(trace.calls);
  for (const std::string& line : lines_of(read_text(folder.path() / "err"))) {
    if (line != "executing" && line.rfind("link (updating", 0) != 0) trace.refusal += line + "\n";
  }
  return trace;
}

Trace own_trace(const TestProgram& program) {
  const TemporaryFolder folder;
  InterpretOptions options;
  options.tools = program.tools;
  std::string name = "program.ngc";
  if (!program.files.empty()) {
    write_files(folder.path(), program);
    name = (folder.path() / name).string();
  }
  const Outcome outcome = run(program.text, options, name);
  Trace trace;
  trace.calls = own_calls(outcome.blocks);
  trace.refused = outcome.diagnostics.has_errors();
  if (trace.refused) trace.refusal = outcome.rendered;
  return trace;
}

std::string first_difference(const Trace& own, const Trace& other) {
  if (own.refused && other.refused) return {};
  if (own.refused) return "kadr refuses what rs274 runs\n" + own.refusal;
  if (other.refused) return "rs274 refuses what kadr runs\n" + other.refusal;
  std::size_t i = 0;
  while (i < own.calls.size() && i < other.calls.size() && same_call(own.calls[i], other.calls[i])) ++i;
  if (i == own.calls.size() && i == other.calls.size()) return {};
  const auto at = [i](const Trace& trace) {
    return i < trace.calls.size() ? text_of(trace.calls[i]) : std::string("(no more calls)");
  };
  std::string text = fmt::format("kadr {} | rs274 {}\n", at(own), at(other));
  for (std::size_t k = i - std::min(i, kContext); k < i; ++k)
    text += fmt::format("  both  {:4} {}\n", k, text_of(own.calls[k]));
  for (std::size_t k = i; k < std::min(i + 3, own.calls.size()); ++k)
    text += fmt::format("  kadr  {:4} {}   <- {}\n", k, text_of(own.calls[k]), own.calls[k].source);
  for (std::size_t k = i; k < std::min(i + 3, other.calls.size()); ++k)
    text += fmt::format("  rs274 {:4} {}   <- {}\n", k, text_of(other.calls[k]), other.calls[k].source);
  return text;
}

void compare_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make) {
  compare(family, programs, make, false);
}

void compare_verdict_with_rs274(std::string_view family, std::uint64_t programs, const MakeProgram& make) {
  compare(family, programs, make, true);
}

}  // namespace kadr::gcode::test
