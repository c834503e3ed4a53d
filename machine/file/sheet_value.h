#pragma once
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "machine/file/data_sheet.h"
#include "machine/file/machine_keys.h"
#include "machine/file/units.h"

/// The numbers of a data sheet: in which units they may be given, and how one is read.
namespace kadr::machine {

/// One number of a data sheet: its quantity on a linear and on a rotary axis, and its option.
struct SheetItem {
  std::string_view option;
  std::string_view what;    ///< "a speed with its unit"
  Quantity linear, rotary;  ///< equal: the same for both kinds
  std::string_view linear_unit, rotary_unit;
  std::string_view examples_linear, examples_rotary;
  bool bare = true;  ///< a number without unit is taken in the first unit
  Bounds bounds;
};

inline constexpr SheetItem kSheetTravel{"--travel",
                                        "a length or a range",
                                        Quantity::length,
                                        Quantity::angle,
                                        "mm",
                                        "deg",
                                        "800, -75..5",
                                        "-120..120, inf",
                                        true,
                                        {-1e8, 1e8}};
inline constexpr SheetItem kSheetSpeed{"--max-speed",
                                       "a speed with its unit",
                                       Quantity::speed,
                                       Quantity::angular_speed,
                                       "mm/s",
                                       "deg/s",
                                       "5000mm/min, 83.3mm/s, 5m/min",
                                       "20rpm, 7200deg/min, 120deg/s",
                                       false,
                                       kFeedBounds};
inline constexpr SheetItem kSheetAcceleration{"--acceleration",
                                              "an acceleration",
                                              Quantity::acceleration,
                                              Quantity::angular_acceleration,
                                              "mm/s2",
                                              "deg/s2",
                                              "200, 0.2m/s2, 0.02g",
                                              "500, 10rad/s2",
                                              true,
                                              kAccelBounds};
inline constexpr SheetItem kSheetJerk{"--jerk", "a jerk",   Quantity::jerk,       Quantity::angular_jerk,
                                      "mm/s3",  "deg/s3",   "10000, 10m/s3, inf", "10000, inf",
                                      true,     kJerkBounds};
inline constexpr SheetItem kSheetSteps{"--steps-per-mm",    "a number of steps", Quantity::per_length,
                                       Quantity::per_angle, "steps/mm",          "steps/deg",
                                       "40, 1016/inch",     "100, 36000/rev",    true,
                                       kStepsPerBounds};
inline constexpr SheetItem kSheetHome{"--home", "a position",   Quantity::length, Quantity::angle,
                                      "mm",     "deg",          "0, -5",          "0",
                                      true,     kPositionBounds};
inline constexpr double kMostToolChange_s = 1e6;
inline constexpr SheetItem kSheetToolChange{
    "--tool-change", "a time", Quantity::time, Quantity::time,        "s", "s",
    "8, 0.5min",     "",       true,           {0, kMostToolChange_s}};

/// A value, or a sentence that names option, value given and values allowed.
template <class T>
using SheetResult = tl::expected<T, std::string>;

std::string_view trimmed_blanks(std::string_view text);

/// The value in the item's first unit, whatever unit it was given in; not yet bounded.
/// @param axis  nullptr: of the machine
SheetResult<double> sheet_number(const SheetItem& item, const SheetAxis* axis, std::string_view text);
/// The same, within its bounds, with the word it was read from.
SheetResult<SheetValue> sheet_value(const SheetItem& item, const SheetAxis* axis, std::string_view text);

std::string sheet_refusal(const SheetItem& item, const SheetAxis* axis, std::string_view given,
                          std::string_view why = {});
/// A sentence where a value is beyond the item's bounds, else empty.
std::string out_of_bounds(const SheetItem& item, const SheetAxis* axis, std::string_view given, double value);

}  // namespace kadr::machine
