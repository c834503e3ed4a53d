#pragma once
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace kadr::test {

/// Seed of a property test: KADR_SEED where it is set (tools/nightly takes a new one each time), else `usual`.
inline std::uint64_t property_seed(std::uint64_t usual) {
  if (const char* text = std::getenv("KADR_SEED")) std::from_chars(text, text + std::strlen(text), usual);
  return usual;
}

}  // namespace kadr::test
