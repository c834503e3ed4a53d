#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "gcode/gcode.h"
#include "machine/base/variants.h"

namespace kadr::gcode {
namespace {

constexpr double kScale = 1e6;        // six decimals
constexpr double kLargestFast = 9e9;  // times 1e6 still an exact integer

constexpr std::array<char, 200> kDigitPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

/// Writes a line of the trace into a buffer on the stack: most of a program's time is spent here.
class LineWriter {
 public:
  void text(std::string_view s) {
    std::memcpy(at_, s.data(), s.size());
    at_ += s.size();
  }
  void integer(std::int64_t value) { at_ = std::to_chars(at_, end(), value).ptr; }
  /// A blank and the value with six decimals, no negative zero.
  void fixed(double value) {
    *at_++ = ' ';
    const double scaled = std::fabs(value) * kScale + 0.5;
    if (!(scaled < kLargestFast * kScale)) {
      at_ = fmt::format_to(at_, "{:.6f}", value);
      return;
    }
    // signed, since that conversion is one instruction
    const auto micro = static_cast<std::int64_t>(scaled);
    if (micro == 0) return text("0.000000");
    if (value < 0) *at_++ = '-';
    const auto whole = static_cast<std::uint64_t>(micro) / 1000000;
    const auto fraction = static_cast<std::uint32_t>(static_cast<std::uint64_t>(micro) % 1000000);
    if (whole < 10) {
      *at_++ = static_cast<char>('0' + whole);
    } else if (whole < 100) {
      pair(at_, static_cast<std::uint32_t>(whole));
      at_ += 2;
    } else {
      at_ = std::to_chars(at_, end(), whole).ptr;
    }
    at_[0] = '.';
    pair(at_ + 1, fraction / 10000);
    pair(at_ + 3, fraction / 100 % 100);
    pair(at_ + 5, fraction % 100);
    at_ += 7;
  }
  void place(std::uint32_t line) {
    text(" @");
    integer(line);
  }
  void finish(std::string& out) const {
    out.append(buffer_.data(), static_cast<std::size_t>(at_ - buffer_.data()));
  }

 private:
  char* end() { return buffer_.data() + buffer_.size(); }
  static void pair(char* at, std::uint32_t two_digits) {
    std::memcpy(at, kDigitPairs.data() + std::size_t{2} * two_digits, 2);
  }

  // name, at most 13 numbers of at most 317 characters (a double's largest integer part), place
  std::array<char, 4608> buffer_;
  char* at_ = buffer_.data();
};

void coordinates(LineWriter& line, const AxisValues& v) {
  for (std::size_t axis = 0; axis < 3; ++axis) line.fixed(v[axis]);
  // most machines have three axes
  if (v[3] == 0 && v[4] == 0 && v[5] == 0 && v[6] == 0 && v[7] == 0 && v[8] == 0) {
    return line.text(" 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000");
  }
  for (std::size_t axis = 3; axis < v.size(); ++axis) line.fixed(v[axis]);
}

std::string_view plane_word(Plane plane) {
  return plane == Plane::xy ? "XY" : plane == Plane::zx ? "XZ" : "YZ";
}

/// A text as part of one line: line ends and quotes would end it early.
void append_quoted(std::string& out, std::string_view text) {
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
}

void append_place(std::string& out, const Block& block, std::string_view called_file) {
  out += " @";
  if (!called_file.empty()) {
    out += called_file;
    out += ':';
  }
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), block.span.line).ptr;
  out.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

/// The canonical call of each action, without its place. False: the action has none; texts are written elsewhere.
class CallWriter {
 public:
  explicit CallWriter(LineWriter& line) : line_(line) {}

  bool operator()(const Traverse& move) const { return moves("STRAIGHT_TRAVERSE", move); }
  bool operator()(const Feed& move) const { return moves("STRAIGHT_FEED", move); }
  bool operator()(const Spline& move) const { return moves("NURBS_FEED", move); }
  bool operator()(const Probe& move) const { return moves("STRAIGHT_PROBE", move); }
  bool operator()(const RigidTap& move) const { return moves("RIGID_TAP", move); }
  bool operator()(const Approach& move) const {
    moves("APPROACH", move);
    for (const std::string& axes : move.ways) line_.text(" " + axes);
    return true;
  }
  bool operator()(const Arc& arc) const {
    moves("ARC_FEED", arc);
    line_.text(" ");
    line_.text(plane_word(arc.plane));
    line_.fixed(arc.center_first_mm);
    line_.fixed(arc.center_second_mm);
    line_.text(" ");
    line_.integer(arc.turns);
    return true;
  }

