#include "plant/deterministic_pow.h"

#include <atomic>

#include "machine/base/numbers.h"

namespace {

std::atomic<std::int64_t> calls{0};

double power(double base, double exponent) {
  const bool whole = __builtin_floor(exponent) == exponent;
  if (!(base < 0) || !whole) return kadr::exact_pow(base, exponent);
  const bool odd = __builtin_floor(exponent / 2) * 2 != exponent;
  return odd ? -kadr::exact_pow(-base, exponent) : kadr::exact_pow(-base, exponent);
}

}  // namespace

/// The whole program's pow, of + - * / alone: glibc picks an FMA variant when the CPU has one, and CVODE's
/// step sizes would follow. An executable's symbol goes before the library's, so libsundials_cvode.so takes
/// this one.
extern "C" double pow(double base, double exponent) noexcept;
extern "C" double pow(double base, double exponent) noexcept {
  calls.fetch_add(1, std::memory_order_relaxed);
  return power(base, exponent);
}

namespace kadr::plant {

std::int64_t pow_calls() { return calls.load(std::memory_order_relaxed); }

}  // namespace kadr::plant
