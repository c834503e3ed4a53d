#include "emulator/cycle/program_event.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace kadr::emulator {
namespace {

using gcode::Block;
using gcode::BlockKind;

EventKind event_kind(BlockKind kind) {
  switch (kind) {
    case BlockKind::dwell:
      return EventKind::dwell;
    case BlockKind::spindle_speed:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::spindle_mode:
      return EventKind::spindle;
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
      return EventKind::sync;
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
      return EventKind::coolant;
    case BlockKind::select_tool:
    case BlockKind::change_tool:
    case BlockKind::set_tool_number:
      return EventKind::tool;
    case BlockKind::digital_output:
    case BlockKind::analog_output:
      return EventKind::output;
    case BlockKind::wait_input:
      return EventKind::wait;
    case BlockKind::probe:
      return EventKind::probe;
    case BlockKind::message:
      return EventKind::message;
    case BlockKind::feed_override:
    case BlockKind::speed_override:
      return EventKind::lock;
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::rigid_tap:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return EventKind::stop;
}

/// "X -1.5 mm, Z 3 mm": the axes that a probing move named would be lost; all that the machine may have
/// moved.
std::string contact_text(const Block& b) {
  if (!b.probe.tripped) return "no contact";
  std::string text = b.probe.away ? "contact lost at" : "contact at";
  for (std::size_t a = 0; a < 3; ++a) text += fmt::format(" {}{:.6g}", kAxisLetters[a], b.contact[a]);
  return text + " (machine coordinates, mm)";
}

std::string wait_text(const Block& b) {
  constexpr std::array<std::string_view, 5> kModes = {"", " rises", " falls", " is high", " is low"};
  const auto mode = kModes[static_cast<std::size_t>(b.wait.mode)];
  const std::string input = fmt::format("{} input {}", b.wait.analog ? "analog" : "digital", b.wait.number);
  if (mode.empty()) return fmt::format("read {}: {:.6g}", input, b.value);
  const std::string text = fmt::format("wait until {}{}, at most {:.6g} s: ", input, mode, b.wait.timeout_s);
  return text + (b.on ? fmt::format("after {:.6g} s", b.dwell_s) : std::string("timed out"));
}

std::string spindle_text(const Block& b) {
  if (b.kind == BlockKind::spindle_speed && b.surface_speed_m_min > 0)
    return fmt::format("surface speed {:.6g} m/min", b.surface_speed_m_min);
  if (b.kind == BlockKind::spindle_speed) return fmt::format("spindle speed {:.6g} rpm", b.value);
  if (b.kind == BlockKind::spindle_clockwise) return fmt::format("spindle clockwise {:.6g} rpm", b.value);
  if (b.kind == BlockKind::spindle_counterclockwise)
    return fmt::format("spindle counter-clockwise {:.6g} rpm", b.value);
  if (b.kind == BlockKind::spindle_stop) return "spindle stop";
  if (b.kind == BlockKind::sync_start)
    return fmt::format("feed follows the spindle's angle, {:.6g} mm per turn", b.value);
  if (b.kind == BlockKind::sync_stop) return "feed no longer follows the spindle";
  if (!(b.surface_speed_m_min > 0)) return "spindle at constant speed";
  const std::string text = fmt::format("constant surface speed {:.6g} m/min", b.surface_speed_m_min);
  return b.maximum_rpm > 0 ? text + fmt::format(", at most {:.6g} rpm", b.maximum_rpm) : text;
}

std::string event_text(const Block& b) {
  switch (b.kind) {
    case BlockKind::dwell:
      return fmt::format("dwell {:.6g} s", b.dwell_s);
    case BlockKind::spindle_speed:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::spindle_mode:
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
      return spindle_text(b);
    case BlockKind::mist_on:
      return "mist on";
    case BlockKind::mist_off:
      return "mist off";
    case BlockKind::flood_on:
      return "flood on";
    case BlockKind::flood_off:
      return "flood off";
    case BlockKind::select_tool:
      return fmt::format("select tool {}", b.number);
    case BlockKind::change_tool:
      return fmt::format("change to tool {}", b.number);
    case BlockKind::set_tool_number:
      return fmt::format("the tool in the spindle is tool {}", b.number);
    case BlockKind::digital_output:
      return fmt::format("digital output {} {}", b.number, b.on ? "on" : "off");
    case BlockKind::analog_output:
      return fmt::format("analog output {} = {:.6g}", b.number, b.value);
    case BlockKind::wait_input:
      return wait_text(b);
    case BlockKind::probe:
      return contact_text(b);
    case BlockKind::feed_override:
      return b.number ? "feed override enabled" : "feed override locked";
    case BlockKind::speed_override:
      return b.number ? "spindle override enabled" : "spindle override locked";
    case BlockKind::program_stop:
      return "program stop";
    case BlockKind::optional_stop:
      return "optional stop";
    case BlockKind::program_end:
      return "program end";
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::rigid_tap:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::message:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return b.text.substr(std::min(b.text.find_first_not_of(' '), b.text.size()));
}

double event_value(const Block& b) {
  switch (b.kind) {
    case BlockKind::dwell:
      return b.dwell_s;
    case BlockKind::spindle_mode:
      return b.surface_speed_m_min;
    case BlockKind::spindle_speed:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::sync_start:
    case BlockKind::analog_output:
    case BlockKind::wait_input:
      return b.value;
    case BlockKind::digital_output:
      return b.on ? 1 : 0;
    case BlockKind::probe:
      return b.probe.tripped ? 1 : 0;
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::rigid_tap:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::spindle_stop:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::sync_stop:
    case BlockKind::select_tool:
    case BlockKind::change_tool:
    case BlockKind::set_tool_number:
    case BlockKind::message:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return b.number;
}

}  // namespace

bool waits_for_motion(const Block& block) {
  return (block.kind == BlockKind::digital_output || block.kind == BlockKind::analog_output) &&
         block.with_motion;
}

bool needs_rest(const Block& block) {
  switch (block.kind) {
    case BlockKind::dwell:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::change_tool:
    case BlockKind::wait_input:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
      return true;
    case BlockKind::digital_output:
    case BlockKind::analog_output:
      return !block.with_motion;
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::probe:
    case BlockKind::rigid_tap:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::spindle_speed:
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
    case BlockKind::spindle_mode:
    case BlockKind::select_tool:
    case BlockKind::set_tool_number:
    case BlockKind::message:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return false;
}

bool is_event(const Block& block) {
  switch (block.kind) {
    case BlockKind::spindle_speed:
    case BlockKind::spindle_mode:
    case BlockKind::sync_start:
    case BlockKind::sync_stop:
    case BlockKind::select_tool:
    case BlockKind::set_tool_number:
    case BlockKind::digital_output:
    case BlockKind::analog_output:
    case BlockKind::message:
    case BlockKind::feed_override:
    case BlockKind::speed_override:
      return true;
    case BlockKind::traverse:
    case BlockKind::feed:
    case BlockKind::arc:
    case BlockKind::spline:
    case BlockKind::probe:
    case BlockKind::rigid_tap:
    case BlockKind::dwell:
    case BlockKind::set_feed_rate:
    case BlockKind::set_feed_mode:
    case BlockKind::set_path_mode:
    case BlockKind::spindle_clockwise:
    case BlockKind::spindle_counterclockwise:
    case BlockKind::spindle_stop:
    case BlockKind::mist_on:
    case BlockKind::mist_off:
    case BlockKind::flood_on:
    case BlockKind::flood_off:
    case BlockKind::change_tool:
    case BlockKind::wait_input:
    case BlockKind::program_stop:
    case BlockKind::optional_stop:
    case BlockKind::program_end:
    case BlockKind::speed_point:
    case BlockKind::comment:
      break;
  }
  return needs_rest(block);
}

EventRecord event_record(const Block& block) {
  EventRecord e;
  e.kind = event_kind(block.kind);
  e.value = event_value(block);
  e.text = event_text(block);
  return e;
}

}  // namespace kadr::emulator
