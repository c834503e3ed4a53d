#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kadr::emulator {

/// Reads the big-endian fields of an LCM message. Never beyond its bytes: after the first field that does not
/// fit, ok() is false, everything reads as zero and nothing is allocated.
class WireReader {
 public:
  explicit WireReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  bool at_end() const { return at_ == bytes_.size(); }

  std::int8_t i8() { return static_cast<std::int8_t>(unsigned_of<1>()); }
  std::int32_t i32() { return static_cast<std::int32_t>(unsigned_of<4>()); }
  std::int64_t i64() { return static_cast<std::int64_t>(unsigned_of<8>()); }
  std::uint64_t u64() { return unsigned_of<8>(); }
  double f64() { return std::bit_cast<double>(unsigned_of<8>()); }
  bool boolean() { return i8() != 0; }

  /// A length or count in [low, high], else fail().
  std::int32_t count(std::int32_t low, std::int32_t high) {
    const std::int32_t n = i32();
    if (n < low || n > high) fail();
    return ok_ ? n : 0;
  }
  /// Length with its zero byte, text, zero byte.
  std::string string() {
    const std::int32_t n = i32();
    if (n < 1 || !fits(static_cast<std::size_t>(n), 1) ||
        bytes_[at_ + static_cast<std::size_t>(n) - 1] != 0) {
      fail();
      return {};
    }
    const auto* text = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += static_cast<std::size_t>(n);
    return {text, static_cast<std::size_t>(n) - 1};
  }
  std::span<const std::uint8_t> bytes(std::int32_t n) {
    if (n < 0 || !fits(static_cast<std::size_t>(n), 1)) {
      fail();
      return {};
    }
    const auto part = bytes_.subspan(at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return part;
  }

  std::vector<double> f64s(std::int32_t n) {
    return array<double, 8>(n, [this] { return f64(); });
  }
  std::vector<std::int64_t> i64s(std::int32_t n) {
    return array<std::int64_t, 8>(n, [this] { return i64(); });
  }
  std::vector<std::int32_t> i32s(std::int32_t n) {
    return array<std::int32_t, 4>(n, [this] { return i32(); });
  }
  std::vector<std::int8_t> i8s(std::int32_t n) {
    return array<std::int8_t, 1>(n, [this] { return i8(); });
  }
  std::vector<std::string> strings(std::int32_t n) {
    constexpr std::size_t kShortest = 5;  // an empty string's length and zero byte
    return array<std::string, kShortest>(n, [this] { return string(); });
  }

 private:
  bool fits(std::size_t n, std::size_t width) const { return ok_ && n <= (bytes_.size() - at_) / width; }

  template <unsigned width>
  std::uint64_t unsigned_of() {
    if (!fits(width, 1)) {
      fail();
      return 0;
    }
    std::uint64_t value = 0;
    for (unsigned i = 0; i < width; ++i) value = value << 8 | bytes_[at_ + i];
    at_ += width;
    return value;
  }

  template <class T, std::size_t width, class Read>
  std::vector<T> array(std::int32_t n, Read&& read) {
    std::vector<T> values;
    if (n < 0 || !fits(static_cast<std::size_t>(n), width)) {
      fail();
      return values;
    }
    values.reserve(static_cast<std::size_t>(n));
    for (std::int32_t i = 0; i < n; ++i) values.push_back(read());
    return values;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace kadr::emulator
