#include "emulator/cycle/program_event.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "machine/base/require.h"
#include "machine/base/variants.h"

namespace kadr::cycle {
namespace {

using gcode::Block;

/// Role of an action for the motion.
enum class Role : std::uint8_t {
  move,
  setting,      ///< in force in each move already: no event
  on_the_move,  ///< the machine need not stop
  with_motion,  ///< as the next motion begins
  at_rest,      ///< the machine stops
};

struct RoleOf {
  Role operator()(const gcode::Move&) const { return Role::move; }
  Role operator()(const OneOf<gcode::SetFeedRate, gcode::SetFeedMode, gcode::SetPathMode, gcode::SpeedPoint,
                              gcode::Comment> auto&) const {
    return Role::setting;
  }
  Role operator()(const OneOf<gcode::SpindleSpeed, gcode::SpindleMode, gcode::SyncStart, gcode::SyncStop,
                              gcode::SelectTool, gcode::SetToolNumber, gcode::Message, gcode::FeedOverride,
                              gcode::SpeedOverride> auto&) const {
    return Role::on_the_move;
  }
  Role operator()(const OneOf<gcode::DigitalOutput, gcode::AnalogOutput> auto& output) const {
    return output.with_motion ? Role::with_motion : Role::at_rest;
  }
  Role operator()(const OneOf<gcode::Dwell, gcode::InputWait, gcode::SpindleClockwise,
                              gcode::SpindleCounterclockwise, gcode::SpindleStop, gcode::MistOn,
                              gcode::MistOff, gcode::FloodOn, gcode::FloodOff, gcode::ChangeTool,
                              gcode::ProgramStop, gcode::OptionalStop, gcode::ProgramEnd> auto&) const {
    return Role::at_rest;
  }
};

Role role_of(const Block& block) { return std::visit(RoleOf{}, block.action); }

log::EventRecord record(log::EventKind kind, double value, std::string text) {
  log::EventRecord e;
  e.kind = kind;
  e.value = value;
  e.text = std::move(text);
  return e;
}

/// The record of each action that is an event.
struct RecordOf {
  const WaitOutcome& outcome;

  log::EventRecord operator()(const gcode::Dwell& dwell) const {
    return record(log::EventKind::dwell, dwell.time_s, fmt::format("dwell {:.6g} s", dwell.time_s));
  }
  log::EventRecord operator()(const gcode::InputWait& wait) const {
    const std::string input = fmt::format("{} input {}", wait.analog ? "analog" : "digital", wait.number);
    const auto waited = [&](const char* mode) {
      const std::string text =
          fmt::format("wait until {} {}, at most {:.6g} s: ", input, mode, wait.timeout_s);
      return text + (outcome.reached ? fmt::format("after {:.6g} s", outcome.waited_s) : "timed out");
    };
    switch (wait.mode) {
      case gcode::WaitMode::immediate:
        return record(log::EventKind::wait, outcome.value,
                      fmt::format("read {}: {:.6g}", input, outcome.value));
      case gcode::WaitMode::rise:
        return record(log::EventKind::wait, outcome.value, waited("rises"));
      case gcode::WaitMode::fall:
        return record(log::EventKind::wait, outcome.value, waited("falls"));
      case gcode::WaitMode::high:
        return record(log::EventKind::wait, outcome.value, waited("is high"));
      case gcode::WaitMode::low:
        return record(log::EventKind::wait, outcome.value, waited("is low"));
    }
    return {};
  }
  /// Contact position, all three linear axes: the block no longer knows which ones the move named.
  log::EventRecord operator()(const gcode::Probe& probe) const {
    if (!probe.tripped) return record(log::EventKind::probe, 0, "no contact");
    std::string text = probe.away ? "contact lost at" : "contact at";
    for (std::size_t a = 0; a < 3; ++a) text += fmt::format(" {}{:.6g}", kAxisLetters[a], probe.contact[a]);
    return record(log::EventKind::probe, 1, text + " (machine coordinates, mm)");
  }