  bool operator()(const Dwell& dwell) const { return measured("DWELL", dwell.time_s); }
  bool operator()(const SetFeedRate& feed) const { return measured("SET_FEED_RATE", feed.rate); }
  bool operator()(const SetFeedMode& feed) const {
    return named(feed.mode == FeedMode::inverse_time           ? "SET_FEED_MODE G93"
                 : feed.mode == FeedMode::units_per_revolution ? "SET_FEED_MODE G95"
                                                               : "SET_FEED_MODE G94");
  }
  bool operator()(const SetPathMode& path) const {
    line_.text("SET_MOTION_CONTROL_MODE ");
    if (path.mode == PathMode::continuous) return measured("CONTINUOUS", path.tolerance_mm);
    return named(path.mode == PathMode::exact_stop ? "EXACT_STOP" : "EXACT_PATH");
  }

  bool operator()(const SpindleSpeed& speed) const {
    spindle("SET_SPINDLE_SPEED");
    line_.fixed(speed.s_word);
    return true;
  }
  bool operator()(const SpindleClockwise&) const { return spindle("START_SPINDLE_CLOCKWISE"); }
  bool operator()(const SpindleCounterclockwise&) const { return spindle("START_SPINDLE_COUNTERCLOCKWISE"); }
  bool operator()(const SpindleStop& stop) const {
    if (!stop.orientation) return spindle("STOP_SPINDLE_TURNING");
    if (stop.orientation->direction < 0) return false;
    spindle("ORIENT_SPINDLE");
    line_.fixed(stop.orientation->angle_deg);
    line_.text(" ");
    line_.integer(stop.orientation->direction);
    return true;
  }
  bool operator()(const SyncStart& sync) const {
    measured("START_SPEED_FEED_SYNC", sync.pitch_mm_rev);
    line_.text(" 0");  // no velocity mode
    return true;
  }
  bool operator()(const SyncStop&) const { return named("STOP_SPEED_FEED_SYNC"); }

  bool operator()(const MistOn&) const { return named("MIST_ON"); }
  bool operator()(const MistOff&) const { return named("MIST_OFF"); }
  bool operator()(const FloodOn&) const { return named("FLOOD_ON"); }
  bool operator()(const FloodOff&) const { return named("FLOOD_OFF"); }
  bool operator()(const SelectTool& select) const { return numbered("SELECT_TOOL", select.tool); }
  bool operator()(const ChangeTool& change) const { return numbered("CHANGE_TOOL", change.tool); }
  bool operator()(const SetToolNumber& set) const { return numbered("CHANGE_TOOL_NUMBER", set.tool); }

  bool operator()(const DigitalOutput& output) const {
    numbered("SET_DIGITAL", output.number);
    line_.text(output.on ? " on" : " off");
    return named(output.with_motion ? " @motion" : " @now");
  }
  bool operator()(const AnalogOutput& output) const {
    numbered("SET_ANALOG", output.number);
    line_.fixed(output.value);
    return named(output.with_motion ? " @motion" : " @now");
  }
  bool operator()(const InputWait& wait) const {
    numbered("WAIT_INPUT", wait.number);
    line_.text(wait.analog ? " analog " : " digital ");
    return measured(kWaitModes.word(wait.mode), wait.timeout_s);
  }

  bool operator()(const ProgramStop&) const { return named("PROGRAM_STOP"); }
  bool operator()(const OptionalStop&) const { return named("OPTIONAL_PROGRAM_STOP"); }
  bool operator()(const ProgramEnd& end) const { return !end.by_percent && named("PROGRAM_END"); }

  bool operator()(const OneOf<SpindleMode, FeedOverride, SpeedOverride, SpeedPoint> auto&) const {
    return false;
  }
  bool operator()(const OneOf<Message, Comment> auto&) const { return false; }

 private:
  bool named(std::string_view name) const {
    line_.text(name);
    return true;
  }
  bool measured(std::string_view name, double value) const {
    line_.text(name);
    line_.fixed(value);
    return true;
  }
  bool numbered(std::string_view name, int number) const {
    line_.text(name);
    line_.text(" ");
    line_.integer(number);
    return true;
  }
  bool moves(std::string_view name, const Move& move) const {
    line_.text(name);
    coordinates(line_, move.end);
    return true;
  }
  /// With the number of the spindle: there is one.
  bool spindle(std::string_view name) const {
    line_.text(name);
    line_.text(" 0");
    return true;
  }

  LineWriter& line_;
};

}  // namespace

void append_canon(std::string& out, const Block& block, std::string_view called_file) {
  if (const auto* message = std::get_if<Message>(&block.action)) {
    out += "MESSAGE \"";
    append_quoted(out, message->text);
    out += '"';
    append_place(out, block, called_file);
  } else if (const auto* comment = std::get_if<Comment>(&block.action)) {
    out += "# ";
    append_quoted(out, comment->text);
    append_place(out, block, called_file);
  } else {
    LineWriter line;
    if (!std::visit(CallWriter(line), block.action)) return;
    if (called_file.empty()) line.place(block.span.line);
    line.finish(out);
    if (!called_file.empty()) append_place(out, block, called_file);
  }
}

}  // namespace kadr::gcode
