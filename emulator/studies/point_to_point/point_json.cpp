#include <fmt/format.h>

#include <cmath>

#include "emulator/studies/point_to_point/point_report.h"

namespace kadr::studies {
namespace {

using text::Json;

Json pieces_json(const planner::PointLaw& law) {
  Json pieces = Json::array();
  for (const planner::PointPiece& p : law.pieces())
    pieces.push_back({{"begin_s", p.begin_s},
                      {"duration_s", p.duration_s},
                      {"position_m", p.position_u},
                      {"speed_m_s", p.speed_u_s},
                      {"accel_m_s2", p.accel_u_s2},
                      {"jerk_m_s3", p.jerk_u_s3}});
  return pieces;
}

Json row_json(const PointRow& r) {
  Json j;
  j["law"] = r.name;
  j["xi"] = r.xi > 0 ? Json(r.xi) : Json(nullptr);
  j["duration_s"] = r.law.duration_s();
  j["peak_accel_m_s2"] = r.law.peak_accel_u_s2();
  j["peak_speed_m_s"] = r.law.peak_speed_u_s();
  j["peak_W"] = r.work.peak_W;
  j["least_W"] = r.work.least_W;
  j["energy_J"] = r.work.absolute_J;
  j["driving_J"] = r.work.positive_J;
  j["braking_J"] = r.work.recuperated_J;
  j["copper_m2_s3"] = r.work.copper_m2_s3;
  j["residual_m"] = r.amplitude_m;
  j["residual_peak_m"] = r.peaks.link_u;
  j["residual_peak_m_s"] = r.peaks.link_u_s;
  j["worst_1_pct_m"] = r.worst_m[0];
  j["worst_5_pct_m"] = r.worst_m[1];
  j["worst_10_pct_m"] = r.worst_m[2];
  return j;
}

}  // namespace

std::string point_csv(const PointStudy& study) {
  std::string out;
  for (const PointRow& r : study.rows) {
    const Json row = row_json(r);
    std::string names, values;
    for (const auto& [key, value] : row.items()) {
      names += (names.empty() ? "" : ",") + key;
      if (!values.empty() || key != "law") values += ',';
      if (value.is_string())
        values += '"' + value.get<std::string>() + '"';
      else if (!value.is_null())
        values += fmt::format("{}", value.get<double>());
    }
    if (out.empty()) out = names + '\n';
    out += values + '\n';
  }
  return out;
}

Json json_of(const PointQuestion& q, const PointStudy& study) {
  Json j;
  j["distance_m"] = q.task.distance_u;
  j["time_s"] = q.time_optimal ? Json(nullptr) : Json(q.time_s);
  j["speed_limit_m_s"] = q.task.speed_limit_u_s;
  j["accel_limit_m_s2"] = q.task.accel_limit_u_s2;
  j["shortest_s"] = study.shortest_s;
  j["drive"] = q.drive == planner::Drive::position ? "position" : "force";
  j["omega_rad_s"] = q.mode.omega_rad_s;
  j["zeta"] = q.mode.zeta;
  j["tuned_omega_rad_s"] = study.driven.mode.omega_rad_s;
  j["tuned_zeta"] = study.driven.mode.zeta;
  j["mass_kg"] = study.load.mass_kg;
  j["drive_ratio"] = study.load.drive_ratio;
  j["counterweight_ratio"] = study.load.counterweight_ratio;
  j["gravity_m_s2"] = study.load.gravity_m_s2;
  j["silent_t_laws"] = q.time_optimal ? Json(nullptr) : Json(study.zeros);
  j["chosen"] = study.rows[study.chosen].name;
  j["answer"] = study.answer;
  j["rapid"] = study.advice;
  j["no_room"] = study.left_out;
  j["laws"] = Json::array();
  for (const PointRow& r : study.rows) {
    Json row = row_json(r);
    row["pieces"] = pieces_json(r.law);
    j["laws"].push_back(std::move(row));
  }
  return j;
}

Json json_of(const std::vector<Table2Row>& rows) {
  Json out = Json::array();
  for (const Table2Row& row : rows)
    for (std::size_t i = 0; i < kTable2Columns.size(); ++i)
      out.push_back({{"zeta", row.zeta},
                     {"law", row.law},
                     {"quantity", kTable2Columns[i]},
                     {"unit", kTable2Units[i]},
                     {"printed", row.printed[i]},
                     {"as_printed", row.paper[i]},
                     {"agrees", row.agrees(i)},
                     {"physics", row.physics[i]}});
  return out;
}

Json json_of(const planner::PointFault& fault) {
  return {{"message", fault_text(fault)},
          {"what", fault.what},
          {"measured", std::isfinite(fault.measured) ? Json(fault.measured) : Json(nullptr)},
          {"allowed", fault.allowed}};
}

}  // namespace kadr::studies
