#include "machine/file/key.h"

#include <fmt/format.h>

#include "machine/base/parse_number.h"

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

std::string need_text(Need need) {
  switch (need) {
    case Need::never:
      break;
    case Need::always:
      return "required";
    case Need::link:
      return "required with a link";
    case Need::spring:
      return "required by \"spring\"";
    case Need::motor:
      return "required by \"spring\" and \"stepper\"";
    case Need::stepper:
      return "required by \"stepper\"";
  }
  return "";
}

std::string default_text(double value, bool whole) {
  return whole ? fmt::format("{:.0f}", value) : number_text(value);
}

}  // namespace kadr::machine
