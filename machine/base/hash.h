#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace kadr {

/// Streaming 64-bit hash (XXH3) over bytes; integers are fed little-endian, so it is the same on every machine.
class Hash64 {
 public:
  Hash64();
  Hash64(Hash64&&) noexcept;
  Hash64& operator=(Hash64&&) noexcept;
  ~Hash64();
  void bytes(const void* data, std::size_t size);
  void integer(std::int64_t value);
  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 16 hexadecimal digits, as every hash is printed.
std::string hash_text(std::uint64_t hash);

}  // namespace kadr
