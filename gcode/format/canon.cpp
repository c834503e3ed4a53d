#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "gcode/gcode.h"

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

void spindle(LineWriter& line, std::string_view name) {
  line.text(name);
  line.text(" 0");  // the number of the spindle
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

void numbered(LineWriter& line, std::string_view name, int number) {
  line.text(name);
  line.text(" ");
  line.integer(number);
}

/// Everything but texts. @return false if the block has no line
bool write(LineWriter& line, const Block& block) {
  switch (block.kind) {
    case BlockKind::traverse:
      line.text("STRAIGHT_TRAVERSE");
      coordinates(line, block.end);
      break;
    case BlockKind::feed:
      line.text("STRAIGHT_FEED");
      coordinates(line, block.end);
      break;
    case BlockKind::arc:
      line.text("ARC_FEED");
      coordinates(line, block.end);
      line.text(" ");
      line.text(plane_word(block.plane));
      line.fixed(block.center_first_mm);
      line.fixed(block.center_second_mm);
      line.text(" ");
      line.integer(block.turns);
      break;
    case BlockKind::spline:
      line.text("NURBS_FEED");
      coordinates(line, block.end);
      break;
    case BlockKind::probe:
      line.text("STRAIGHT_PROBE");
      coordinates(line, block.end);
      break;
    case BlockKind::rigid_tap:
      line.text("RIGID_TAP");
      coordinates(line, block.end);
      break;
    case BlockKind::sync_start:
      line.text("START_SPEED_FEED_SYNC");
      line.fixed(block.value);
      line.text(" ");
      line.integer(block.number);
      break;
    case BlockKind::sync_stop:
      line.text("STOP_SPEED_FEED_SYNC");
      break;
    case BlockKind::dwell:
      line.text("DWELL");
      line.fixed(block.dwell_s);
      break;
    case BlockKind::set_feed_rate:
      line.text("SET_FEED_RATE");
      line.fixed(block.value);
      break;
    case BlockKind::set_feed_mode:
      line.text(block.feed_mode == FeedMode::inverse_time           ? "SET_FEED_MODE G93"
                : block.feed_mode == FeedMode::units_per_revolution ? "SET_FEED_MODE G95"
                                                                    : "SET_FEED_MODE G94");
      break;
    case BlockKind::set_path_mode:
      line.text("SET_MOTION_CONTROL_MODE ");
      if (block.path_mode == PathMode::continuous) {
        line.text("CONTINUOUS");
        line.fixed(block.path_tolerance_mm);
      } else {
        line.text(block.path_mode == PathMode::exact_stop ? "EXACT_STOP" : "EXACT_PATH");
      }
      break;
    case BlockKind::spindle_speed:
      spindle(line, "SET_SPINDLE_SPEED");
      line.fixed(block.value);
      break;
    case BlockKind::spindle_clockwise:
      spindle(line, "START_SPINDLE_CLOCKWISE");
      break;
    case BlockKind::spindle_counterclockwise:
      spindle(line, "START_SPINDLE_COUNTERCLOCKWISE");
      break;
    case BlockKind::spindle_stop:
      if (block.on) {
        if (block.number < 0) return false;
        spindle(line, "ORIENT_SPINDLE");
        line.fixed(block.value);
        line.text(" ");
        line.integer(block.number);
        break;
      }
      spindle(line, "STOP_SPINDLE_TURNING");
      break;
    case BlockKind::mist_on:
      line.text("MIST_ON");
      break;
    case BlockKind::mist_off:
      line.text("MIST_OFF");
      break;
    case BlockKind::flood_on:
      line.text("FLOOD_ON");
      break;
    case BlockKind::flood_off:
      line.text("FLOOD_OFF");
      break;
    case BlockKind::select_tool:
      numbered(line, "SELECT_TOOL", block.number);
      break;
    case BlockKind::change_tool:
      numbered(line, "CHANGE_TOOL", block.number);
      break;
    case BlockKind::set_tool_number:
      numbered(line, "CHANGE_TOOL_NUMBER", block.number);
      break;
    case BlockKind::digital_output:
      numbered(line, "SET_DIGITAL", block.number);
      line.text(block.on ? " on" : " off");
      line.text(block.with_motion ? " @motion" : " @now");
      break;
    case BlockKind::analog_output:
      numbered(line, "SET_ANALOG", block.number);
      line.fixed(block.value);
      line.text(block.with_motion ? " @motion" : " @now");
      break;
    case BlockKind::wait_input:
      numbered(line, "WAIT_INPUT", block.wait.number);
      line.text(block.wait.analog ? " analog" : " digital");
      line.text(" ");
      line.text(kWaitModes.word(block.wait.mode));
      line.fixed(block.wait.timeout_s);
      break;
    case BlockKind::program_stop:
      line.text("PROGRAM_STOP");
      break;
    case BlockKind::optional_stop:
      line.text("OPTIONAL_PROGRAM_STOP");
      break;
    case BlockKind::program_end:
      if (block.number == 1) return false;
      line.text("PROGRAM_END");
      break;
    case BlockKind::message:
    case BlockKind::speed_point:
    case BlockKind::comment:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
    case BlockKind::spindle_mode:
      return false;
  }
  return true;
}

}  // namespace

void append_canon(std::string& out, const Block& block, std::string_view called_file) {
  if (block.kind == BlockKind::message) {
    out += "MESSAGE \"";
    append_quoted(out, block.text);
    out += '"';
    append_place(out, block, called_file);
  } else if (block.kind == BlockKind::comment) {
    out += "# ";
    append_quoted(out, block.text);
    append_place(out, block, called_file);
  } else {
    LineWriter line;
    if (!write(line, block)) return;
    if (called_file.empty()) line.place(block.span.line);
    line.finish(out);
    if (!called_file.empty()) append_place(out, block, called_file);
  }
}

}  // namespace kadr::gcode
