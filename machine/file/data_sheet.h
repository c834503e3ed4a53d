#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "machine/machine.h"

/// A machine file from the figures of a data sheet: travel, speed, acceleration, steps.
namespace kadr::machine {

inline constexpr std::size_t kMostMachineName = 100;  ///< bytes of a machine's name

/// The words of a data sheet as a person types them; empty: not given. A list has one value for all axes, or
/// one for each in the order of `axes`, with commas between them.
struct DataSheetWords {
  std::string axes;          ///< "XYZ", the default
  std::string travel;        ///< "800,800,80" (mm or deg), a range "-75..5", "inf" of a rotary axis
  std::string max_speed;     ///< "5000mm/min", with unit
  std::string acceleration;  ///< "200" (mm/s2 or deg/s2), "0.5m/s2", "0.02g"
  std::string jerk;          ///< "10000" (mm/s3 or deg/s3), "inf"
  std::string steps;         ///< "40" (per mm or deg), "8000/rev"
  std::string home;          ///< "0" (mm or deg)
  std::string tool_change;   ///< "8" (s), "8s"

  bool empty() const;
};

/// A number and the word it was read from.
struct SheetValue {
  double value = 0;
  std::string given;  ///< empty: a default
};

struct SheetAxis {
  char letter = 'X';
  AxisKind kind = AxisKind::linear;
  double min_u = 0, max_u = 0;
  std::string travel;      ///< as given
  bool zero_given = true;  ///< travel was given as a range, so that its zero is no default
  SheetValue home_u, max_u_s, acceleration_u_s2, jerk_u_s3, steps_per_u;
  double junction_u_s2 = 0;  ///< always a default: default_junction_u_s2()

  bool turns() const { return kind == AxisKind::rotary; }
  std::string_view unit() const { return kind == AxisKind::rotary ? "deg" : "mm"; }
};

struct DataSheet {
  std::vector<SheetAxis> axis;  ///< [axes], 1 to 9, in the order of `axes`
  SheetValue tool_change_s;
  std::string command;  ///< the options that make the same sheet again
};

/// Default junction acceleration: an axis passes a square corner as fast as grbl does
/// with its junction deviation of 0.01 mm ($11 = 0.010), which bounds the speed at an angle t of the path by
///   v^2 = a d s / (1 - s),   s = cos(t/2) = cos 45,   a = sqrt(2) * acceleration (two axes brake and start)
/// and kadr allows a jump of junction acceleration * control period. Two significant digits.
/// @param acceleration_u_s2  of the axis, > 0
/// @return mm/s2 or deg/s2 at kSheetPeriod_s
double default_junction_u_s2(double acceleration_u_s2);
inline constexpr double kSheetPeriod_s = 1e-3;  ///< control period of the written file
inline constexpr double kSheetClock_hz = 10e6;  ///< its base clock

/// @return the sheet, or a sentence that names the option, the value given and the values allowed
tl::expected<DataSheet, std::string> read_data_sheet(const DataSheetWords& words);

/// A commented machine file: each value with its unit and whether it was given or is a default.
/// @param name  letters, digits, _ and -; 1 to kMostMachineName
std::string render_data_sheet(const DataSheet& sheet, std::string_view name);

}  // namespace kadr::machine
