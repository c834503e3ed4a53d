#include "emulator/log/channels/ticks.h"

#include "emulator/log/channels/run.h"

namespace kadr::log {

std::string_view field::limit_word(std::int64_t number) {
  const auto reason = kLimitedBy.at(number);
  return reason ? kLimitedBy.word(*reason) : "unknown";
}

void append_tick(TickBlock& b, const TickSource& tick) {
  const TickRecord& record = tick.record;
  const TickMotion& motion = *record.motion;
  b.feed_u_s.push_back(motion.speed_end_u_s);
  b.accel_u_s2.push_back(motion.accel_end_u_s2);
  b.path_u.push_back(motion.s_end_u);
  b.override_used.push_back(motion.override_used);
  b.limited_by.push_back(static_cast<std::int8_t>(motion.limited_by));
  b.limiting_axis.push_back(motion.limiting_axis);
  b.block.push_back(record.block);
  b.has_override = record.has_override;
  if (record.has_override) {
    b.override_requested.push_back(motion.override_requested);
    b.limiter.push_back(motion.limiter);
    b.override_note.push_back(static_cast<std::int8_t>(motion.note));
  }
  b.axis.resize(tick.batch.axis.size());
  b.has_plant = record.axis != nullptr;
  for (std::size_t a = 0; a < b.axis.size(); ++a) {
    AxisTicks& axis = b.axis[a];
    axis.steps.push_back(tick.node[a].value);
    axis.command_u.push_back(tick.batch.axis[a].command.position_end_u);
    if (!b.has_plant) continue;
    const AxisState& state = (*record.axis)[a];
    axis.base_u.push_back(state.base_u);
    axis.base_u_s.push_back(state.base_u_s);
    axis.link_u.push_back(state.link_u);
    axis.link_u_s.push_back(state.link_u_s);
    axis.motor_force_N.push_back(state.motor_force_N);
  }
}

const char* check_message(TickBlock& b, std::string_view, const LogHeader& header) {
  if (!begins_at_its_tick(b.begin, b.first, header)) return "its control tick does not begin at its tick";
  b.has_plant = !b.axis.front().base_u.empty();
  b.has_override = !b.override_requested.empty();
  if (!b.has_override) {
    b.override_requested = b.override_used;
    b.limiter.assign(b.size(), 1.0);
    b.override_note.assign(b.size(), 0);
  }
  return nullptr;
}

}  // namespace kadr::log
