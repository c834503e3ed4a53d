#include "emulator/studies/teach/bezier_report.h"

#include <fmt/format.h>

#include <cmath>

#include "emulator/studies/teach/pulses.h"
#include "emulator/text/text.h"

namespace kadr::studies {
namespace {

using text::Json;

constexpr double kSmooth = 1e-9;

/// "9.1706", without zeros at the end.
std::string plain(double value) {
  std::string text = text::fixed(value, 4);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string point(const planner::BezierVector& v, int axes) {
  std::string out = "(";
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) out += (k == 0 ? "" : ", ") + plain(v[k]);
  return out + ")";
}

/// "-2 t^3 + 9 t + 5"
std::string polynomial(const planner::Bezier& curve, std::size_t axis) {
  std::string out;
  for (std::size_t j = 4; j-- > 0;) {
    const double c = curve.coefficient(j)[axis];
    if (c == 0) continue;
    const std::string sign = c < 0 ? (out.empty() ? "-" : " - ") : (out.empty() ? "" : " + ");
    const std::string power = j == 0 ? "" : j == 1 ? "t" : fmt::format("t^{}", j);
    const std::string size = std::fabs(c) == 1 && j > 0 ? "" : plain(std::fabs(c));
    out += sign + size + (size.empty() || power.empty() ? "" : " ") + power;
  }
  return out.empty() ? "0" : out;
}

double curve_speed(const BezierSegment& s, const BezierDemand& demand) {
  return planner::curvature_speed_u_s(1 / s.smallest.radius_u, demand.acceleration_mm_s2);
}

std::string segment_text(const BezierSegment& s, std::size_t number, const BezierDemand& demand) {
  std::string out = fmt::format("curve {}, degree {}\n", number, s.curve.degree());
  for (std::size_t k = 0; k < static_cast<std::size_t>(s.curve.axes()); ++k)
    out += fmt::format("  {}(t) = {} mm\n", static_cast<char>(axis_letter(k) | 0x20), polynomial(s.curve, k));
  out += fmt::format("  length {} mm, |dB/dt| {} .. {} mm (ratio {})\n", text::fixed(s.length_mm, 6),
                     text::fixed(s.slowest_mm, 4), text::fixed(s.fastest_mm, 4),
                     text::fixed(s.fastest_mm / s.slowest_mm, 3));
  if (std::isinf(s.smallest.radius_u))
    out += "  straight: no curvature\n";
  else
    out += fmt::format("  R_min {} mm at t = {}\n", text::fixed(s.smallest.radius_u, 6),
                       text::fixed(s.smallest.t, 5));
  if (s.slowest_mm < kSmooth * s.fastest_mm) out += "  warning: a cusp: the direction reverses at once\n";
  out += fmt::format("  t(S): {} quintic parts keep the feed to 1e-6\n", s.fitted_parts);
  if (demand.acceleration_mm_s2 > 0 && !std::isinf(s.smallest.radius_u)) {
    const double most = curve_speed(s, demand);
    out += fmt::format("  at {} mm/s2 across the path {} mm/s are allowed", plain(demand.acceleration_mm_s2),
                       text::fixed(most, 3));
    if (demand.feed_mm_s > 0)
      out += demand.feed_mm_s > most ? fmt::format(": F asks {}, too fast", plain(demand.feed_mm_s))
                                     : fmt::format(": F asks {}", plain(demand.feed_mm_s));
    out += "\n";
  } else if (demand.feed_mm_s > 0 && !std::isinf(s.smallest.radius_u)) {
    out += fmt::format("  F {} mm/s needs {} mm/s2 across the path\n", plain(demand.feed_mm_s),
                       text::fixed(demand.feed_mm_s * demand.feed_mm_s / s.smallest.radius_u, 1));
  }
  if (s.length_tables.empty()) return out;
  text::TextTable table({{"t(S) by", text::TextTable::Align::left}, {"|t~-t| %"}, {"place mm"}, {"feed %"}});
  for (const LengthTableRow& row : s.length_tables)
    table.add({row.name, fmt::format("{:.3g}", 100 * row.error.reduced),
               fmt::format("{:.2e}", row.error.position_u), fmt::format("{:.2g}", 100 * row.error.feed)});
  return out + table.render("  ");
}

/// Smallest radius of both curves beside a joint.
double smallest_beside(const BezierStudy& study, std::size_t joint) {
  return std::min(study.segments[joint].smallest.radius_u, study.segments[joint + 1].smallest.radius_u);
}

std::string joint_text(const BezierStudy& study, std::size_t i, const BezierDemand& demand) {
  const planner::JointReport& j = study.joints[i];
  std::string out = fmt::format("joint {}/{}\n", i + 1, i + 2);
  if (j.gap_u > kSmooth) return out + fmt::format("  error: a gap of {} mm\n", plain(j.gap_u));
  if (j.tangent_angle_rad > kSmooth)
    return out + fmt::format("  a corner of {} deg\n", text::fixed(j.tangent_angle_rad * 180 / M_PI, 4));
  const bool c1 = std::fabs(j.speed_ratio - 1) < kSmooth, g2 = j.curvature_jump_per_u < kSmooth;
  const bool c2 = c1 && j.second_jump < kSmooth;
  out +=
      fmt::format("  {}: ratio of |dB/dt| {}, curvature {} and {} 1/mm, normals {} deg apart\n",
                  c2         ? "C2"
                  : c1 && g2 ? "C1, G2"
                  : g2       ? "G2"
                  : c1       ? "C1"
                             : "G1",
                  plain(j.speed_ratio), text::fixed(j.curvature_before_per_u, 6),
                  text::fixed(j.curvature_after_per_u, 6), text::fixed(j.normal_angle_rad * 180 / M_PI, 2));
  if (g2) return out;
  out += fmt::format("  the curvature vector jumps by {} 1/mm, {} of the largest curvature\n",
                     text::fixed(j.curvature_jump_per_u, 6),
                     percent(j.curvature_jump_per_u * smallest_beside(study, i)));
  if (demand.feed_mm_s > 0) {
    const double step = demand.feed_mm_s * demand.feed_mm_s * j.curvature_jump_per_u;
    out += fmt::format("  F {} mm/s: acceleration steps by {} mm/s2", plain(demand.feed_mm_s),
                       text::fixed(step, 1));
    if (demand.acceleration_mm_s2 > 0)
      out += fmt::format(", {} of the limit", percent(step / demand.acceleration_mm_s2));
    out += "\n";
  }
  const planner::Bezier &a = study.segments[i].curve, &b = study.segments[i + 1].curve;
  if (const auto r = planner::repair_g2(a, b))
    out +=
        fmt::format("  G2 with the second point kept: third point {} mm, plus any multiple of the tangent\n",
                    point(r->third, b.axes()));
  if (const auto r = planner::repair_c2(a, b))
    out += fmt::format("  C2: second point {} mm, third point {} mm\n", point(r->second, b.axes()),
                       point(r->third, b.axes()));
  return out;
}

Json vector_json(const planner::BezierVector& v, int axes) {
  return std::vector<double>(v.begin(), v.begin() + axes);
}

}  // namespace

bool allowed(const BezierStudy& study, const BezierDemand& demand) {
  for (const planner::JointReport& j : study.joints)
    if (j.gap_u > kSmooth) return false;
  if (demand.feed_mm_s <= 0 || demand.acceleration_mm_s2 <= 0) return true;
  for (const BezierSegment& s : study.segments)
    if (demand.feed_mm_s > curve_speed(s, demand)) return false;
  for (const planner::JointReport& j : study.joints)
    if (demand.feed_mm_s * demand.feed_mm_s * j.curvature_jump_per_u > demand.acceleration_mm_s2)
      return false;
  return true;
}

std::string render_beziers(const BezierStudy& study, const BezierDemand& demand) {
  std::string out;
  for (std::size_t i = 0; i < study.segments.size(); ++i) {
    out += segment_text(study.segments[i], i + 1, demand);
    if (i < study.joints.size()) out += joint_text(study, i, demand);
  }
  return out;
}

Json json_of(const BezierStudy& study, const BezierDemand& demand) {
  Json j;
  j["curves"] = Json::array();
  for (const BezierSegment& s : study.segments) {
    Json c = {{"degree", s.curve.degree()}, {"coefficients_mm", Json::array()}};
    for (std::size_t p = 0; p <= static_cast<std::size_t>(s.curve.degree()); ++p)
      c["coefficients_mm"].push_back(vector_json(s.curve.coefficient(p), s.curve.axes()));
    c["length_mm"] = s.length_mm;
    const bool bent = std::isfinite(s.smallest.radius_u);
    c["smallest_radius_mm"] = bent ? Json(s.smallest.radius_u) : Json(nullptr);
    c["smallest_radius_t"] = bent ? Json(s.smallest.t) : Json(nullptr);
    c["quintic_parts"] = s.fitted_parts;
    if (demand.acceleration_mm_s2 > 0)
      c["allowed_mm_s"] = bent ? Json(curve_speed(s, demand)) : Json(nullptr);
    if (!s.length_tables.empty()) c["t_of_length"] = Json::array();
    for (const LengthTableRow& row : s.length_tables)
      c["t_of_length"].push_back({{"method", row.name},
                                  {"reduced_error", row.error.reduced},
                                  {"position_error_mm", row.error.position_u},
                                  {"feed_error", row.error.feed}});
    j["curves"].push_back(std::move(c));
  }
  j["joints"] = Json::array();
  for (const planner::JointReport& r : study.joints)
    j["joints"].push_back({{"gap_mm", r.gap_u},
                           {"tangent_angle_deg", r.tangent_angle_rad * 180 / M_PI},
                           {"speed_ratio", r.speed_ratio},
                           {"normal_angle_deg", r.normal_angle_rad * 180 / M_PI},
                           {"curvature_before_per_mm", r.curvature_before_per_u},
                           {"curvature_after_per_mm", r.curvature_after_per_u},
                           {"curvature_jump_per_mm", r.curvature_jump_per_u}});
  j["allowed"] = allowed(study, demand);
  return j;
}

}  // namespace kadr::studies
