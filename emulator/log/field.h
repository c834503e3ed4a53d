#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "emulator/log/wire.h"
#include "machine/base/vocabulary.h"

/// What one field of a log message is: its place on the wire, its unit, its meaning. A channel's table of
/// them (emulator/log/channels/) is the only description of its message: writer, reader, `kadr diff`,
/// signals, the size estimate, kadr.lcm and docs/log_format.md are made from it.
namespace kadr::log {

struct LogHeader;

/// Type of a field as LCM spells it.
enum class Wire : std::uint8_t { boolean, int8, int32, int64, real, string, byte };
inline constexpr Vocabulary<Wire, 7> kWires{{
    {Wire::boolean, "boolean", "one byte"},
    {Wire::int8, "int8_t"},
    {Wire::int32, "int32_t"},
    {Wire::int64, "int64_t"},
    {Wire::real, "double", "IEEE 754"},
    {Wire::string, "string", "length with its zero byte (int32), UTF-8 text, zero byte"},
    {Wire::byte, "byte"},
}};
static_assert(kWires.complete());

/// Bytes of one value; of a string the shortest: length and zero byte.
constexpr std::size_t wire_bytes(Wire wire) {
  switch (wire) {
    case Wire::boolean:
    case Wire::int8:
    case Wire::byte:
      return 1;
    case Wire::int32:
      return 4;
    case Wire::int64:
    case Wire::real:
      return 8;
    case Wire::string:
      return 5;
  }
  return 0;
}

/// Unit of a field. Along the path it is the path's ("mm"), of an axis the axis' ("mm" or "deg").
enum class FieldUnit : std::uint8_t {
  none,
  path,
  path_speed,
  path_accel,
  path_jerk,
  axis,
  axis_speed,
  axis_accel,
  axis_jerk,
  axis_thousandth,
  force,
  energy,
  time,
  percent,
};
/// "u/s", "J" ... for a table that fits every log; empty if there is none.
std::string_view unit_symbol(FieldUnit unit);

/// Plant states and feed may have a tolerance in `kadr diff`: --tolerance KEY=VALUE.
enum class ToleranceKey : std::uint8_t { base, link, base_rate, link_rate, force, feed, none };
inline constexpr std::size_t kToleranceKeys = 6;
inline constexpr Vocabulary<ToleranceKey, kToleranceKeys + 1> kToleranceWords{{
    {ToleranceKey::base, "base"},
    {ToleranceKey::link, "link"},
    {ToleranceKey::base_rate, "base_rate"},
    {ToleranceKey::link_rate, "link_rate"},
    {ToleranceKey::force, "force"},
    {ToleranceKey::feed, "feed"},
    {ToleranceKey::none, ""},
}};
static_assert(kToleranceWords.complete());

using FieldValue = std::variant<std::int64_t, double, std::string>;

/// Which counts a count field may hold; a reader takes a message with any other one for damaged.
enum class CountRule : std::uint8_t {
  not_a_count,
  log_axes,     ///< the header's axes
  plant_axes,   ///< n_axes or 0
  axes,         ///< 0 to 64: the header's own, and those of messages whose arrays are read axis by axis
  block_ticks,  ///< 1 to 64 control ticks
  all_ticks,    ///< n or 0
  any,          ///< what fits the message's length
};

/// Counts of the message under way, by the name of their field.
class Counts {
 public:
  static constexpr std::size_t kMost = 8;
  void set(std::string_view name, std::int32_t count) { entries_[size_++] = {name, count}; }
  /// 0 if the message has no such count.
  std::int32_t of(std::string_view name) const {
    for (std::size_t i = 0; i < size_; ++i)
      if (entries_[i].first == name) return entries_[i].second;
    return 0;
  }

 private:
  std::array<std::pair<std::string_view, std::int32_t>, kMost> entries_{};
  std::size_t size_ = 0;
};
bool allows(CountRule rule, std::int32_t count, const Counts& counts, const LogHeader& header);

/// The part of a field that does not depend on its record.
struct FieldInfo {
  std::string_view name;  ///< as in kadr.lcm
  Wire wire = Wire::int32;
  FieldUnit unit = FieldUnit::none;
  std::string_view sentence;
  std::array<std::string_view, 2> extent{};  ///< names of the counts of an array, outer one first
  std::size_t arrays = 0;                    ///< vectors on the way to its value: as many as extents
  CountRule count = CountRule::not_a_count;
  bool compared = true;                                     ///< by `kadr diff`
  ToleranceKey key = ToleranceKey::none;                    ///< of a plant state
  std::string_view (*word)(std::int64_t number) = nullptr;  ///< name of a coded number
  bool shown = true;  ///< exact data: a signal of exports and pages by its own name

  constexpr std::size_t dimensions() const { return extent[0].empty() ? 0 : extent[1].empty() ? 1 : 2; }
};

/// What a field's reader works with.
struct Reading {
  WireReader& in;
  Counts& counts;
  const LogHeader& header;
  const FieldInfo& field;

  std::array<std::int32_t, 2> extents() const {
    return {counts.of(field.extent[0]), field.dimensions() == 2 ? counts.of(field.extent[1]) : 1};
  }
};

/// A field of one kind of record.
template <class R>
struct Field : FieldInfo {
  using Record = R;

  void (*put)(WireWriter& out, const R& record, const LogHeader& header) = nullptr;
  void (*get)(const Reading& reading, R& record) = nullptr;
  /// Of a message of before the field was appended: an array gets its length, values stay as they are.
  void (*absent)(const Reading& reading, R& record) = nullptr;
  /// Empties an array of values, keeping its storage.
  void (*clear)(R& record) = nullptr;
  /// One value: [row] of an array, [row][column] of an array of arrays; null: it has no value of its own.
  FieldValue (*value)(const R& record, std::size_t row, std::size_t column) = nullptr;

  /// An array: `x[outer]`, `x[outer][inner]`.
  constexpr Field by(std::string_view outer, std::string_view inner = {}) const {
    Field f = *this;
    f.extent = {outer, inner};
    return f;
  }
  constexpr Field within(ToleranceKey of) const {
    Field f = *this;
    f.key = of;
    return f;
  }
  constexpr Field coded(std::string_view (*words)(std::int64_t)) const {
    Field f = *this;
    f.word = words;
    return f;
  }
  /// Exports and pages have what is made of it (signal_table.cpp).
  constexpr Field not_shown() const {
    Field f = *this;
    f.shown = false;
    return f;
  }
  /// It follows from other fields, or is not the same in two runs that are.
  constexpr Field not_compared() const {
    Field f = *this;
    f.compared = false;
    return f;
  }
};

}  // namespace kadr::log
