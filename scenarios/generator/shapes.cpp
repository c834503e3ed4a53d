#include "scenarios/generator/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "machine/base/numbers.h"

namespace kadr::scenarios {

namespace {

constexpr double kDegPerRad = 180.0 / kPi;

/// Smallest k >= least with gcd(k, n) = 1, so that a pattern of n circuits closes only after all of them.
std::int64_t coprime_from(std::int64_t least, std::int64_t n) {
  std::int64_t k = least;
  while (std::gcd(k, n) != 1) ++k;  // ends within n steps: k = 1 mod n is coprime
  return k;
}

/// 0 to 1 with zero slope at both ends: 3 u^2 - 2 u^3.
double smooth_step(double u) { return u * u * (3.0 - 2.0 * u); }

}  // namespace

Winding hoop_winding(const WindValues& p) {
  const double radius = p["radius_mm"], length = p["length_mm"], band = p["band_mm"];
  const double eye = radius + p["gap_mm"];
  const int layers = static_cast<int>(p["layers"]);
  const double layer_deg = 360.0 * length / band;
  const int blocks = static_cast<int>(std::ceil(layer_deg / p["step_deg"]));
  const int closing = static_cast<int>(std::ceil(360.0 / p["step_deg"]));
  const double lead_deg = exact_atan2(band, 2 * kPi * radius) * kDegPerRad;
  const double alpha_deg = 90.0 - lead_deg;
  // mm of fibre per degree of mandrel: the helix of one band per turn, and the plain circle
  const double wound = std::sqrt(radius * radius + (band / (2 * kPi)) * (band / (2 * kPi))) / kDegPerRad;
  const double circled = radius / kDegPerRad;

  Winding w;
  w.fibre_mm_s = p["fibre_mm_s"];
  w.circuits = layers;
  w.circuit_deg = layer_deg + 360.0;
  w.title = fmt::format("hoop winding, {} layers of {:.3f} turns", layers, length / band);
  auto add = [&](double x, double a_deg, double b_deg, double angle_deg, double fibre) {
    w.points.push_back({x, radius, a_deg, angle_deg, x, eye, a_deg, b_deg, fibre});
  };
  double a_deg = 0;
  add(0, a_deg, 0, 90, 0);
  // one closing turn at the beginning, at each change of direction and at the end; the eye turns over in it
  auto close = [&](double x, double from_deg, double to_deg) {
    for (int i = 1; i <= closing; ++i) {
      const double u = static_cast<double>(i) / closing;
      add(x, a_deg + 360.0 * u, from_deg + (to_deg - from_deg) * smooth_step(u), 90,
          circled * 360.0 / closing);
    }
    a_deg += 360.0;
  };
  close(0, 0, lead_deg);
  for (int layer = 0; layer < layers; ++layer) {
    const bool forth = layer % 2 == 0;
    const double begin = forth ? 0 : length, way = forth ? length : -length;
    const double b_deg = forth ? lead_deg : -lead_deg;
    for (int i = 1; i <= blocks; ++i) {
      const double u = static_cast<double>(i) / blocks;
      add(begin + way * u, a_deg + layer_deg * u, b_deg, alpha_deg, wound * layer_deg / blocks);
    }
    a_deg += layer_deg;
    close(begin + way, b_deg, layer + 1 < layers ? -b_deg : 0.0);
  }
  return w;
}

Winding helix_winding(const WindValues& p) {
  const double radius = p["radius_mm"], length = p["length_mm"];
  const double alpha = p["angle_deg"] / kDegPerRad;
  const SinCos angle = exact_sincos(alpha);
  const double tan_alpha = angle.sin / angle.cos;
  const double eye = radius + p["gap_mm"];
  const double lead = std::sqrt(eye * eye - radius * radius) / tan_alpha;
  const double beta_deg = 90.0 - p["angle_deg"];
  const double stroke_deg = length * tan_alpha / radius * kDegPerRad;
  const auto circuits = static_cast<std::int64_t>(std::ceil(2 * kPi * radius * angle.cos / p["band_mm"]));
  const double least_deg = (2 * stroke_deg + 2 * p["turn_deg"]) * static_cast<double>(circuits) / 360.0;
  const std::int64_t k = coprime_from(static_cast<std::int64_t>(std::ceil(least_deg)), circuits);
  const double circuit_deg = 360.0 * static_cast<double>(k) / static_cast<double>(circuits);
  const double turn_deg = (circuit_deg - 2 * stroke_deg) / 2;

  const int stroke_blocks = static_cast<int>(std::ceil(length / p["step_mm"]));
  // blocks of a turn lay about as much mandrel angle as those of a stroke
  const int turn_blocks = std::max(16, static_cast<int>(std::ceil(turn_deg / (stroke_deg / stroke_blocks))));
  const double fibre_per_deg = radius / (kDegPerRad * angle.sin);
  // carriage travel of a turn at stroke speed; the cubic starts and ends with this slope
  const double slope = length / stroke_deg * turn_deg;

  Winding w;
  w.fibre_mm_s = p["fibre_mm_s"];
  w.circuits = static_cast<int>(circuits);
  w.circuit_deg = circuit_deg;
  w.title = fmt::format("helical winding, {} circuits in {} turns, turn at the end {:.3f} deg", circuits, k,
                        turn_deg);
  double a_deg = 0;
  w.points.push_back({0, radius, 0, p["angle_deg"], lead, eye, 0, beta_deg, 0});
  for (std::int64_t circuit = 0; circuit < circuits; ++circuit) {
    for (const int way : {1, -1}) {
      const double begin = way > 0 ? 0 : length;
      for (int i = 1; i <= stroke_blocks; ++i) {
        const double u = static_cast<double>(i) / stroke_blocks;
        const double contact = begin + way * length * u;
        w.points.push_back({contact, radius, a_deg + stroke_deg * u, p["angle_deg"], contact + way * lead,
                            eye, a_deg + stroke_deg * u, way * beta_deg,
                            fibre_per_deg * stroke_deg / stroke_blocks});
      }
      a_deg += stroke_deg;
      // the turn: the fibre goes around the end while the eye turns over and the carriage takes back the lead
      const double end = begin + way * length;
      for (int i = 1; i <= turn_blocks; ++i) {
        const double u = static_cast<double>(i) / turn_blocks;
        const double x = end + way * (lead + slope * u * (1 - u) - 2 * lead * smooth_step(u));
        w.points.push_back({end, radius, a_deg + turn_deg * u, 90, x, eye, a_deg + turn_deg * u,
                            way * beta_deg * (1 - 2 * smooth_step(u)),
                            fibre_per_deg * turn_deg / turn_blocks});
      }
      a_deg += turn_deg;
    }
  }
  return w;
}

namespace {

/// A point of the fibre on the mandrel; `way` +1 or -1 along the axis.
struct Contact {
  double x_mm, radius_mm, theta_rad, alpha_rad;
  int way;
};

/// Half a circuit: along the cylinder, then over the dome at its end and back to the cylinder's edge.
void half_circuit(std::vector<Contact>& out, const WindValues& p, int way, double& theta_rad) {
  const double radius = p["radius_mm"], length = p["length_mm"], polar = p["polar_mm"];
  const int blocks = static_cast<int>(p["blocks"]);
  const double sin_alpha = polar / radius;
  const double cos_alpha = std::sqrt(1 - sin_alpha * sin_alpha);
  const double alpha = exact_atan2(sin_alpha, cos_alpha);
  // along the cylinder the angle grows by tan(alpha)/R per mm
  for (int i = 0; i <= blocks; ++i) {
    const double x = length * (static_cast<double>(i) / blocks);
    out.push_back(
        {way * (x - length / 2), radius, theta_rad + x * sin_alpha / (cos_alpha * radius), alpha, way});
  }
  theta_rad += length * sin_alpha / (cos_alpha * radius);
  // over the dome: a great circle up to the latitude acos(r0/R); u counts along it from edge to edge
  const double sin_top = cos_alpha, tan_top = cos_alpha / sin_alpha;
  for (int i = 1; i < blocks; ++i) {
    const SinCos u = exact_sincos(kPi * i / blocks);
    const double sin_lat = sin_top * u.sin;
    const double cos_lat = std::sqrt(1 - sin_lat * sin_lat);
    const bool back = 2 * i > blocks;
    // asin(tan(lat)/tan(top)), on the way back pi minus that
    const double ratio = std::min(1.0, sin_lat / cos_lat / tan_top);
    const double turned = exact_atan2(ratio, (back ? -1 : 1) * std::sqrt(1 - ratio * ratio));
    const double r = radius * cos_lat;
    const double sin_here = std::min(1.0, polar / r);
    const double here = exact_atan2(sin_here, (back ? -1 : 1) * std::sqrt(1 - sin_here * sin_here));
    out.push_back({way * (length / 2 + radius * sin_lat), r, theta_rad + turned, here, way});
  }
  theta_rad += kPi;
}

/// Eye of a contact: contact + free * tangent, turned into the plane of the machine.
WindPoint eye_of(const Contact& c, const WindValues& p, double theta_rad) {
  const double radius = p["radius_mm"], half = p["length_mm"] / 2, free = p["free_mm"];
  const double beyond = std::fabs(c.x_mm) - half;
  const double sin_lat = beyond > 0 ? std::min(1.0, beyond / radius) : 0.0;
  const double cos_lat = std::sqrt(1 - sin_lat * sin_lat);
  const double side = c.x_mm >= 0 ? 1 : -1;
  const SinCos alpha = exact_sincos(c.alpha_rad);
  // tangent: cos(alpha) along the meridian in the direction of travel, sin(alpha) around the mandrel
  const double axial = alpha.cos * c.way * cos_lat;
  const double radial = -alpha.cos * side * c.way * sin_lat;
  const double hoop = alpha.sin;
  const double out = c.radius_mm + free * radial, round = free * hoop;
  WindPoint w;
  w.contact_x_mm = c.x_mm;
  w.contact_radius_mm = c.radius_mm;
  w.contact_deg = theta_rad * kDegPerRad;
  w.fibre_angle_deg = c.alpha_rad * kDegPerRad;
  w.x_mm = c.x_mm + free * axial;
  w.y_mm = std::sqrt(out * out + round * round);
  w.a_deg = (theta_rad + exact_atan2(round, out)) * kDegPerRad;
  w.b_deg = exact_atan2(axial, hoop) * kDegPerRad;
  return w;
}

}  // namespace

Winding dome_winding(const WindValues& p) {
  const double radius = p["radius_mm"], sin_alpha = p["polar_mm"] / radius;
  const double cos_alpha = std::sqrt(1 - sin_alpha * sin_alpha);
  std::vector<Contact> circuit;
  double turn_rad = 0;
  half_circuit(circuit, p, 1, turn_rad);
  half_circuit(circuit, p, -1, turn_rad);

  const auto circuits = static_cast<std::int64_t>(std::ceil(2 * kPi * radius * cos_alpha / p["band_mm"]));
  const double turns = turn_rad * static_cast<double>(circuits) / (2 * kPi);
  const std::int64_t k = coprime_from(static_cast<std::int64_t>(std::floor(turns + 0.5)), circuits);
  const double closed_rad = 2 * kPi * static_cast<double>(k) / static_cast<double>(circuits);
  const double extra_rad = closed_rad - turn_rad;

  Winding w;
  w.fibre_mm_s = p["fibre_mm_s"];
  w.circuits = static_cast<int>(circuits);
  w.circuit_deg = closed_rad * kDegPerRad;
  w.title = fmt::format("dome winding, {} circuits in {} turns, {:.3f} deg a circuit off the geodesic",
                        circuits, k, extra_rad * kDegPerRad);
  for (std::int64_t n = 0; n < circuits; ++n)
    for (std::size_t i = 0; i < circuit.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(circuit.size());
      const Contact& c = circuit[i];
      const double theta_rad = c.theta_rad + static_cast<double>(n) * closed_rad + extra_rad * share;
      WindPoint point = eye_of(c, p, theta_rad);
      if (!w.points.empty()) {
        const WindPoint& last = w.points.back();
        const double dx = c.x_mm - last.contact_x_mm, dr = c.radius_mm - last.contact_radius_mm;
        const double round =
            (point.contact_deg - last.contact_deg) / kDegPerRad * (c.radius_mm + last.contact_radius_mm) / 2;
        point.fibre_mm = std::sqrt(dx * dx + dr * dr + round * round);
      }
      w.points.push_back(point);
    }
  return w;
}

}  // namespace kadr::scenarios
