#include "machine/base/hash.h"

#include <fmt/format.h>

#include <new>

#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>

namespace kadr {

struct Hash64::State {
  XXH3_state_t* xxh = XXH3_createState();
  State() {
    if (!xxh) throw std::bad_alloc();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { XXH3_freeState(xxh); }
};

Hash64::Hash64() : state_(std::make_unique<State>()) { XXH3_64bits_reset(state_->xxh); }
Hash64::Hash64(Hash64&&) noexcept = default;
Hash64& Hash64::operator=(Hash64&&) noexcept = default;
Hash64::~Hash64() = default;

void Hash64::bytes(const void* data, std::size_t size) { XXH3_64bits_update(state_->xxh, data, size); }

void Hash64::integer(std::int64_t value) {
  unsigned char little_endian[8];
  for (int i = 0; i < 8; ++i)
    little_endian[i] = static_cast<unsigned char>(static_cast<std::uint64_t>(value) >> (8 * i));
  bytes(little_endian, sizeof little_endian);
}

std::uint64_t Hash64::digest() const { return XXH3_64bits_digest(state_->xxh); }

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace kadr
