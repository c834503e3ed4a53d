#pragma once
#include <concepts>
#include <type_traits>
#include <utility>
#include <vector>

#include "emulator/log/field.h"
#include "machine/base/codes.h"
#include "machine/base/count.h"
#include "machine/base/diagnostic.h"

/// Makes a Field from the path of members that leads to its value:
///   field::real<&R::length_u>("length_u", FieldUnit::path, "length of its path")
///   field::i32<&R::span, &Span::line>("source_line", "from 1")
///   field::real<&R::axis, &AxisTicks::base_u>("base_u", FieldUnit::axis, "x0").by("n_axes", "n")
/// A vector on the path is an array of the message.
namespace kadr::log::field {

// ---- numbers and texts of the wire, and the types that hold them

template <std::integral T>
std::int64_t as_integer(T v) {
  return static_cast<std::int64_t>(v);
}
template <class Tag>
std::int64_t as_integer(Count<Tag> v) {
  return v.value;
}
/// 1 note, 2 warning, 3 error
inline std::int64_t as_integer(Severity v) { return static_cast<std::int64_t>(v) + 1; }

template <std::integral T>
bool take_integer(std::int64_t v, T& out) {
  out = static_cast<T>(v);
  return true;
}
template <class Tag>
bool take_integer(std::int64_t v, Count<Tag>& out) {
  out = {v};
  return true;
}
bool take_integer(std::int64_t v, Severity& out);

inline const std::string& as_text(const std::string& v) { return v; }
template <const auto& kWords>
std::string as_text(const StoredWord<kWords>& v) {
  return v.text();
}
inline std::string as_text(Code v) { return v == Code{} ? std::string() : code_name(v); }

inline void take_text(std::string v, std::string& out) { out = std::move(v); }
template <const auto& kWords>
void take_text(std::string v, StoredWord<kWords>& out) {
  out = StoredWord<kWords>::read(std::move(v));
}
inline void take_text(const std::string& v, Code& out) { out = parse_code(v).value_or(Code{}); }

template <Wire kWire, class T>
void put_value(WireWriter& out, const T& v) {
  if constexpr (kWire == Wire::real)
    out.f64(v);
  else if constexpr (kWire == Wire::string)
    out.text(as_text(v));
  else if constexpr (wire_bytes(kWire) == 1)
    out.i8(static_cast<std::int8_t>(as_integer(v)));
  else if constexpr (kWire == Wire::int32)
    out.i32(static_cast<std::int32_t>(as_integer(v)));
  else
    out.i64(as_integer(v));
}

template <Wire kWire, class T>
void get_value(WireReader& in, T& v) {
  if constexpr (kWire == Wire::real) {
    v = in.f64();
  } else if constexpr (kWire == Wire::string) {
    take_text(in.string(), v);
  } else {
    const std::int64_t number = kWire == Wire::boolean   ? in.boolean()
                                : wire_bytes(kWire) == 1 ? in.i8()
                                : wire_bytes(kWire) == 4 ? in.i32()
                                                         : in.i64();
    if (!take_integer(number, v)) in.fail();
  }
}

template <Wire kWire, class T>
FieldValue value_of(const T& v) {
  if constexpr (kWire == Wire::real)
    return v;
  else if constexpr (kWire == Wire::string)
    return as_text(v);
  else
    return as_integer(v);
}

// ---- paths of members

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

template <class Member>
struct OwnerOf;
template <class R, class M>
struct OwnerOf<M R::*> {
  using Type = R;
};
template <auto... kPath>
struct OwnerOfPath;
template <auto kFirst, auto... kRest>
struct OwnerOfPath<kFirst, kRest...> : OwnerOf<decltype(kFirst)> {};
/// The record that a path begins at.
template <auto... kPath>
using Owner = typename OwnerOfPath<kPath...>::Type;

/// How many vectors a path leads through.
template <auto kFirst, auto... kRest>
constexpr std::size_t arrays_of() {
  using Member = std::remove_cvref_t<decltype(std::declval<Owner<kFirst>&>().*kFirst)>;
  constexpr std::size_t kHere = kIsVector<Member> ? 1 : 0;
  if constexpr (sizeof...(kRest) > 0)
    return kHere + arrays_of<kRest...>();
  else
    return kHere;
}

/// Calls f(value) for each value at the path's end, in the order of the wire.
template <auto kFirst, auto... kRest, class Object, class F>
void each_value(Object& object, F&& f) {
  auto& member = object.*kFirst;
  const auto go_on = [&](auto& next) {
    if constexpr (sizeof...(kRest) > 0)
      each_value<kRest...>(next, f);
    else
      f(next);
  };
  if constexpr (kIsVector<std::remove_cvref_t<decltype(member)>>)
    for (auto& element : member) go_on(element);
  else
    go_on(member);
}

/// Calls f(vector) for each vector of values at the path's end.
template <auto kFirst, auto... kRest, class Object, class F>
void each_array(Object& object, F&& f) {
  auto& member = object.*kFirst;
  constexpr bool kVector = kIsVector<std::remove_cvref_t<decltype(member)>>;
  if constexpr (sizeof...(kRest) == 0) {
    if constexpr (kVector) f(member);
  } else if constexpr (kVector) {
    for (auto& element : member) each_array<kRest...>(element, f);
  } else {
    each_array<kRest...>(member, f);
  }
}

/// The value at [row] or [row][column] of the path's end.
template <auto kFirst, auto... kRest, class Object>
const auto& value_at(const Object& object, std::size_t row, std::size_t column) {
  const auto& member = object.*kFirst;
  if constexpr (kIsVector<std::remove_cvref_t<decltype(member)>>) {
    if constexpr (sizeof...(kRest) > 0)
      return value_at<kRest...>(member[row], column, 0);
    else
      return member[row];
  } else if constexpr (sizeof...(kRest) > 0) {
    return value_at<kRest...>(member, row, column);
  } else {
    return member;
  }
}

/// Gives the arrays on the path their lengths. Columns of one vector of records have one length.
/// @return false if they have not
template <auto kFirst, auto... kRest, class Object>
bool size_arrays(Object& object, const std::int32_t* extent) {
  auto& member = object.*kFirst;
  if constexpr (kIsVector<std::remove_cvref_t<decltype(member)>>) {
    const auto n = static_cast<std::size_t>(*extent);
    if constexpr (sizeof...(kRest) == 0) {
      member.resize(n);
    } else {
      if (!member.empty() && member.size() != n) return false;
      member.resize(n);
      for (auto& element : member)
        if (!size_arrays<kRest...>(element, extent + 1)) return false;
    }
    return true;
  } else if constexpr (sizeof...(kRest) > 0) {
    return size_arrays<kRest...>(member, extent);
  } else {
    return true;
  }
}

/// Sizes the arrays for what the message's counts announce, if its bytes can hold it.
/// @return false: there is nothing to read
template <auto... kPath, class R>
bool make_room(const Reading& reading, R& record, std::size_t bytes_each) {
  if (!reading.in.ok()) return false;
  if (reading.field.dimensions() == 0) return true;
  const auto extent = reading.extents();
  if (extent[0] < 0 || extent[1] < 0) return reading.in.fail(), false;
  const std::uint64_t total = static_cast<std::uint64_t>(extent[0]) * static_cast<std::uint64_t>(extent[1]);
  if (total == 0) return false;
  if (!reading.in.fits(total, bytes_each) || !size_arrays<kPath...>(record, extent.data()))
    return reading.in.fail(), false;
  return true;
}

template <Wire kWire, auto... kPath>
constexpr auto make(std::string_view name, FieldUnit unit, std::string_view sentence) {
  using R = Owner<kPath...>;
  Field<R> f;
  f.name = name;
  f.wire = kWire;
  f.unit = unit;
  f.sentence = sentence;
  f.arrays = arrays_of<kPath...>();
  f.put = [](WireWriter& out, const R& r, const LogHeader&) {
    each_value<kPath...>(r, [&](const auto& v) { put_value<kWire>(out, v); });
  };
  f.get = [](const Reading& reading, R& r) {
    if (!make_room<kPath...>(reading, r, wire_bytes(kWire))) return;
    each_value<kPath...>(r, [&](auto& v) { get_value<kWire>(reading.in, v); });
  };
  f.absent = [](const Reading& reading, R& r) { make_room<kPath...>(reading, r, 0); };
  f.clear = [](R& r) { each_array<kPath...>(r, [](auto& values) { values.clear(); }); };
  f.value = [](const R& r, std::size_t row, std::size_t column) {
    return value_of<kWire>(value_at<kPath...>(r, row, column));
  };
  return f;
}

template <auto... kPath>
constexpr auto real(std::string_view name, FieldUnit unit, std::string_view sentence) {
  return make<Wire::real, kPath...>(name, unit, sentence);
}
template <auto... kPath>
constexpr auto i8(std::string_view name, std::string_view sentence) {
  return make<Wire::int8, kPath...>(name, FieldUnit::none, sentence);
}
template <auto... kPath>
constexpr auto i32(std::string_view name, std::string_view sentence) {
  return make<Wire::int32, kPath...>(name, FieldUnit::none, sentence);
}
template <auto... kPath>
constexpr auto i64(std::string_view name, std::string_view sentence) {
  return make<Wire::int64, kPath...>(name, FieldUnit::none, sentence);
}
template <auto... kPath>
constexpr auto text(std::string_view name, std::string_view sentence) {
  return make<Wire::string, kPath...>(name, FieldUnit::none, sentence);
}
template <auto... kPath>
constexpr auto flag(std::string_view name, std::string_view sentence) {
  return make<Wire::boolean, kPath...>(name, FieldUnit::none, sentence);
}
template <auto... kPath>
constexpr auto byte(std::string_view name, std::string_view sentence) {
  return make<Wire::byte, kPath...>(name, FieldUnit::none, sentence);
}

/// Seconds from program start to a log's tick.
double seconds_at(Ticks tick, const LogHeader& header);

/// `t_s`, for viewers: it follows from the tick.
template <auto kTick, auto... kRest>
constexpr auto seconds_of(std::string_view name) {
  using R = Owner<kTick>;
  Field<R> f;
  f.name = name;
  f.wire = Wire::real;
  f.unit = FieldUnit::time;
  f.sentence = "`tick` in seconds";
  f.compared = false;
  f.put = [](WireWriter& out, const R& r, const LogHeader& header) {
    out.f64(seconds_at(value_at<kTick, kRest...>(r, 0, 0), header));
  };
  f.get = [](const Reading& reading, R&) { reading.in.f64(); };
  return f;
}

/// A count that arrays after it are as long as.
/// @tparam kCount  how many the record has
template <class R, std::size_t (*kCount)(const R&)>
constexpr auto count(std::string_view name, CountRule rule, std::string_view sentence = {}) {
  Field<R> f;
  f.name = name;
  f.sentence = sentence;
  f.count = rule;
  f.compared = false;
  f.put = [](WireWriter& out, const R& r, const LogHeader&) {
    out.i32(static_cast<std::int32_t>(kCount(r)));
  };
  f.get = [](const Reading& reading, R&) {
    const std::int32_t n = reading.in.i32();
    if (reading.in.ok() && !allows(reading.field.count, n, reading.counts, reading.header)) reading.in.fail();
    reading.counts.set(reading.field.name, reading.in.ok() ? n : 0);
  };
  return f;
}

/// Length of the vector at a path's end; a template argument of count().
template <auto kFirst, auto... kRest>
std::size_t length(const Owner<kFirst>& record) {
  if constexpr (sizeof...(kRest) > 0)
    return length<kRest...>(record.*kFirst);
  else
    return (record.*kFirst).size();
}

}  // namespace kadr::log::field
