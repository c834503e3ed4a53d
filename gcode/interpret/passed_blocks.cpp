#include "gcode/interpret/passed_blocks.h"

#include <algorithm>
#include <optional>

#include "machine/base/variants.h"

namespace kadr::gcode {
namespace {

/// What a block sets. Of two blocks that set the same thing the later one holds.
struct Setting {
  BlockKind kind = BlockKind::comment;
  int number = 0;  ///< of an output
  bool operator==(const Setting&) const = default;
};

/// Nothing of a block that sets nothing: a move, a pause, a message.
struct SettingOf {
  using Maybe = std::optional<Setting>;

  template <OneOf<SetFeedRate, SetFeedMode, SetPathMode, SpindleSpeed, SpindleMode, SelectTool, FeedOverride,
                  SpeedOverride>
                Action>
  Maybe operator()(const Action&) const {
    return Setting{Action::kKind, 0};
  }
  Maybe operator()(const OneOf<SpindleClockwise, SpindleCounterclockwise, SpindleStop> auto&) const {
    return Setting{BlockKind::spindle_stop, 0};
  }
  Maybe operator()(const OneOf<MistOn, MistOff> auto&) const { return Setting{BlockKind::mist_off, 0}; }
  Maybe operator()(const OneOf<FloodOn, FloodOff> auto&) const { return Setting{BlockKind::flood_off, 0}; }
  Maybe operator()(const OneOf<ChangeTool, SetToolNumber> auto&) const {
    return Setting{BlockKind::set_tool_number, 0};
  }
  Maybe operator()(const DigitalOutput& output) const {
    return Setting{BlockKind::digital_output, output.number};
  }
  Maybe operator()(const AnalogOutput& output) const {
    return Setting{BlockKind::analog_output, output.number};
  }
  Maybe operator()(const Move&) const { return {}; }
  Maybe operator()(const OneOf<Dwell, InputWait, SyncStart, SyncStop, Message, ProgramStop, OptionalStop,
                               ProgramEnd, SpeedPoint, Comment> auto&) const {
    return {};
  }
};

std::optional<Setting> setting_of(const Block& block) { return std::visit(SettingOf{}, block.action); }

/// Whether a setting is what holds before a program's first block.
bool is_initial(const Block& block) {
  return std::visit(
      Overloaded{[](const SetFeedMode& feed) { return feed.mode == FeedMode::units_per_minute; },
                 [](const SetFeedRate& feed) { return feed.rate == 0; },
                 [](const SpindleMode& mode) { return mode.surface_speed_m_min == 0; },
                 [](const SpindleStop& stop) { return !stop.orientation; },
                 [](const OneOf<MistOff, FloodOff> auto&) { return true; },
                 [](const OneOf<FeedOverride, SpeedOverride> auto& lock) { return lock.enabled; },
                 [](const DigitalOutput& output) { return !output.on; },
                 [](const AnalogOutput& output) { return output.value == 0; },
                 [](const auto&) { return false; }},
      block.action);
}

bool waits(const Block& block) {
  return std::visit(
      Overloaded{[](const OneOf<DigitalOutput, AnalogOutput> auto& output) { return output.with_motion; },
                 [](const SpeedPoint&) { return true; }, [](const auto&) { return false; }},
      block.action);
}

/// The same output, changed at once.
Block changed_now(Block block) {
  std::visit(Overloaded{[](OneOf<DigitalOutput, AnalogOutput> auto& output) { output.with_motion = false; },
                        [](auto&) {}},
             block.action);
  return block;
}

}  // namespace

void PassedBlocks::add(const Block& block) {
  if (is<SyncStart, SyncStop>(block)) in_step_ = is<SyncStart>(block);
  if (const auto* probe = std::get_if<Probe>(&block.action)) return move(*probe, probe->contact);
  if (const auto* tap = std::get_if<RigidTap>(&block.action)) return move(*tap, place_);
  if (const Move* way = move_of(block)) return move(*way, way->end);
  if (waits(block))
    waiting_.push_back(block);
  else
    set(block);
}

void PassedBlocks::move(const Move& move, const AxisValues& end) {
  moved_in_step_ = in_step_;
  // a move without a way takes no output along
  if (move.end == place_) return;
  place_ = end;
  for (const Block& block : waiting_) set(changed_now(block));
  waiting_.clear();
}

void PassedBlocks::set(const Block& block) {
  const std::optional<Setting> setting = setting_of(block);
  if (!setting) return;
  const auto same = [&](const Block& other) { return setting_of(other) == setting; };
  settings_.erase(std::remove_if(settings_.begin(), settings_.end(), same), settings_.end());
  settings_.push_back(block);
  // the tool is in the spindle: nothing is changed when the program is entered
  if (const auto* change = std::get_if<ChangeTool>(&block.action))
    settings_.back().action = SetToolNumber{change->tool};
}

std::vector<Block> PassedBlocks::settings() const {
  std::vector<Block> held = settings_;
  held.erase(std::remove_if(held.begin(), held.end(), is_initial), held.end());
  return held;
}

}  // namespace kadr::gcode
