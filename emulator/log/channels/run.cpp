#include "emulator/log/channels/run.h"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

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
  h.block_ticks = static_cast<std::int32_t>(machine.log.block_ticks.value);
  h.viewer_every_ticks = viewer_every_ticks(machine);
  for (const machine::AxisModel& axis : machine.axis)
    h.axis.push_back({std::string(1, axis.letter), axis.kind == machine::AxisKind::rotary ? "deg" : "mm",
                      axis.step_u, axis.home_u, axis.has_plant});
  for (const ReadFile& file : run.files) h.files.push_back(file_text(file));
  return h;
}

std::string file_text(const ReadFile& file) {
  return fmt::format("{} {} {} {}", file.role, file.bytes, hash_text(file.hash), file.name);
}

std::optional<ReadFile> parse_file_text(std::string_view text) {
  std::array<std::string_view, 3> words;
  for (std::string_view& word : words) {
    const auto blank = text.find(' ');
    if (blank == std::string_view::npos) return {};
    word = text.substr(0, blank);
    text.remove_prefix(blank + 1);
  }
  ReadFile file;
  const auto number = [](std::string_view digits, std::uint64_t& value, int base) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    return error == std::errc{} && end == digits.data() + digits.size();
  };
  if (!number(words[1], file.bytes, 10) || !number(words[2], file.hash, 16)) return {};
  file.role = words[0];
  file.name = text;
  return file;
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
