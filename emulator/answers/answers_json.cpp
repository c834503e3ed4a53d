#include "emulator/answers/answers_json.h"

#include <algorithm>

#include "emulator/text/units.h"
#include "machine/base/hash.h"

namespace kadr::answers {
namespace {

using text::Json;

double at_seconds(Ticks ticks, const machine::MachineModel& model) {
  return static_cast<double>(ticks.value) / static_cast<double>(model.clock.base_hz);
}

/// JSON has no infinity: a missing limit is null.
Json limit(double value) {
  if (value == machine::kInfinity || value == -machine::kInfinity) return nullptr;
  return value;
}

Json axis_json(const log::AxisSummary& x, const machine::AxisModel& axis, const machine::MachineModel& model,
               bool plant) {
  Json j;
  j["axis"] = std::string(1, axis.letter);
  j["unit"] = text::axis_unit(axis);
  j["pulses"] = x.pulses;
  j["net_steps"] = x.net_steps.value;
  j["end_steps"] = x.end_steps.value;
  j["end_u"] = x.end_u;
  j["min_u"] = x.min_u;
  j["max_u"] = x.max_u;
  j["peak_feed_u_s"] = x.peak_feed_u_s;
  j["peak_feed_at_s"] = at_seconds(x.peak_feed_tick, model);
  j["peak_accel_u_s2"] = x.peak_accel_u_s2;
  j["max_accel_u_s2"] = limit(axis.max_accel_u_s2);
  j["peak_jerk_u_s3"] = x.peak_jerk_u_s3;
  j["max_jerk_u_s3"] = limit(axis.max_jerk_u_s3);
  if (!plant || !axis.has_plant) {
    j["load"] = nullptr;
    return j;
  }
  Json load;
  load["peak_vibration_u"] = x.peak_vibration_u;
  load["peak_vibration_at_s"] = at_seconds(x.peak_vibration_tick, model);
  load["peak_vibration_line"] = x.peak_vibration_line;
  load["rms_vibration_u"] = x.rms_vibration_u;
  load["residual_u"] = x.residual_u;
  load["peak_following_u"] = x.peak_following_u;
  load["rms_following_u"] = x.rms_following_u;
  load["lost_steps"] = x.lost_steps.value;
  if (model.log.energy) {
    load["positive_J"] = x.positive_J;
    load["absolute_J"] = x.positive_J + x.recuperated_J;
    load["recuperated_J"] = x.recuperated_J;
  }
  j["load"] = std::move(load);
  return j;
}

Json alarm_json(const log::EventRecord& e, const machine::MachineModel& model) {
  Json j;
  j["code"] = code_name(e.code);
  j["tick"] = e.tick.value;
  j["at_s"] = at_seconds(e.tick, model);
  j["line"] = e.span.line;
  j["axis"] = e.axis < 0 ? Json(nullptr)
                         : Json(std::string(1, model.axis.at(static_cast<std::size_t>(e.axis)).letter));
  j["value"] = e.value;
  j["limit"] = limit(e.limit);
  j["text"] = e.text;
  return j;
}

}  // namespace

Json json_of(const std::vector<log::LimitShare>& shares) {
  Json list = Json::array();
  for (const log::LimitShare& share : shares)
    list.push_back({{"limited_by", share.limited_by}, {"time_s", share.time_s}});
  return list;
}

Json json_of(const ApproachRow& row) {
  Json j;
  j["line"] = row.line;
  j["time_s"] = row.time_s;
  j["axes"] = row.ways;
  return j;
}

Json json_of(const log::RunSummary& s, const SummaryContext& c) {
  const machine::MachineModel& model = *c.model;
  Json j;
  j["outcome"] = s.outcome.text();
  j["time_s"] = at_seconds(s.ticks, model);
  j["ticks"] = s.ticks.value;
  j["base_hz"] = model.clock.base_hz;
  j["control_ticks"] = s.control_ticks.value;
  j["motion_s"] = s.motion_s;
  j["dwell_s"] = s.dwell_s;
  if (c.approach) j["approach"] = json_of(*c.approach);
  j["blocks"] = s.blocks;
  j["path_unit"] = c.path_unit;
  j["path_u"] = s.path_u;
  j["mean_feed_u_s"] = s.mean_feed_u_s;
  j["peak_feed_u_s"] = s.peak_feed_u_s;
  j["pulses"] = s.pulses;
  j["steps_hash"] = hash_text(s.steps_hash);
  j["plant"] = c.plant;
  j["path_error_mm"] = c.plant ? Json(s.path_error_u) : Json(nullptr);
  j["held_error_u"] = s.held_error_u;
  Json axes = Json::array();
  for (std::size_t a = 0; a < s.axis.size(); ++a)
    axes.push_back(axis_json(s.axis[a], model.axis[a], model, c.plant));
  j["axes"] = std::move(axes);
  j["limited_by"] = json_of(s.limited_by);
  j["planned_s"] = s.planned_s;
  j["lost_by"] = json_of(s.lost_by);
  j["alarms"] = s.alarms;
  Json counts = Json::object();
  for (const auto& [code, count] : c.alarm_counts) counts[code_name(code)] = count;
  j["alarm_counts"] = std::move(counts);
  Json alarms = Json::array();
  for (const log::EventRecord& e : c.alarms) alarms.push_back(alarm_json(e, model));
  j["alarm_list"] = std::move(alarms);
  j["log"] = c.log_path.empty()
                 ? Json(nullptr)
                 : Json({{"path", c.log_path}, {"bytes", c.log_bytes ? Json(*c.log_bytes) : Json(nullptr)}});
  return j;
}

Json json_of(const CheckResult& r, const machine::MachineModel& model) {
  Json j;
  j["time_s"] = r.time_s;
  j["motion_s"] = r.motion_s;
  j["rapid_s"] = r.rapid_s;
  j["dwell_s"] = r.dwell_s;
  if (r.approach) j["approach"] = json_of(*r.approach);
  j["blocks"] = r.blocks;
  j["path_unit"] = r.path_unit;
  j["path_u"] = r.path_u;
  j["rapid_path_u"] = r.rapid_path_u;
  j["peak_u_s"] = r.peak_u_s;
  j["peak_line"] = r.peak_line;
  Json axes = Json::array();
  for (std::size_t a = 0; a < r.travel.size(); ++a) {
    Json x;
    x["axis"] = std::string(1, model.axis[a].letter);
    x["unit"] = text::axis_unit(model.axis[a]);
    x["min_u"] = r.travel[a].min_u;
    x["max_u"] = r.travel[a].max_u;
    x["soft_min_u"] = limit(model.axis[a].soft_min_u);
    x["soft_max_u"] = limit(model.axis[a].soft_max_u);
    axes.push_back(std::move(x));
  }
  j["axes"] = std::move(axes);
  j["limited_by"] = json_of(r.limited_by);
  return j;
}

Json json_of(const PlanRow& row) {
  Json j;
  j["line"] = row.line;
  j["text"] = row.text;
  j["motion"] = row.motion;
  j["unit"] = row.unit.empty() ? Json(nullptr) : Json(row.unit);
  j["length_u"] = row.length_u;
  j["begin_s"] = row.begin_s;
  j["time_s"] = row.time_s;
  j["programmed_u_s"] = row.programmed_u_s;
  j["peak_u_s"] = row.peak_u_s;
  j["end_u_s"] = row.end_u_s;
  j["limited_by"] = row.limited_by.empty() ? Json(nullptr) : Json(row.limited_by);
  if (row.motion == gcode::kBlockKinds.word(gcode::BlockKind::approach)) j["axes"] = row.ways;
  if (!row.stops_for.empty()) j["stops_for"] = row.stops_for;
  if (row.blockwise) {
    j["rule"] = row.rule.empty() ? Json(nullptr) : Json(row.rule);
    j["kl"] = row.kl;
    j["end_jump_u_s"] = row.end_jump_u_s;
  }
  if (row.positioned) {
    Json rapid;
    rapid["law"] = row.rapid_law;
    rapid["reason"] = row.rapid_reason.empty() ? Json(nullptr) : Json(row.rapid_reason);
    rapid["loss_s"] = row.rapid_loss_s;
    for (const auto& v : row.vibrations)
      rapid["vibrations"].push_back({{"axis", std::string(1, v.axis)}, {"hz", v.hz}, {"zeta", v.zeta}});
    for (const auto& [axis, residual_u] : row.residual_u)
      rapid["residual_u"][std::string(1, axis)] = residual_u;
    j["rapid"] = std::move(rapid);
  }
  return j;
}

}  // namespace kadr::answers
