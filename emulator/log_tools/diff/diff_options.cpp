#include "emulator/log_tools/diff/diff_options.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "machine/base/parse_number.h"

namespace kadr::log_tools {
namespace {

using Key = log::ToleranceKey;

/// Kind of quantity that a key takes.
enum class Quantity : std::uint8_t { position, rate, force };

Quantity quantity_of(Key key) {
  switch (key) {
    case Key::base:
    case Key::link:
      return Quantity::position;
    case Key::force:
      return Quantity::force;
    case Key::base_rate:
    case Key::link_rate:
    case Key::feed:
    case Key::none:
      break;
  }
  return Quantity::rate;
}

struct UnitEntry {
  std::string_view name;
  Quantity quantity;
  bool rotary;
  double factor;  // to mm, deg, mm/s, deg/s, N or N m
};
constexpr std::array kUnits = {
    UnitEntry{"nm", Quantity::position, false, 1e-6}, UnitEntry{"um", Quantity::position, false, 1e-3},
    UnitEntry{"mm", Quantity::position, false, 1},    UnitEntry{"mdeg", Quantity::position, true, 1e-3},
    UnitEntry{"deg", Quantity::position, true, 1},    UnitEntry{"um/s", Quantity::rate, false, 1e-3},
    UnitEntry{"mm/s", Quantity::rate, false, 1},      UnitEntry{"mm/min", Quantity::rate, false, 1.0 / 60},
    UnitEntry{"mdeg/s", Quantity::rate, true, 1e-3},  UnitEntry{"deg/s", Quantity::rate, true, 1},
    UnitEntry{"mN", Quantity::force, false, 1e-3},    UnitEntry{"N", Quantity::force, false, 1},
    UnitEntry{"mNm", Quantity::force, true, 1e-3},    UnitEntry{"Nm", Quantity::force, true, 1},
};

std::string units_of(Quantity quantity) {
  std::string names;
  for (const UnitEntry& unit : kUnits)
    if (unit.quantity == quantity) names += (names.empty() ? "" : ", ") + std::string(unit.name);
  return names;
}

/// The keys that a name means.
std::vector<Key> keys_of(std::string_view name) {
  if (name == "load") return {Key::base, Key::link};
  const auto key = log::kToleranceWords.find(name);
  return key && *key != Key::none ? std::vector{*key} : std::vector<Key>{};
}

tl::unexpected<std::string> fault(std::string text) { return tl::unexpected<std::string>(std::move(text)); }

struct KnownField {
  DiffChannel channel;
  std::string name;
  Key key;
};

template <class Record>
void add_fields(std::vector<KnownField>& list, std::span<const LogField<Record>> fields,
                DiffChannel channel) {
  for (const auto& f : fields) list.push_back({channel, f.name, f.key});
}

std::vector<KnownField> known_fields() {
  std::vector<KnownField> list;
  add_fields(list, event_fields(), DiffChannel::event);
  add_fields(list, block_fields(), DiffChannel::block);
  add_fields(list, diagnostic_fields(), DiffChannel::diagnostic);
  add_fields(list, tick_fields(), DiffChannel::command);
  for (const auto& f : axis_fields())
    list.push_back({f.key == Key::none ? DiffChannel::command : DiffChannel::load, f.name, f.key});
  for (const std::string_view name : step_fields())
    list.push_back({DiffChannel::steps, std::string(name), Key::none});
  add_fields(list, summary_fields(), DiffChannel::summary);
  add_fields(list, axis_summary_fields(), DiffChannel::summary);
  return list;
}

std::string ignored_name(DiffChannel channel, std::string_view field) {
  if (field.find('/') != std::string_view::npos) return std::string(field);
  return fmt::format("{}/{}", channel_name(channel), field);
}

/// True if a text without '/' names that field: by channel, or by group.
bool in_group(std::string_view text, const KnownField& field) {
  const auto slash = field.name.find('/');
  if (text == (slash == std::string::npos ? channel_name(field.channel)
                                          : std::string_view(field.name).substr(0, slash)))
    return true;
  if (text == "load") return field.channel == DiffChannel::load;
  if (text == "feed")
    return field.channel == DiffChannel::command && (field.name == "feed_u_s" || field.name == "accel_u_s2");
  return field.key != Key::none && text == log::kToleranceWords.word(field.key);
}

/// "feed_u_s, accel_u_s2, ..." of a channel.
std::string names_of(std::string_view channel) {
  std::string names;
  for (const KnownField& field : known_fields())
    if (channel_name(field.channel) == channel)
      names += (names.empty() ? "" : ", ") + std::string(field.name);
  return names;
}

}  // namespace

bool DiffOptions::ignores(DiffChannel channel, std::string_view field) const {
  return !ignored.empty() && ignored.find(ignored_name(channel, field)) != ignored.end();
}

tl::expected<void, std::string> add_tolerance(Tolerances& tolerances, std::string_view text) {
  const auto equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  const std::vector<Key> keys = keys_of(name);
  if (keys.empty() || equals == std::string_view::npos)
    return fault(fmt::format("takes KEY=VALUE with KEY one of load, {}; got '{}'",
                             log::kToleranceWords.up_to<Key::feed>().list(), text));
  std::string_view value = text.substr(equals + 1);
  const Quantity quantity = quantity_of(keys.front());
  const auto end = value.find_last_of("0123456789.");
  const auto number = end == std::string_view::npos ? std::nullopt : parse_number(value.substr(0, end + 1));
  if (!number || *number < 0)
    return fault(
        fmt::format("{} takes a number >= 0 with a unit ({}); got '{}'", name, units_of(quantity), value));
  std::string_view unit = value.substr(end + 1);
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  for (const UnitEntry& entry : kUnits) {
    if (entry.name != unit || entry.quantity != quantity) continue;
    auto& list = entry.rotary ? tolerances.rotary : tolerances.linear;
    for (const Key key : keys) list[static_cast<std::size_t>(key)] = *number * entry.factor;
    return {};
  }
  return fault(
      fmt::format("{} takes a number >= 0 with a unit ({}); got '{}'", name, units_of(quantity), value));
}

tl::expected<void, std::string> add_ignored(DiffOptions& options, std::string_view text) {
  const auto slash = text.find('/');
  const std::string_view channel = text.substr(0, slash);
  bool channel_known = false, found = false;
  for (const KnownField& field : known_fields()) {
    channel_known = channel_known || channel == channel_name(field.channel);
    const bool meant = slash == std::string_view::npos ? in_group(text, field)
                                                       : text == ignored_name(field.channel, field.name);
    if (!meant) continue;
    found = true;
    options.ignored.insert(ignored_name(field.channel, field.name));
  }
  if (found) return {};
  if (slash != std::string_view::npos && channel_known)
    return fault(fmt::format("there is no field '{}' in {}; it has {}", text.substr(slash + 1), channel,
                             names_of(channel)));
  return fault(
      fmt::format("takes CHANNEL or CHANNEL/field with CHANNEL one of KADR_EVENT, KADR_BLOCK, KADR_DIAG, "
                  "KADR_TICKS, KADR_STEPS, KADR_SUMMARY, or load, base, link, base_rate, link_rate, force, "
                  "feed; got '{}'",
                  text));
}

}  // namespace kadr::log_tools
