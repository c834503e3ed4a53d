#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator/log_tools/diff/diff_fields.h"
#include "machine/base/vocabulary.h"

namespace kadr::log_tools {

/// The compared items: control ticks of the same number, or positions of the same path length.
enum class DiffAlign : std::uint8_t { tick, path };
inline constexpr Vocabulary<DiffAlign, 2> kDiffAligns{{
    {DiffAlign::tick, "tick", "same control tick"},
    {DiffAlign::path, "path", "same path length, whatever the override"},
}};
static_assert(kDiffAligns.complete());

/// Allowed differences, [ToleranceKey]; not given: to the last bit.
struct Tolerances {
  std::array<std::optional<double>, log::kToleranceKeys> linear;  ///< mm, mm/s, N
  std::array<std::optional<double>, log::kToleranceKeys> rotary;  ///< deg, deg/s, N m
  std::optional<double> of(log::ToleranceKey key, bool rotary_axis) const {
    if (key == log::ToleranceKey::none) return std::nullopt;
    return (rotary_axis ? rotary : linear)[static_cast<std::size_t>(key)];
  }
};

struct DiffOptions {
  DiffAlign align = DiffAlign::tick;
  int context = 2;   ///< control ticks shown before and after the first difference, 0..kMostContext
  bool all = false;  ///< every difference is handed on, not only the first
  Tolerances tolerance;
  /// "CHANNEL/field", as set by add_ignored()
  std::set<std::string, std::less<>> ignored;

  bool ignores(DiffChannel channel, std::string_view field) const;
};
inline constexpr int kMostContext = 1000;

/// Sets one tolerance from KEY=VALUE with a unit: "base=2um", "link_rate=0.1mm/s", "force=1N". `load` is base
/// and link together. Lengths and N are for linear axes, angles and Nm for rotary ones.
/// @return the error in the text
tl::expected<void, std::string> add_tolerance(Tolerances& tolerances, std::string_view text);

/// Leaves out a channel ("KADR_EVENT"), a field of one ("KADR_EVENT/text"), or a group: load (all plant
/// states), base, link, base_rate, link_rate, force, feed.
/// @return the error in the text
tl::expected<void, std::string> add_ignored(DiffOptions& options, std::string_view text);

}  // namespace kadr::log_tools
