#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

/// Filament-winding programs like those of a winding machine's CAM, as a stress test for planner and axes.
///
/// Axes: X carriage along the mandrel (mm), Y eye, its distance from the mandrel's axis (mm), A mandrel (deg,
/// counts on without wrap), B eye (deg, 0 = the band lies in the plane of rotation). Feed is inverse time
/// (G93), so that fibre is laid at a constant speed. The same parameters give the same bytes on every machine
/// (only + - * / sqrt and machine/base/numbers.h).
namespace kadr::scenarios {

/// One parameter of a winding: key as in a scenario file.
struct WindParameter {
  std::string_view key;
  double preset = 0;
  double least = 0;
  double most = 0;
  bool whole = false;  ///< a count
  std::string_view meaning;
};

/// A winding by name.
struct WindKind {
  std::string_view name;
  std::string_view meaning;
  std::span<const WindParameter> parameters;  ///< in the order in which they are written
};

/// Hoop, helix and dome: the table from which scenario files and the command line read.
std::span<const WindKind> wind_kinds();
/// Parameters of a kind; empty for an unknown one.
std::span<const WindParameter> wind_parameters(std::string_view kind);
/// A parameter on the command line: "--radius-mm" for "radius_mm".
std::string wind_flag(std::string_view key);

/// A point of the winding: where the fibre touches the mandrel, and where the eye is.
struct WindPoint {
  double contact_x_mm = 0;                          ///< along the axis
  double contact_radius_mm = 0;                     ///< distance from the axis
  double contact_deg = 0;                           ///< angle on the mandrel, without wrap
  double fibre_angle_deg = 0;                       ///< alpha, from the meridian
  double x_mm = 0, y_mm = 0, a_deg = 0, b_deg = 0;  ///< machine axes
  double fibre_mm = 0;                              ///< laid since the previous point
};

struct Winding {
  std::string title;              ///< kind and what was derived: circuits, dwell ...
  std::vector<WindPoint> points;  ///< the first is the start
  double fibre_mm_s = 0;          ///< speed at which fibre is laid
  int circuits = 0;
  double circuit_deg = 0;  ///< turn of the mandrel per circuit (per layer of a hoop winding)
};

using WindSettings = std::vector<std::pair<std::string, double>>;

/// The winding of a kind.
/// @param settings key and value of the parameters that differ from the preset
/// @return the points, or one sentence that names the parameter, its value and its range
tl::expected<Winding, std::string> wind(std::string_view kind, const WindSettings& settings);

/// The control program of a winding.
/// @param command how it was made; printed in line 1
std::string render_winding(const Winding& winding, std::string_view command);

/// "kadr wind hoop --radius-mm 50 ...": the command that makes this program, every parameter named.
std::string wind_command(std::string_view kind, const WindSettings& settings);

}  // namespace kadr::scenarios
