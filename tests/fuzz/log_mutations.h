#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// Hostile logs: a true one, taken apart into its events, changed and put together again.
namespace kadr::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Small and the same everywhere (splitmix64).
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  /// Uniform in 0 to n - 1; n > 0.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }
  bool one_in(std::size_t n) { return below(n) == 0; }

 private:
  std::uint64_t state_;
};

struct Mutation {
  Bytes log;
  bool sealed = false;  ///< its hashes fit
};
/// One to four changes: of order, columns, ticks, counts, names, numbers, bits.
Mutation mutated(const Bytes& log, Chance& chance);

/// Tiny true logs: with plant, without, with steps of an operator, with channels left out.
std::vector<Bytes> true_logs();

}  // namespace kadr::fuzz
