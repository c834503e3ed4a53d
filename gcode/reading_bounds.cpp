#include "gcode/reading_bounds.h"

#include <limits>
#include <type_traits>

namespace kadr::gcode {

namespace {

/// A bound's name, what it bounds, how its default reads, and how it is set.
struct NamedBound {
  std::string_view name;
  std::string_view bounds;
  std::string (*normal)(const ReadingBounds& bounds);
  bool (*set)(ReadingBounds& bounds, std::uint64_t value);
};

/// "50 000 000"
std::string grouped(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ' ');
  return text;
}

std::string text_of(std::uint64_t value) { return grouped(value); }
std::string text_of(const std::optional<std::uint64_t>& value) {
  return value ? grouped(*value)
               : grouped(ReadingBounds::kBlocks) + ", and one for each line of the text (without O words 16)";
}

template <class T>
struct CountOf {
  using Type = T;
};
template <class T>
struct CountOf<std::optional<T>> {
  using Type = T;
};

template <auto kMember>
bool set_member(ReadingBounds& bounds, std::uint64_t value) {
  auto& bound = bounds.*kMember;
  using Value = typename CountOf<std::remove_reference_t<decltype(bound)>>::Type;
  if (value > std::numeric_limits<Value>::max()) return false;
  bound = static_cast<Value>(value);
  return true;
}

template <auto kMember>
constexpr NamedBound named(std::string_view name, std::string_view bounds) {
  return {name, bounds, [](const ReadingBounds& b) { return text_of(b.*kMember); }, set_member<kMember>};
}

constexpr NamedBound kBounds[] = {
    named<&ReadingBounds::blocks>("blocks", "moves, dwells and all other calls that a program makes"),
    named<&ReadingBounds::lines>("lines", "lines run, of a program with O words; 256 bytes count as a line"),
    named<&ReadingBounds::messages>("messages",
                                    "messages shown, of a program with O words; 256 bytes count as one"),
    named<&ReadingBounds::call_depth>("call_depth", "nested subroutine calls"),
    named<&ReadingBounds::loop_passes>("loop_passes", "passes of all loops together"),
    named<&ReadingBounds::nurbs_order>("nurbs_order",
                                       "L of G5.2: points that one point of the curve depends on"),
    named<&ReadingBounds::file_bytes>("file_bytes", "the program, and each file that it calls"),
    named<&ReadingBounds::line_bytes>("line_bytes", "a line"),
};

}  // namespace

std::vector<BoundEntry> bound_entries() {
  std::vector<BoundEntry> entries;
  for (const NamedBound& bound : kBounds)
    entries.push_back({std::string(bound.name), bound.normal({}), std::string(bound.bounds)});
  return entries;
}

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
