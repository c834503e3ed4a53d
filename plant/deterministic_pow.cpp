#include "plant/deterministic_pow.h"

#include <atomic>
#include <bit>

#include "machine/base/numbers.h"

namespace {

std::atomic<std::int64_t> calls{0};

// ln m for m in [1/sqrt 2, sqrt 2]: 2 atanh((m - 1)/(m + 1)), series to the 21st power (rest below 1e-17)
double log_near_one(double m) {
  const double s = (m - 1) / (m + 1), z = s * s, z2 = z * z, z4 = z2 * z2;
  const double low = (1 + z * (1.0 / 3)) + z2 * (1.0 / 5 + z * (1.0 / 7));
  const double middle = (1.0 / 9 + z * (1.0 / 11)) + z2 * (1.0 / 13 + z * (1.0 / 15));
  const double high = (1.0 / 17 + z * (1.0 / 19)) + z2 * (1.0 / 21);
  return 2 * s * (low + z4 * (middle + z4 * high));
}

// e^r for |r| <= ln 2/2, Taylor to the 13th power (rest below 1e-17)
double exp_near_zero(double r) {
  const double r2 = r * r, r4 = r2 * r2;
  const double first = (1 + r) + r2 * (1.0 / 2 + r * (1.0 / 6));
  const double second = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
  const double third = (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
  const double fourth = 1.0 / 479001600 + r * (1.0 / 6227020800);
  return first + r4 * (second + r4 * (third + r4 * fourth));
}

constexpr double kLn2 = 0.69314718055994530942;

double power(double base, double exponent) {
  // CVODE's case: a moderate root of a normal number, good to a few units in the last place
  const auto bits = std::bit_cast<std::uint64_t>(base);
  const auto biased = static_cast<int>(bits >> 52);
  if (biased > 0 && biased < 2047) {
    int two = biased - 1023;
    double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
    if (m > 1.4142135623730951) {
      m *= 0.5;
      ++two;
    }
    const double log_result = exponent * (two * kLn2 + log_near_one(m));
    if (log_result > -8 && log_result < 8) {
      const double n = __builtin_floor(log_result * (1 / kLn2) + 0.5);
      // the leading 32 bits of ln 2 times a small whole number are exact
      const double r = (log_result - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;
      const auto scale = static_cast<std::uint64_t>(1023 + static_cast<int>(n)) << 52;
      return exp_near_zero(r) * std::bit_cast<double>(scale);
    }
  }
  const bool whole = __builtin_floor(exponent) == exponent;
  if (!(base < 0) || !whole) return kadr::exact_pow(base, exponent);
  const bool odd = __builtin_floor(exponent / 2) * 2 != exponent;
  return odd ? -kadr::exact_pow(-base, exponent) : kadr::exact_pow(-base, exponent);
}

}  // namespace

/// The whole program's pow, of + - * / alone: glibc picks an FMA variant when the CPU has one, and CVODE's
/// step sizes would follow. The linker takes the first definition it meets, so CVODE's calls end here
/// (cvode.cpp names this file, which brings it in before libm).
extern "C" double pow(double base, double exponent) noexcept;
extern "C" double pow(double base, double exponent) noexcept {
  calls.fetch_add(1, std::memory_order_relaxed);
  return power(base, exponent);
}

namespace kadr::plant {

std::int64_t pow_calls() { return calls.load(std::memory_order_relaxed); }

}  // namespace kadr::plant
