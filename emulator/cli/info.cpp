#include <fmt/format.h>

#include <algorithm>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/log/log_info.h"
#include "machine/base/hash.h"

namespace kadr::cli {
namespace {

using log::LogInfo;
using text::Json;

Json hash_json(const std::optional<std::uint64_t>& hash) {
  return hash ? Json(hash_text(*hash)) : Json(nullptr);
}
Json agreement(const std::optional<bool>& agrees) { return agrees ? Json(*agrees) : Json(nullptr); }

Json info_json(const LogInfo& info) {
  Json j;
  j["file"] = info.path;
  j["state"] = log::log_state_name(info.end.state);
  j["detail"] = info.end.detail;
  j["file_bytes"] = info.end.file_bytes;
  j["valid_bytes"] = info.end.valid_bytes;
  j["valid_until_tick"] = info.end.valid_until.value;
  j["valid_until_s"] = info.header.seconds(info.end.valid_until);
  j["log_format"] = info.header.log_format;
  j["kadr"] = info.header.kadr_version;
  j["program"] = info.header.program_name;
  j["program_bytes"] = info.header.program_bytes;
  j["machine"] = info.header.machine_name;
  j["base_hz"] = info.header.base_hz;
  j["control_tick_ticks"] = info.header.control_tick_ticks;
  j["span_s"] = info.span_s;
  j["control_ticks"] = info.control_ticks;
  j["blocks"] = info.blocks;
  j["events"] = info.events;
  j["alarms"] = info.alarms;
  j["diagnostics"] = info.diagnostics;
  Json axes = Json::array();
  for (std::size_t a = 0; a < info.header.axis.size(); ++a) {
    const log::LogAxis& axis = info.header.axis[a];
    axes.push_back({{"axis", axis.name},
                    {"unit", axis.unit},
                    {"step_u", axis.step_u},
                    {"pulses", a < info.pulses.size() ? Json(info.pulses[a]) : Json(nullptr)}});
  }
  j["axes"] = std::move(axes);
  Json channels = Json::array();
  for (const log::ChannelInfo& c : info.channels)
    channels.push_back({{"channel", c.name}, {"messages", c.messages}, {"bytes", c.bytes}});
  j["channels"] = std::move(channels);
  j["outcome"] = info.summary ? Json(info.summary->run.outcome.text()) : Json(nullptr);
  Json files = Json::array();
  for (const std::string& text : info.header.files)
    if (const auto file = log::parse_file_text(text))
      files.push_back({{"role", file->role},
                       {"name", file->name},
                       {"bytes", file->bytes},
                       {"hash", hash_text(file->hash)}});
  j["files"] = std::move(files);
  j["inputs_hash"] = hash_text(info.header.inputs_hash);
  j["program_hash"] = hash_text(info.header.program_hash);
  j["steps_hash"] = hash_json(info.steps_hash);
  j["steps_hash_agrees"] = agreement(info.steps_hash_agrees());
  j["content_hash"] = hash_text(info.content_hash);
  j["content_hash_agrees"] = agreement(info.content_hash_agrees());
  j["log_hash"] = hash_json(info.log_hash);
  j["log_hash_agrees"] = agreement(info.log_hash_agrees());
  j["file_hash"] = hash_text(info.file_hash);
  if (!info.end.passed_over.empty()) j["passed_over"] = info.end.passed_over;
  return j;
}

}  // namespace

int log_info(const Arguments& arguments, Console& console) {
  int worst = kYes;
  Json documents = Json::array();
  bool first = true;
  for (const std::string& path : arguments.files) {
    const auto info = log::log_info(path);
    if (!info) {
      console.error(fmt::format("{}: {}", info.error().path, info.error().reason));
      worst = kNotStarted;
      continue;
    }
    worst = std::max(worst, log::is_sound(info->end.state) ? kYes : kNo);
    if (console.options().json) {
      documents.push_back(info_json(*info));
    } else if (!console.options().quiet) {
      console.data((first ? "" : "\n") + log::render_log_info(*info));
    } else if (!log::is_sound(info->end.state)) {
      console.error(fmt::format("{}: {}", path, info->end.detail));
    }
    first = false;
  }
  if (console.options().json) console.document(documents);
  return worst;
}

}  // namespace kadr::cli