  log::EventRecord operator()(const gcode::SpindleSpeed& speed) const {
    return record(log::EventKind::spindle, speed.s_word,
                  speed.surface_speed_m_min > 0
                      ? fmt::format("surface speed {:.6g} m/min", speed.surface_speed_m_min)
                      : fmt::format("spindle speed {:.6g} rpm", speed.s_word));
  }
  log::EventRecord operator()(const gcode::SpindleClockwise& start) const {
    return record(log::EventKind::spindle, start.speed_rpm,
                  fmt::format("spindle clockwise {:.6g} rpm", start.speed_rpm));
  }
  log::EventRecord operator()(const gcode::SpindleCounterclockwise& start) const {
    return record(log::EventKind::spindle, start.speed_rpm,
                  fmt::format("spindle counter-clockwise {:.6g} rpm", start.speed_rpm));
  }
  log::EventRecord operator()(const gcode::SpindleStop& stop) const {
    return record(log::EventKind::spindle, stop.orientation ? stop.orientation->direction : 0,
                  "spindle stop");
  }
  log::EventRecord operator()(const gcode::SpindleMode& mode) const {
    std::string text = "spindle at constant speed";
    if (mode.surface_speed_m_min > 0)
      text = fmt::format("constant surface speed {:.6g} m/min", mode.surface_speed_m_min);
    if (mode.surface_speed_m_min > 0 && mode.maximum_rpm > 0)
      text += fmt::format(", at most {:.6g} rpm", mode.maximum_rpm);
    return record(log::EventKind::spindle, mode.surface_speed_m_min, text);
  }
  log::EventRecord operator()(const gcode::SyncStart& sync) const {
    return record(log::EventKind::sync, sync.pitch_mm_rev,
                  fmt::format("feed follows the spindle's angle, {:.6g} mm per turn", sync.pitch_mm_rev));
  }
  log::EventRecord operator()(const gcode::SyncStop&) const {
    return record(log::EventKind::sync, 0, "feed no longer follows the spindle");
  }

  log::EventRecord operator()(const gcode::MistOn&) const {
    return record(log::EventKind::coolant, 0, "mist on");
  }
  log::EventRecord operator()(const gcode::MistOff&) const {
    return record(log::EventKind::coolant, 0, "mist off");
  }
  log::EventRecord operator()(const gcode::FloodOn&) const {
    return record(log::EventKind::coolant, 0, "flood on");
  }
  log::EventRecord operator()(const gcode::FloodOff&) const {
    return record(log::EventKind::coolant, 0, "flood off");
  }
  log::EventRecord operator()(const gcode::SelectTool& select) const {
    return record(log::EventKind::tool, select.tool, fmt::format("select tool {}", select.tool));
  }
  log::EventRecord operator()(const gcode::ChangeTool& change) const {
    return record(log::EventKind::tool, change.tool, fmt::format("change to tool {}", change.tool));
  }
  log::EventRecord operator()(const gcode::SetToolNumber& set) const {
    return record(log::EventKind::tool, set.tool,
                  fmt::format("the tool in the spindle is tool {}", set.tool));
  }
  log::EventRecord operator()(const gcode::DigitalOutput& output) const {
    return record(log::EventKind::output, output.on ? 1 : 0,
                  fmt::format("digital output {} {}", output.number, output.on ? "on" : "off"));
  }
  log::EventRecord operator()(const gcode::AnalogOutput& output) const {
    return record(log::EventKind::output, output.value,
                  fmt::format("analog output {} = {:.6g}", output.number, output.value));
  }

  log::EventRecord operator()(const gcode::Message& message) const {
    const std::size_t first = std::min(message.text.find_first_not_of(' '), message.text.size());
    return record(log::EventKind::message, 0, message.text.substr(first));
  }
  log::EventRecord operator()(const gcode::ProgramStop&) const {
    return record(log::EventKind::stop, 0, "program stop");
  }
  log::EventRecord operator()(const gcode::OptionalStop&) const {
    return record(log::EventKind::stop, 0, "optional stop");
  }
  log::EventRecord operator()(const gcode::ProgramEnd& end) const {
    return record(log::EventKind::stop, end.by_percent ? 1 : 0, "program end");
  }
  log::EventRecord operator()(const gcode::FeedOverride& feed) const {
    return record(log::EventKind::lock, feed.enabled ? 1 : 0,
                  feed.enabled ? "feed override enabled" : "feed override locked");
  }
  log::EventRecord operator()(const gcode::SpeedOverride& speed) const {
    return record(log::EventKind::lock, speed.enabled ? 1 : 0,
                  speed.enabled ? "spindle override enabled" : "spindle override locked");
  }

  log::EventRecord operator()(
      const OneOf<gcode::Traverse, gcode::Feed, gcode::Arc, gcode::Spline, gcode::RigidTap, gcode::Approach,
                  gcode::SetFeedRate, gcode::SetFeedMode, gcode::SetPathMode, gcode::SpeedPoint,
                  gcode::Comment> auto&) const {
    require(false, "moves and settings are no events");
    return {};
  }
};

}  // namespace

bool waits_for_motion(const Block& block) { return role_of(block) == Role::with_motion; }

bool needs_rest(const Block& block) { return role_of(block) == Role::at_rest; }

bool is_event(const Block& block) {
  switch (role_of(block)) {
    case Role::move:
    case Role::setting:
      return false;
    case Role::on_the_move:
    case Role::with_motion:
    case Role::at_rest:
      return true;
  }
  return false;
}

log::EventRecord event_record(const ProgramEvent& event) {
  return std::visit(RecordOf{event.wait}, event.block.action);
}

}  // namespace kadr::cycle
