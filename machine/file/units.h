#pragma once
#include <optional>
#include <string>
#include <string_view>

/// Units as written at the end of a key: "max_mm_s" is the stem "max" in mm/s.
namespace kadr::machine {

/// A physical quantity; only units of the same quantity convert into each other.
enum class Quantity {
  length,
  angle,
  speed,
  angular_speed,
  acceleration,
  angular_acceleration,
  jerk,
  angular_jerk,
  per_length,
  per_angle,
  time,
  frequency,
  mass,
  inertia,
  stiffness,
  angular_stiffness,
  damping,
  angular_damping,
  force,
  torque,
  ratio,
};

struct Unit {
  std::string_view suffix;  ///< "mm_s2"
  Quantity quantity;
  double factor;  ///< value in the quantity's first unit = factor * value in this unit
};

struct KeyParts {
  std::string_view stem;  ///< the key without its unit; the whole key if there is none
  const Unit* unit;       ///< nullptr: the key has no known unit
};
/// Splits a key at the longest known unit suffix, upper and lower case alike.
KeyParts split_key(std::string_view key);

/// A unit by its suffix, upper and lower case alike; nullptr if there is none.
const Unit* find_unit(std::string_view suffix);

/// The value of one unit in another; nothing if they measure different quantities.
std::optional<double> convert(double value, const Unit& from, const Unit& to);

/// "mm_s2" -> "mm/s2", "N_per_m" -> "N/m"; a unit that people read.
std::string unit_text(const Unit& unit);

/// Number of edits (insert, delete, replace, swap neighbours; upper and lower case alike) between two keys.
int edit_distance(std::string_view a, std::string_view b);

}  // namespace kadr::machine
