#include "rs274_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "gcode/interpret/state.h"
#include "machine/base/variants.h"

namespace kadr::gcode::test {
namespace {

constexpr double kHalfDecimal = 0.51e-4;  // rounding of one number of four decimals
constexpr double kNoSpeedBound_rpm = 1e20;

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

/// rs274 tells the row of the table where M61 has changed the number of the tool.
void name_tools(std::vector<Call>& calls, const ToolTable& table) {
  for (Call& call : calls) {
    if (call.name != "CHANGE_TOOL_NUMBER" || call.numbers.at(0) < 1) continue;
    const auto row = static_cast<std::size_t>(call.numbers[0]) - 1;
    if (row < table.tools.size()) call.numbers[0] = table.tools[row].number;
  }
}

std::vector<double> first_numbers(const AxisValues& values, std::ptrdiff_t axes) {
  return {values.begin(), values.begin() + axes};
}

/// The comparable call of an action, none if rs274 has no such call. `name`: of kadr's own call.
struct CallOf {
  using Maybe = std::optional<Call>;
  std::string name;

  Maybe plain() const { return Call{name, {}, 0, {}}; }
  Maybe numbers(std::vector<double> values) const { return Call{name, std::move(values), 0, {}}; }
  static Maybe named(std::string called, std::vector<double> values = {}) {
    return Call{std::move(called), std::move(values), 0, {}};
  }

  Maybe operator()(const OneOf<Traverse, Feed, Probe> auto& move) const {
    return numbers(first_numbers(move.end, 6));
  }
  Maybe operator()(const Approach&) const { return std::nullopt; }
  Maybe operator()(const RigidTap& tap) const { return numbers(first_numbers(tap.end, 3)); }
  Maybe operator()(const Arc& arc) const {
    std::vector<double> values = first_numbers(arc.end, 6);
    values.insert(values.end(), {arc.center_first_mm, arc.center_second_mm, static_cast<double>(arc.turns)});
    return numbers(std::move(values));
  }
  Maybe operator()(const Spline& spline) const {
    return numbers({static_cast<double>(spline.control_points.size())});
  }
  Maybe operator()(const SetFeedMode& feed) const {
    return named(feed.mode == FeedMode::inverse_time           ? "SET_FEED_MODE G93"
                 : feed.mode == FeedMode::units_per_revolution ? "SET_FEED_MODE G95"
                                                               : "SET_FEED_MODE G94");
  }
  Maybe operator()(const SyncStart& sync) const { return numbers({sync.pitch_mm_rev, 0}); }
  Maybe operator()(const SpindleMode& mode) const { return named("SET_SPINDLE_MODE", {mode.maximum_rpm}); }
  Maybe operator()(const SpindleStop& stop) const {
    if (!stop.orientation) return plain();
    if (stop.orientation->direction < 0) return std::nullopt;
    return numbers({0, stop.orientation->angle_deg, static_cast<double>(stop.orientation->direction)});
  }
  Maybe operator()(const Dwell& dwell) const { return numbers({dwell.time_s}); }
  Maybe operator()(const SetFeedRate& feed) const { return numbers({feed.rate}); }
  Maybe operator()(const SpindleSpeed& speed) const { return numbers({speed.s_word}); }
  Maybe operator()(const SetPathMode& path) const {
    if (path.mode == PathMode::continuous) return named("CONTINUOUS", {path.tolerance_mm});
    return named(path.mode == PathMode::exact_stop ? "EXACT_STOP" : "EXACT_PATH");
  }
  Maybe operator()(const OneOf<SelectTool, SetToolNumber> auto& tool) const {
    return numbers({static_cast<double>(tool.tool)});
  }
  Maybe operator()(const DigitalOutput& output) const {
    return named(
        fmt::format("{}_{}_OUTPUT_BIT", output.on ? "SET" : "CLEAR", output.with_motion ? "MOTION" : "AUX"),
        {static_cast<double>(output.number)});
  }
  Maybe operator()(const AnalogOutput& output) const {
    return named(fmt::format("SET_{}_OUTPUT_VALUE", output.with_motion ? "MOTION" : "AUX"),
                 {static_cast<double>(output.number), output.value});
  }
  Maybe operator()(const Message& message) const { return named("MESSAGE \"" + message.text + "\""); }
  Maybe operator()(const Comment& comment) const { return named("PRINT " + comment.text); }
  Maybe operator()(const FeedOverride& feed) const {
    return named(feed.enabled ? "ENABLE_FEED_OVERRIDE" : "DISABLE_FEED_OVERRIDE");
  }
  Maybe operator()(const SpeedOverride& speed) const {
    return named(speed.enabled ? "ENABLE_SPEED_OVERRIDE" : "DISABLE_SPEED_OVERRIDE");
  }
  Maybe operator()(const ProgramEnd& end) const { return end.by_percent ? std::nullopt : plain(); }
  Maybe operator()(const InputWait&) const { return std::nullopt; }
  Maybe operator()(const OneOf<SpindleClockwise, SpindleCounterclockwise, MistOn, MistOff, FloodOn, FloodOff,
                               SyncStop, ChangeTool, ProgramStop, OptionalStop, SpeedPoint> auto&) const {
    return plain();
  }
};

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<Call> oracle_calls(const std::vector<std::string>& lines, const ToolTable& table) {
  OracleReader reader;
  for (const std::string& line : lines) reader.line(line);
  name_tools(reader.calls, table);
  // a program ends at M2; behind it rs274 only resets
  drop_resets_of_the_end(reader.calls);
  return std::move(reader.calls);
}

std::vector<Call> own_calls(const std::vector<Block>& blocks) {
  std::vector<Call> calls;
  bool inverse = false;
  for (const Block& b : blocks) {
    if (const auto* feed = std::get_if<SetFeedMode>(&b.action))
      inverse = feed->mode == FeedMode::inverse_time;
    if (is<SetFeedRate>(b) && inverse) continue;
    std::string line;
    append_canon(line, b);
    std::optional<Call> call = std::visit(CallOf{line.substr(0, line.find(' '))}, b.action);
    if (!call) continue;
    call->source = line;
    calls.push_back(std::move(*call));
  }
  drop_resets_of_the_end(calls);
  return calls;
}

}  // namespace kadr::gcode::test
