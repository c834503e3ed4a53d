#include "machine/file/key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "machine/base/parse_number.h"
#include "machine/motor.h"

namespace kadr::machine {

namespace {

/// A unit in a key's name that depends on the kind of axis.
struct UnitPlace {
  std::string_view place, linear, rotary;
};
constexpr UnitPlace kPlaces[] = {
    {"{u}", "mm", "deg"},
    {"{mass}", "kg", "kg_m2"},
    {"{stiffness}", "N_per_m", "Nm_per_rad"},
    {"{damping}", "Ns_per_m", "Nms_per_rad"},
    {"{force}", "N", "Nm"},
};

}  // namespace

std::string spelled(std::string_view name, AxisKind kind) {
  std::string text(name);
  for (const UnitPlace& unit : kPlaces)
    if (const auto at = text.find(unit.place); at != std::string::npos)
      text.replace(at, unit.place.size(), kind == AxisKind::rotary ? unit.rotary : unit.linear);
  return text;
}

std::string documented_name(std::string_view name) {
  const std::string linear = spelled(name, AxisKind::linear), rotary = spelled(name, AxisKind::rotary);
  return linear == rotary ? linear : fmt::format("{}, {}", linear, rotary);
}

std::string documented_bounds(const Bounds& bounds, std::string_view name) {
  return bounds_text(bounds, name.find('{') == std::string_view::npos ? name : "");
}

std::string need_text(Need need) {
  switch (need) {
    case Need::never:
      break;
    case Need::always:
      return "required";
    case Need::link:
      return "required with a link";
    case Need::motor:
      return "required by the motor";
  }
  return "";
}

std::string need_text(const Key<TwoMassModel, double>& key) {
  if (key.need != Need::motor) return need_text(key.need);
  std::vector<std::string> motors;
  for (const auto& motor : kMotorModels)
    if (motor_needs(motor.value, key.member)) motors.push_back(fmt::format("\"{}\"", motor.word));
  const std::string last = motors.back();
  motors.pop_back();
  if (motors.empty()) return fmt::format("required by {}", last);
  return fmt::format("required by {} and {}", fmt::join(motors, ", "), last);
}

std::string default_text(double value, bool whole) {
  return whole ? fmt::format("{:.0f}", value) : number_text(value);
}

}  // namespace kadr::machine
