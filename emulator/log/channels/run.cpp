#include "emulator/log/channels/run.h"

#include "emulator/log/log_types.h"
#include "emulator/log/tick_columns.h"
#include "machine/base/hash.h"
#include "machine/machine.h"

namespace kadr::log {

LogHeader log_header(const RunHeader& run) {
  const machine::MachineModel& machine = *run.machine;
  LogHeader h;
  h.log_format = kLogFormat;
  h.kadr_version = KADR_VERSION;
  h.base_hz = machine.clock.base_hz;
  h.control_tick_ticks = machine.clock.control_tick.value;
  h.program_name = run.program_name;
  if (run.program_text.size() <= kEmbeddedTextLimit) h.program_text = run.program_text;
  h.program_bytes = static_cast<std::int64_t>(run.program_text.size());
  Hash64 hash;
  hash.bytes(run.program_text.data(), run.program_text.size());
  h.program_hash = hash.digest();
  h.machine_toml = run.machine_toml;
  h.scenario_toml = run.scenario_toml;
  h.settings_toml = run.settings_toml;
  h.inputs_hash = run.inputs_hash;
  h.machine_name = machine.name;
  h.logs_ticks = machine.log.ticks;
  h.logs_steps = machine.log.steps;
  h.block_ticks = machine.log.block_ticks;
  h.viewer_every_ticks = viewer_every_ticks(machine);
  for (const machine::AxisModel& axis : machine.axis)
    h.axis.push_back({std::string(1, axis.letter), axis.kind == machine::AxisKind::rotary ? "deg" : "mm",
                      axis.step_u, axis.home_u, axis.has_plant});
  return h;
}

const char* check_message(LogHeader& h, std::string_view, const LogHeader&) {
  constexpr std::int64_t kMegahertz = 1'000'000, kMaxHz = 1'000'000'000'000, kMaxTau = 65536;
  const bool sane = h.base_hz >= kMegahertz && h.base_hz <= kMaxHz && h.base_hz % kMegahertz == 0 &&
                    h.control_tick_ticks >= 1 && h.control_tick_ticks <= kMaxTau &&
                    h.viewer_every_ticks >= 0 && h.block_ticks >= 1 && h.block_ticks <= kMaxBlockTicks &&
                    !h.axis.empty();
  return sane ? nullptr : "its numbers are not those of a run";
}

}  // namespace kadr::log
