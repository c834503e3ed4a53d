#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator/log/field_access.h"

/// A channel of the log: its name, the LCM type of its messages and the table of their fields. Written and
/// read by that table alone.
namespace kadr::log {

inline constexpr std::size_t kMaxChannelBytes = 63;  ///< LCM's limit for a channel name

struct ChannelTitle {
  std::string_view name;
  std::string_view type;      ///< struct of kadr.lcm
  std::string_view sentence;  ///< when it is written and what it is for
  bool each_axis = false;     ///< one channel for each axis: its letter ends the name
};

/// The channel of a record R; specialised in emulator/log/channels/, with
///   static constexpr ChannelTitle info
///   static constexpr std::array fields     Field<R> ..., in the order of the wire; new ones are appended
///   static constexpr std::size_t first_fields   how many there were in the first log of this format
/// Beside it may stand
///   const char* check_message(R&, std::string_view channel, const LogHeader&)   what is wrong with a message
///       whose fields fit; nullptr: nothing
///   void append_tick(R& block, const TickSource&)   of a channel of exact data (TickChannels)
template <class R>
struct Channel;

/// LCM's fingerprint of a struct of scalars and arrays, as lcm-gen computes it (lcmgen.c, lcm_struct_hash):
/// of each member its name, type and extents. It identifies the fields of a message.
/// @param count  of the first fields
template <class R>
constexpr std::int64_t fingerprint(std::size_t count = Channel<R>::fields.size()) {
  std::uint64_t v = 0x12345678;
  const auto add = [&](std::uint8_t c) {
    // lcm-gen shifts a signed number: the top bit is copied
    const auto top = static_cast<std::uint64_t>(static_cast<std::int64_t>(v) >> 55);
    v = ((v << 8) ^ top) + c;
  };
  const auto add_text = [&](std::string_view text) {
    add(static_cast<std::uint8_t>(text.size()));
    for (const char c : text) add(static_cast<std::uint8_t>(c));
  };
  constexpr std::uint8_t kVariableExtent = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const FieldInfo& field = Channel<R>::fields[i];
    add_text(field.name);
    add_text(kWires.word(field.wire));
    add(static_cast<std::uint8_t>(field.dimensions()));
    for (std::size_t d = 0; d < field.dimensions(); ++d) {
      add(kVariableExtent);
      add_text(field.extent[d]);
    }
  }
  return static_cast<std::int64_t>((v << 1) + (v >> 63));
}

/// Whether an array never is empty: of an appended field that a reader can tell by its bytes.
constexpr bool is_never_empty(CountRule rule) {
  return rule == CountRule::log_axes || rule == CountRule::block_ticks;
}

/// What the table of a channel must fulfil; for a static_assert.
template <class R>
constexpr bool well_formed() {
  using C = Channel<R>;
  if (C::info.name.size() + (C::info.each_axis ? 1 : 0) > kMaxChannelBytes) return false;
  if (C::first_fields == 0 || C::first_fields > C::fields.size()) return false;
  for (std::size_t i = 0; i < C::fields.size(); ++i) {
    const FieldInfo& field = C::fields[i];
    if (field.dimensions() != field.arrays) return false;
    bool has_bytes = field.dimensions() == 0;
    for (std::size_t d = 0; d < field.dimensions(); ++d) {
      bool counted = false;
      for (std::size_t j = 0; j < i; ++j) {
        const FieldInfo& count = C::fields[j];
        if (count.name != field.extent[d]) continue;
        counted = count.count != CountRule::not_a_count;
        has_bytes = has_bytes || is_never_empty(count.count) || (j >= C::first_fields && j + 1 == i);
      }
      if (!counted) return false;
    }
    // an appended field has bytes in every message: a reader that does not know it sees that something follows
    if (i >= C::first_fields && !has_bytes) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (C::fields[j].name == field.name) return false;
  }
  return true;
}

/// Fingerprints of the first `first_fields`, the first `first_fields` + 1 ... all fields.
template <class R>
inline constexpr auto kFingerprints = [] {
  constexpr std::size_t kFirst = Channel<R>::first_fields;
  std::array<std::int64_t, Channel<R>::fields.size() - kFirst + 1> prints{};
  for (std::size_t i = 0; i < prints.size(); ++i) prints[i] = fingerprint<R>(kFirst + i);
  return prints;
}();

/// A message as it goes into the log: fingerprint, then the fields. The storage of `bytes` is reused.
template <class R>
void encode(const R& record, const LogHeader& header, std::vector<std::uint8_t>& bytes) {
  static_assert(well_formed<R>());
  WireWriter out(bytes);
  out.i64(kFingerprints<R>.back());
  for (const Field<R>& field : Channel<R>::fields) field.put(out, record, header);
}

/// A message that was read.
template <class R>
struct Decoded {
  R record{};
  bool newer = false;  ///< fields follow that this version does not know; they were passed over
};

/// Number of fields of a message with that fingerprint; 0: none of ours. A message of an older kadr has the first ones.
template <class R>
std::size_t fields_of(std::int64_t print) {
  for (std::size_t i = 0; i < kFingerprints<R>.size(); ++i)
    if (print == kFingerprints<R>[i]) return Channel<R>::first_fields + i;
  return 0;
}

/// Reads a message. With a fingerprint of this or an older kadr it has exactly those fields; appended ones
/// that it lacks keep their defaults. With any other one it is of a newer kadr, which has appended fields: it
/// has all of ours, and more. Every length and count is checked before it is used.
/// @return the reason why the bytes are not such a message
template <class R>
tl::expected<Decoded<R>, std::string> decode(std::span<const std::uint8_t> data, std::string_view channel,
                                             const LogHeader& header) {
  static_assert(well_formed<R>());
  using C = Channel<R>;
  WireReader in(data);
  const std::size_t known = fields_of<R>(in.i64());
  Decoded<R> message;
  message.newer = known == 0;
  const std::size_t present = message.newer ? C::fields.size() : known;
  Counts counts;
  for (std::size_t i = 0; i < C::fields.size() && in.ok(); ++i) {
    const Field<R>& field = C::fields[i];
    const Reading reading{in, counts, header, field};
    if (i < present)
      field.get(reading, message.record);
    else if (field.absent != nullptr)
      field.absent(reading, message.record);
  }
  if (message.newer && (!in.ok() || in.at_end()))
    return tl::unexpected<std::string>("its fingerprint is not that of its type");
  if (!in.ok()) return tl::unexpected<std::string>("its fields do not fit its length");
  if (!message.newer && !in.at_end())
    return tl::unexpected<std::string>("bytes are left over after its fields");
  if constexpr (requires { check_message(message.record, channel, header); })
    if (const char* wrong = check_message(message.record, channel, header))
      return tl::unexpected<std::string>(wrong);
  return message;
}

}  // namespace kadr::log
