#include "gcode/reading_bounds.h"

#include <limits>

namespace kadr::gcode {

namespace {

/// A bound's name and how it is set.
struct NamedBound {
  std::string_view name;
  bool (*set)(ReadingBounds& bounds, std::uint64_t value);
};

template <auto kMember>
bool set_member(ReadingBounds& bounds, std::uint64_t value) {
  auto& bound = bounds.*kMember;
  using Value = std::remove_reference_t<decltype(bound)>;
  if (value > std::numeric_limits<Value>::max()) return false;
  bound = static_cast<Value>(value);
  return true;
}

constexpr NamedBound kBounds[] = {
    {"blocks", set_member<&ReadingBounds::blocks>},
    {"call_depth", set_member<&ReadingBounds::call_depth>},
    {"loop_passes", set_member<&ReadingBounds::loop_passes>},
    {"file_bytes", set_member<&ReadingBounds::file_bytes>},
    {"line_bytes", set_member<&ReadingBounds::line_bytes>},
};

}  // namespace

std::vector<std::string> bound_names() {
  std::vector<std::string> names;
  for (const NamedBound& bound : kBounds) names.emplace_back(bound.name);
  return names;
}

bool set_bound(ReadingBounds& bounds, std::string_view name, std::uint64_t value) {
  for (const NamedBound& bound : kBounds)
    if (bound.name == name) return bound.set(bounds, value);
  return false;
}

}  // namespace kadr::gcode
