#include "scenarios/generator/wind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "machine/base/parse_number.h"
#include "machine/base/require.h"
#include "scenarios/generator/shapes.h"

namespace kadr::scenarios {

namespace {

constexpr std::array kHoop = {
    WindParameter{"radius_mm", 50, 5, 2000, false, "Radius of the mandrel"},
    WindParameter{"length_mm", 300, 10, 10000, false, "Length that is covered"},
    WindParameter{"band_mm", 6, 0.5, 500, false, "Width of the fibre band"},
    WindParameter{"layers", 2, 1, 1000, true, "Layers, there and back in turn"},
    WindParameter{"gap_mm", 20, 1, 1000, false, "Eye above the mandrel's surface"},
    WindParameter{"step_deg", 5, 0.1, 45, false, "Mandrel angle of a block, at most"},
    WindParameter{"fibre_mm_s", 200, 1, 5000, false, "Speed at which fibre is laid"},
};

constexpr std::array kHelix = {
    WindParameter{"radius_mm", 50, 5, 2000, false, "Radius of the mandrel"},
    WindParameter{"length_mm", 300, 10, 10000, false, "Length that is covered"},
    WindParameter{"angle_deg", 45, 10, 85, false, "Fibre angle to the axis"},
    WindParameter{"band_mm", 8, 0.5, 500, false, "Width of the fibre band"},
    WindParameter{"turn_deg", 90, 30, 720, false, "Least mandrel angle of a turn at the end"},
    WindParameter{"gap_mm", 20, 1, 1000, false, "Eye above the mandrel's surface"},
    WindParameter{"step_mm", 2, 0.1, 100, false, "Carriage way of a block, at most"},
    WindParameter{"fibre_mm_s", 200, 1, 5000, false, "Speed at which fibre is laid"},
};

constexpr std::array kDome = {
    WindParameter{"radius_mm", 60, 5, 2000, false, "Radius of cylinder and domes"},
    WindParameter{"length_mm", 200, 10, 10000, false, "Length of the cylinder"},
    WindParameter{"polar_mm", 20, 1, 1900, false, "Radius of the polar opening, below radius_mm"},
    WindParameter{"band_mm", 8, 0.5, 500, false, "Width of the fibre band"},
    WindParameter{"free_mm", 60, 1, 1000, false, "Free fibre between mandrel and eye"},
    WindParameter{"blocks", 60, 8, 10000, true, "Blocks over the cylinder, and over each dome"},
    WindParameter{"fibre_mm_s", 150, 1, 5000, false, "Speed at which fibre is laid"},
};

constexpr std::array kKinds = {
    WindKind{"hoop", "Cylinder, one band a turn, layer upon layer", kHoop},
    WindKind{"helix", "Cylinder at a fibre angle, there and back until it is covered", kHelix},
    WindKind{"dome", "Cylinder with two hemispheres, along geodesics", kDome},
};

// more blocks than this are a mistake in the parameters
constexpr std::size_t kMostPoints = 5'000'000;

std::string value_text(double value) { return number_text(value); }

// fixed decimals without a negative zero
void append_fixed(std::string& out, double value, int decimals) {
  const std::size_t at = out.size();
  fmt::format_to(std::back_inserter(out), "{:.{}f}", value, decimals);
  if (out[at] == '-' && out.find_first_not_of("-0.", at) == std::string::npos) out.erase(at, 1);
}

void append_position(std::string& out, const WindPoint& p) {
  constexpr int kDecimals = 4;  // 0.1 um and 0.1 mdeg, finer than any step
  out += " X";
  append_fixed(out, p.x_mm, kDecimals);
  out += " Y";
  append_fixed(out, p.y_mm, kDecimals);
  out += " A";
  append_fixed(out, p.a_deg, kDecimals);
  out += " B";
  append_fixed(out, p.b_deg, kDecimals);
}

/// Approximate number of points of a winding, checked before any is made.
double expected_points(std::string_view kind, const WindValues& p) {
  const double around_mm = 6.3 * p["radius_mm"];
  if (kind == "hoop") return p["layers"] * (p["length_mm"] / p["band_mm"] + 1) * 360 / p["step_deg"];
  const double circuits = around_mm / p["band_mm"] + 1;
  if (kind == "helix") return circuits * 2 * (p["length_mm"] / p["step_mm"] + 32);
  return circuits * 6 * p["blocks"];
}

}  // namespace

std::span<const WindKind> wind_kinds() { return kKinds; }

std::span<const WindParameter> wind_parameters(std::string_view kind) {
  for (const WindKind& k : kKinds)
    if (k.name == kind) return k.parameters;
  return {};
}

std::string wind_flag(std::string_view key) {
  std::string flag = "--" + std::string(key);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

WindValues::WindValues(std::string_view kind, const WindSettings& settings)
    : parameters_(wind_parameters(kind)) {
  for (const WindParameter& p : parameters_) values_.push_back(p.preset);
  for (const auto& [key, value] : settings)
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (parameters_[i].key == key) values_[i] = value;
}

double WindValues::operator[](std::string_view key) const {
  const auto it = std::find_if(parameters_.begin(), parameters_.end(),
                               [key](const WindParameter& p) { return p.key == key; });
  require(it != parameters_.end(), "a winding asks only for its own parameters");
  return values_[static_cast<std::size_t>(it - parameters_.begin())];
}

tl::expected<Winding, std::string> wind(std::string_view kind, const WindSettings& settings) {
  const auto parameters = wind_parameters(kind);
  if (parameters.empty())
    return tl::unexpected(fmt::format("there is no winding '{}': hoop, helix or dome", kind));
  for (const auto& [key, value] : settings) {
    const auto it = std::find_if(parameters.begin(), parameters.end(),
                                 [&key = key](const WindParameter& p) { return p.key == key; });
    if (it == parameters.end())
      return tl::unexpected(fmt::format("a {} winding has no parameter '{}'", kind, key));
    if (!(value >= it->least && value <= it->most))
      return tl::unexpected(fmt::format("{} is {}, allowed {} to {}", key, value_text(value),
                                        value_text(it->least), value_text(it->most)));
    if (it->whole && value != std::floor(value))
      return tl::unexpected(fmt::format("{} is {}, a whole number is needed", key, value_text(value)));
  }
  const WindValues values(kind, settings);
  if (kind == "dome" && values["polar_mm"] > 0.95 * values["radius_mm"])
    return tl::unexpected(fmt::format("polar_mm is {}, allowed up to 0.95 radius_mm = {}",
                                      value_text(values["polar_mm"]),
                                      value_text(0.95 * values["radius_mm"])));
  if (const double points = expected_points(kind, values); points > kMostPoints)
    return tl::unexpected(
        fmt::format("the program would have about {:.0f} blocks, allowed {}", points, kMostPoints));
  return kind == "hoop"    ? hoop_winding(values)
         : kind == "helix" ? helix_winding(values)
                           : dome_winding(values);
}

std::string render_winding(const Winding& winding, std::string_view command) {
  require(winding.points.size() > 1, "a winding has points");
  double fibre_mm = 0;
  for (const WindPoint& p : winding.points) fibre_mm += p.fibre_mm;
  const double time_s = fibre_mm / winding.fibre_mm_s;

  std::string out;
  out.reserve(winding.points.size() * 56);
  fmt::format_to(std::back_inserter(out), "({})\n({}; fibre {:.1f} mm, nominal time {:.3f} s, {} blocks)\n",
                 command, winding.title, fibre_mm, time_s, winding.points.size() - 1);
  out += "G21 G90 G94 G17 G40 G49 G61 G80\nG0";
  append_position(out, winding.points.front());
  out += "\nG93\n";
  for (auto it = std::next(winding.points.begin()); it != winding.points.end(); ++it) {
    out += "G1";
    append_position(out, *it);
    out += " F";
    append_fixed(out, 60.0 * winding.fibre_mm_s / it->fibre_mm, 5);
    out += '\n';
  }
  out += "G94\nM2\n";
  return out;
}

std::string wind_command(std::string_view kind, const WindSettings& settings) {
  std::string out = fmt::format("kadr wind {}", kind);
  const WindValues values(kind, settings);
  for (const WindParameter& p : wind_parameters(kind))
    fmt::format_to(std::back_inserter(out), " {} {}", wind_flag(p.key), value_text(values[p.key]));
  return out;
}

}  // namespace kadr::scenarios
