#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadr::log {

/// Reads the big-endian fields of an LCM message. Never beyond its bytes: after the first field that does not
/// fit, ok() is false, everything reads as zero and nothing is allocated.
class WireReader {
 public:
  explicit WireReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  bool at_end() const { return at_ == bytes_.size(); }
  std::size_t position() const { return at_; }  ///< bytes read

  std::int8_t i8() { return static_cast<std::int8_t>(unsigned_of<1>()); }
  std::int32_t i32() { return static_cast<std::int32_t>(unsigned_of<4>()); }
  std::int64_t i64() { return static_cast<std::int64_t>(unsigned_of<8>()); }
  double f64() { return std::bit_cast<double>(unsigned_of<8>()); }
  bool boolean() { return i8() != 0; }

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
  /// Whether `n` values of at least `width` bytes each can follow.
  bool fits(std::uint64_t n, std::size_t width) const {
    return ok_ && (width == 0 || n <= (bytes_.size() - at_) / width);
  }

 private:
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

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Appends big-endian fields to bytes whose storage is reused.
class WireWriter {
 public:
  explicit WireWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) { bytes_.clear(); }

  void i8(std::int8_t v) { unsigned_of<1>(static_cast<std::uint8_t>(v)); }
  void i32(std::int32_t v) { unsigned_of<4>(static_cast<std::uint32_t>(v)); }
  void i64(std::int64_t v) { unsigned_of<8>(static_cast<std::uint64_t>(v)); }
  void f64(double v) { unsigned_of<8>(std::bit_cast<std::uint64_t>(v)); }
  /// LCM's texts end at the first zero byte: those of a damaged text become U+FFFD.
  void text(std::string_view v) {
    constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
    const std::size_t at = bytes_.size();
    i32(0);
    for (const char c : v) {
      if (c == '\0')
        bytes_.insert(bytes_.end(), kReplacement.begin(), kReplacement.end());
      else
        bytes_.push_back(static_cast<std::uint8_t>(c));
    }
    bytes_.push_back(0);
    put<4>(at, bytes_.size() - at - 4);
  }

 private:
  template <unsigned width>
  void unsigned_of(std::uint64_t v) {
    bytes_.resize(bytes_.size() + width);
    put<width>(bytes_.size() - width, v);
  }
  template <unsigned width>
  void put(std::size_t at, std::uint64_t v) {
    for (unsigned i = 0; i < width; ++i)
      bytes_[at + i] = static_cast<std::uint8_t>(v >> (8 * (width - 1 - i)));
  }

  std::vector<std::uint8_t>& bytes_;
};

}  // namespace kadr::log
