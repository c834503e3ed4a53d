#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "machine/base/numbers.h"
#include "machine/base/parse_number.h"
#include "scenarios/generator/wind.h"

using namespace kadr;
using namespace kadr::scenarios;

namespace {

struct Vec3 {
  double x, y, z;
};
Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double norm(Vec3 a) { return std::sqrt(dot(a, a)); }

// in the frame that turns with the mandrel, axis along x
Vec3 contact_of(const WindPoint& p) {
  const double t = p.contact_deg * kPi / 180;
  return {p.contact_x_mm, p.contact_radius_mm * std::cos(t), p.contact_radius_mm * std::sin(t)};
}
Vec3 eye_of(const WindPoint& p) {
  const double a = p.a_deg * kPi / 180;
  return {p.x_mm, p.y_mm * std::cos(a), p.y_mm * std::sin(a)};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    out.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

double word(const std::string& line, char letter) {
  const std::size_t at = line.find(letter);
  REQUIRE(at != std::string::npos);
  const std::size_t end = line.find(' ', at);
  const auto value = parse_number(line.substr(at + 1, end == std::string::npos ? end : end - at - 1));
  REQUIRE(value.has_value());
  return *value;
}

}  // namespace

TEST_CASE("a hoop winding advances one band a turn and leads by atan(band / (2 pi R))") {
  const auto w = wind("hoop", {{"radius_mm", 50}, {"length_mm", 300}, {"band_mm", 6}, {"layers", 2}});
  REQUIRE(w);
  // atan(6/(2 pi 50)) = atan(0.0190986) = 1.09413 deg
  const double lead_deg = 1.09413;
  std::size_t wound = 0;
  for (std::size_t i = 1; i < w->points.size(); ++i) {
    const WindPoint &a = w->points[i - 1], &b = w->points[i];
    CHECK(b.a_deg > a.a_deg);
    CHECK(b.y_mm == 70.0);
    if (b.x_mm == a.x_mm) continue;  // closing turn
    ++wound;
    CHECK(std::fabs(b.x_mm - a.x_mm) / (b.a_deg - a.a_deg) == doctest::Approx(6.0 / 360).epsilon(1e-9));
    CHECK(b.b_deg == doctest::Approx(b.x_mm > a.x_mm ? lead_deg : -lead_deg).epsilon(1e-5));
    // a block's fibre is the helix over it: sqrt((R dA)^2 + dX^2)
    const double arc = 50 * (b.a_deg - a.a_deg) * kPi / 180;
    CHECK(b.fibre_mm ==
          doctest::Approx(std::sqrt(arc * arc + (b.x_mm - a.x_mm) * (b.x_mm - a.x_mm))).epsilon(1e-9));
  }
  CHECK(wound == 2 * 3600);  // 50 turns of 72 blocks, twice
  // two layers of 50 turns and three closing turns
  CHECK(w->points.back().a_deg == doctest::Approx(103 * 360.0));
  CHECK(w->points.back().x_mm == doctest::Approx(0.0));
}

TEST_CASE("a helical winding closes only after all its circuits and covers the mandrel") {
  const auto w = wind("helix", {{"radius_mm", 50}, {"length_mm", 300}, {"angle_deg", 45}, {"band_mm", 8}});
  REQUIRE(w);
  // n = ceil(2 pi 50 cos(45)/8) = ceil(27.77) = 28;  stroke = 300 tan(45)/50 rad = 343.775 deg
  CHECK(w->circuits == 28);
  const double turns = w->circuit_deg * 28 / 360;
  CHECK(turns == doctest::Approx(std::round(turns)));
  CHECK(std::gcd(static_cast<int>(std::round(turns)), 28) == 1);
  CHECK(w->points.back().a_deg == doctest::Approx(28 * w->circuit_deg));
  // the circuits begin at 28 different places, 360/28 deg apart
  std::set<long> places;
  for (int n = 0; n < 28; ++n)
    places.insert(std::lround(std::fmod(n * w->circuit_deg, 360.0) * 28 / 360) % 28);
  CHECK(places.size() == 28);
}

TEST_CASE("on a helical stroke the free fibre leaves the mandrel as a tangent at the fibre angle") {
  const double alpha_deg = 55;
  const auto w = wind("helix", {{"radius_mm", 40}, {"angle_deg", alpha_deg}, {"gap_mm", 25}});
  REQUIRE(w);
  std::size_t strokes = 0;
  for (std::size_t i = 1; i < w->points.size(); ++i) {
    const WindPoint &a = w->points[i - 1], &b = w->points[i];
    if (b.fibre_angle_deg != alpha_deg) continue;
    ++strokes;
    // dA/dX = tan(alpha)/R
    if (a.fibre_angle_deg == alpha_deg || i == 1)
      CHECK((b.a_deg - a.a_deg) * kPi / 180 / std::fabs(b.contact_x_mm - a.contact_x_mm) ==
            doctest::Approx(std::tan(alpha_deg * kPi / 180) / 40).epsilon(1e-9));
    // seen from the contact the eye is sqrt(65^2 - 40^2) = 51.235 mm round and 51.235/tan(55) = 35.875 mm along
    CHECK(std::fabs(b.x_mm - b.contact_x_mm) == doctest::Approx(35.875).epsilon(1e-4));
    CHECK(std::fabs(b.b_deg) == doctest::Approx(90 - alpha_deg));
  }
  CHECK(strokes == 2u * static_cast<std::size_t>(w->circuits) * 150);
}

TEST_CASE("a dome winding follows geodesics: r sin(alpha) stays the polar radius") {
  const double polar = 20, free = 60, radius = 60, half = 100;
  const auto w =
      wind("dome", {{"radius_mm", radius}, {"length_mm", 2 * half}, {"polar_mm", polar}, {"free_mm", free}});
  REQUIRE(w);
  double least_radius = radius;
  for (std::size_t i = 0; i < w->points.size(); ++i) {
    const WindPoint& p = w->points[i];
    CHECK(p.contact_radius_mm * std::sin(p.fibre_angle_deg * kPi / 180) ==
          doctest::Approx(polar).epsilon(1e-6));
    least_radius = std::fmin(least_radius, p.contact_radius_mm);
    // the contact lies on the mandrel
    const double beyond = std::fmax(0.0, std::fabs(p.contact_x_mm) - half);
    CHECK(std::hypot(beyond, p.contact_radius_mm) == doctest::Approx(radius).epsilon(1e-9));
    // the free fibre has its length and touches: it is square to the surface's normal
    const Vec3 fibre = eye_of(p) - contact_of(p);
    CHECK(norm(fibre) == doctest::Approx(free).epsilon(1e-9));
    Vec3 normal = contact_of(p);
    normal.x = p.contact_x_mm > 0 ? beyond : -beyond;
    CHECK(std::fabs(dot(fibre, normal)) / (free * radius) < 1e-9);
    if (i + 1 == w->points.size()) continue;
    // and points where the fibre continues: along the chord to the next contact, within the bend of one block
    const Vec3 chord = contact_of(w->points[i + 1]) - contact_of(p);
    CHECK(dot(chord, fibre) / (norm(chord) * free) > 0.998);
  }
  CHECK(least_radius == doctest::Approx(polar).epsilon(1e-6));
}

TEST_CASE("G93 feeds lay fibre at the speed asked for") {
  for (const WindKind& shape : wind_kinds()) {
    const std::string_view kind = shape.name;
    CAPTURE(kind);
    const auto w = wind(kind, {{"fibre_mm_s", 120}});
    REQUIRE(w);
    const auto lines = lines_of(render_winding(*w, wind_command(kind, {{"fibre_mm_s", 120}})));
    REQUIRE(lines.size() == w->points.size() + 6);
    for (std::size_t i = 1; i < w->points.size(); ++i) {
      const std::string& line = lines[i + 4];
      // F is 1/minutes: 60/F seconds for the block's fibre
      CHECK(w->points[i].fibre_mm / (60 / word(line, 'F')) == doctest::Approx(120.0).epsilon(1e-6));
      // four decimals
      CHECK(std::fabs(word(line, 'A') - w->points[i].a_deg) < 0.5001e-4);
      CHECK(std::fabs(word(line, 'X') - w->points[i].x_mm) < 0.5001e-4);
    }
  }
}

TEST_CASE("a winding program names its command, and the command's parameters make it again") {
  const WindSettings settings = {{"layers", 1}, {"length_mm", 60}};
  const std::string command = wind_command("hoop", settings);
  CHECK(command ==
        "kadr wind hoop --radius-mm 50 --length-mm 60 --band-mm 6 --layers 1 --gap-mm 20 --step-deg 5 "
        "--fibre-mm-s 200");
  const std::string once = render_winding(*wind("hoop", settings), command);
  CHECK(once == render_winding(*wind("hoop", settings), command));
  CHECK(lines_of(once)[0] == "(" + command + ")");
  CHECK(once.find("-0.0000") == std::string::npos);
  CHECK(once.ends_with("\nG94\nM2\n"));
}

TEST_CASE("a winding parameter out of range is refused with its range") {
  CHECK(wind("knot", {}).error() == "there is no winding 'knot': hoop, helix or dome");
  CHECK(wind("hoop", {{"radius", 50}}).error() == "a hoop winding has no parameter 'radius'");
  CHECK(wind("helix", {{"angle_deg", 89.5}}).error() == "angle_deg is 89.5, allowed 10 to 85");
  CHECK(wind("hoop", {{"layers", 1.5}}).error() == "layers is 1.5, a whole number is needed");
  CHECK(wind("dome", {{"polar_mm", 60}}).error() == "polar_mm is 60, allowed up to 0.95 radius_mm = 57");
  CHECK(wind("hoop", {{"radius_mm", std::nan("")}}).error() == "radius_mm is nan, allowed 5 to 2000");
  CHECK(wind("hoop", {{"length_mm", 10000}, {"band_mm", 0.5}, {"step_deg", 0.1}, {"layers", 10}})
            .error()
            .find("blocks, allowed 5000000") != std::string::npos);
}
