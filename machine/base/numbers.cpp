#include "machine/base/numbers.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace kadr {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// adding and subtracting 1.5 * 2^52 rounds to the nearest integer, ties to even, without a library call
constexpr double kRound = 6755399441055744.0;

// pi/2 = kPio2a + kPio2b + kPio2c; the first two have 33 bits, so that their products with n < 2^20 are exact
constexpr double kPio2a = 0x1.921fb54400000p+0;
constexpr double kPio2b = 0x1.0b4611a600000p-34;
constexpr double kPio2c = 0x1.3198a2e037073p-69;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

constexpr double kPiHigh = 0x1.921fb54442d18p+1, kPiLow = 0x1.1a62633145c07p-53;
constexpr double kPio2High = 0x1.921fb54442d18p+0, kPio2Low = 0x1.1a62633145c07p-54;

// ln 2 = kLn2High + kLn2Low; the high part has 32 bits, so that its product with an exponent is exact
constexpr double kLn2High = 0x1.62e42fee00000p-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kLn2Lowest = 0x1.cc01f97b57a08p-87;
constexpr double kOneOverLn2 = 0x1.71547652b82fep+0;

/// An unevaluated sum high + low with |low| <= ulp(high)/2.
struct Double2 {
  double high, low;
};

Double2 two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

Double2 quick_sum(double a, double b) {  // |a| >= |b|
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

Double2 two_product(double a, double b) {
  constexpr double split = 134217729.0;  // 2^27 + 1
  const double ca = split * a, cb = split * b;
  const double ah = ca - (ca - a), bh = cb - (cb - b);
  const double al = a - ah, bl = b - bh;
  const double product = a * b;
  return {product, ((ah * bh - product) + ah * bl + al * bh) + al * bl};
}

Double2 multiply(Double2 a, Double2 b) {
  const Double2 p = two_product(a.high, b.high);
  return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

Double2 add(Double2 a, Double2 b) {
  const Double2 s = two_sum(a.high, b.high);
  return quick_sum(s.high, s.low + (a.low + b.low));
}

/// 2^n for -1022 <= n <= 1023.
double power_of_two(std::int64_t n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

/// x 2^n without an intermediate overflow or a second rounding of a normal result, |n| <= 2200.
double scale(double x, std::int64_t n) {
  if (n >= -1021 && n <= 1023) return x * power_of_two(n);
  const std::int64_t half = n / 2;
  return x * power_of_two(half) * power_of_two(n - half);
}

/// Splits x > 0 into m 2^e with sqrt(1/2) <= m < sqrt(2).
struct Split {
  double mantissa;
  std::int64_t exponent;
};

Split split_exponent(double x) {
  std::int64_t exponent = 0;
  if (x < 0x1p-1022) {  // denormal
    x *= 0x1p+54;
    exponent = -54;
  }
  auto bits = std::bit_cast<std::uint64_t>(x);
  constexpr std::uint64_t kHalfRoot = 0x3FE6A09E667F3BCD;  // bits of sqrt(1/2)
  const std::uint64_t shifted = bits - kHalfRoot;
  const auto n = static_cast<std::int64_t>(shifted) >> 52;
  bits -= static_cast<std::uint64_t>(n) << 52;
  return {std::bit_cast<double>(bits), exponent + n};
}

/// e^(a.high + a.low) for |a.high| <= 745: a = k ln 2 + r, Taylor's series of e^r for |r| <= 0.347 (to r^13: 5e-18).
double exp_of(Double2 a) {
  const double k = (a.high * kOneOverLn2 + kRound) - kRound;
  const double high = a.high - k * kLn2High;
  const Double2 r = two_sum(high, a.low - k * kLn2Low);
  const double x = r.high;
  const double x2 = x * x;
  // pairs of coefficients shorten the chain of dependent operations
  const double c23 = 1.0 / 2 + x * (1.0 / 6), c45 = 1.0 / 24 + x * (1.0 / 120);
  const double c67 = 1.0 / 720 + x * (1.0 / 5040), c89 = 1.0 / 40320 + x * (1.0 / 362880);
  const double cab = 1.0 / 3628800 + x * (1.0 / 39916800), ccd = 1.0 / 479001600 + x * (1.0 / 6227020800.0);
  const double x4 = x2 * x2;
  const double tail = x2 * ((c23 + x2 * c45) + x4 * ((c67 + x2 * c89) + x4 * (cab + x2 * ccd)));
  const double value = 1.0 + (x + (r.low + tail));
  return scale(value, static_cast<std::int64_t>(k));
}

/// ln x with a relative error below 2^-63, x > 0 and finite: 2 atanh(s), s = (m - 1)/(m + 1).
Double2 log_of(double x) {
  const auto [m, e] = split_exponent(x);
  const double k = static_cast<double>(e);
  // s as a quotient and its remainder; m - 1 is exact, m + 1 is not
  const double f = m - 1.0;
  const Double2 den = two_sum(m, 1.0);
  const double quotient = f / den.high;
  const Double2 back = two_product(quotient, den.high);
  const Double2 s = quick_sum(quotient, ((f - back.high) - back.low - quotient * den.low) / den.high);

  // ln m = 2 s (1 + s2/3 + s2^2 (1/5 + s2/7 + ...)), |s| <= 0.1716, s2 <= 0.0295
  const Double2 s2 = multiply(s, s);
  const double t = s2.high;
  double series = 1.0 / 25;
  for (const double c :
       {1.0 / 23, 1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5})
    series = c + t * series;
  const Double2 third = multiply(s2, {0x1.5555555555555p-2, 0x1.5555555555555p-56});
  const Double2 tail = add(third, {t * t * series, 0.0});
  const Double2 twice{2.0 * s.high, 2.0 * s.low};
  const Double2 log_m = add(twice, multiply(twice, tail));

  const Double2 low = two_product(k, kLn2Low);
  return add(add({k * kLn2High, 0.0}, {low.high, low.low + k * kLn2Lowest}), log_m);
}

}  // namespace

SinCos exact_sincos(double angle_rad) {
  // angle = n pi/2 + (r + r_low), |r| <= pi/4, pi/2 in 119 bits
  const double rounded = angle_rad * kTwoOverPi + kRound;
  const double n = rounded - kRound;
  const auto quadrant = std::bit_cast<std::uint64_t>(rounded) & 3u;
  const double a = angle_rad - n * kPio2a;
  const Double2 b = two_sum(a, -(n * kPio2b));
  const double c = b.low - n * kPio2c;
  const double r = b.high + c;
  const double r_low = (b.high - r) + c;

  // Taylor's series: the first term left out is r^19/19! < 1e-19 and r^18/18! < 3e-18
  const double z = r * r, z2 = z * z, z4 = z2 * z2;
  const double s35 = -1.0 / 6 + z * (1.0 / 120), s79 = -1.0 / 5040 + z * (1.0 / 362880);
  const double sbd = -1.0 / 39916800 + z * (1.0 / 6227020800.0);
  const double sfh = -1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0);
  const double sine_tail = z * r * ((s35 + z2 * s79) + z4 * (sbd + z2 * sfh));
  const double c46 = 1.0 / 24 + z * (-1.0 / 720), c8a = 1.0 / 40320 + z * (-1.0 / 3628800);
  const double cce = 1.0 / 479001600 + z * (-1.0 / 87178291200.0);
  const double cosine_tail = z2 * ((c46 + z2 * c8a) + z4 * (cce + z2 * (1.0 / 20922789888000.0)));

  // sin(r + low) = sin r + low cos r; cos(r + low) = cos r - low sin r, 1 - z/2 without loss
  const double half = 0.5 * z;
  const double one_minus = 1.0 - half;
  const double sine = r + (sine_tail + r_low * one_minus);
  const double cosine = one_minus + (((1.0 - one_minus) - half) + (cosine_tail - r * r_low));

  const bool swap = (quadrant & 1u) != 0;
  const double sin_value = swap ? cosine : sine;
  const double cos_value = swap ? sine : cosine;
  // the signs follow from the quadrant: flip the sign bit without a branch
  const std::uint64_t sin_flip = (quadrant & 2u) << 62;
  const std::uint64_t cos_flip = ((quadrant + 1u) & 2u) << 62;
  return {std::bit_cast<double>(std::bit_cast<std::uint64_t>(sin_value) ^ sin_flip),
          std::bit_cast<double>(std::bit_cast<std::uint64_t>(cos_value) ^ cos_flip)};
}

double exact_atan2(double y, double x) {
  if (y != y || x != x) return kNan;
  double ay = std::fabs(y), ax = std::fabs(x);
  if (ay == kInf || ax == kInf) {
    ay = ay == kInf ? 1.0 : 0.0;
    ax = ax == kInf ? 1.0 : 0.0;
  }
  const bool steep = ay > ax;
  double large = steep ? ay : ax, small = steep ? ax : ay;
  // keep the products below away from overflow and denormals
  if (large > 0x1p+1000) {
    large *= 0x1p-100;
    small *= 0x1p-100;
  } else if (large < 0x1p-900) {
    large *= 0x1p+120;
    small *= 0x1p+120;
  }
  if (large == 0.0) large = 1.0;

  // atan t = atan(k/8) + atan u, u = (t - k/8)/(1 + t k/8), |u| <= 1/16; Taylor's series to u^13: 1e-18 relative
  static constexpr Double2 kAtan[9] = {{0, 0},
                                       {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                       {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                       {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                       {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                       {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                       {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                       {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                       {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  const double rounded = 8.0 * (small / large) + kRound;
  const auto k = static_cast<std::size_t>(std::bit_cast<std::uint64_t>(rounded) & 15u);
  const double c = (rounded - kRound) * 0.125;
  const double u = (small - c * large) / (large + c * small);
  const double z = u * u;
  const double z2 = z * z;
  const double tail =
      u * z *
      ((-1.0 / 3 + z * (1.0 / 5)) + z2 * ((-1.0 / 7 + z * (1.0 / 9)) + z2 * (-1.0 / 11 + z * (1.0 / 13))));

  // unfold the octant: a, pi/2 - a, pi - a or pi/2 + a, the low parts summed first
  const bool left = std::signbit(x);
  const double turn = steep != left ? -1.0 : 1.0;
  const Double2 base = steep ? Double2{kPio2High, kPio2Low} : left ? Double2{kPiHigh, kPiLow} : Double2{0, 0};
  const Double2 main = two_sum(base.high, turn * kAtan[k].high);
  const Double2 angle = two_sum(main.high, turn * u);
  const double low = (main.low + angle.low) + (base.low + turn * (kAtan[k].low + tail));
  return std::copysign(angle.high + low, y);
}

double exact_exp(double x) {
  if (x != x) return kNan;
  if (x > 709.79) return kInf;
  if (x < -745.2) return 0.0;
  return exp_of({x, 0.0});
}

double exact_log(double x) {
  if (x != x || x < 0) return kNan;
  if (x == 0) return -kInf;
  if (x == kInf) return kInf;
  const Double2 l = log_of(x);
  return l.high + l.low;
}

double exact_pow(double base, double exponent) {
  if (exponent == 0 || base == 1) return 1.0;
  if (base != base || exponent != exponent || base < 0) return kNan;
  if (base == 0) return exponent > 0 ? 0.0 : kInf;
  if (base == kInf) return exponent > 0 ? kInf : 0.0;
  if (std::fabs(exponent) == kInf) return (base > 1) == (exponent > 0) ? kInf : 0.0;
  const Double2 l = log_of(base);
  const double estimate = l.high * exponent;
  if (estimate > 709.79) return kInf;
  if (estimate < -745.2) return 0.0;
  const Double2 p = two_product(l.high, exponent);
  return exp_of(quick_sum(p.high, p.low + l.low * exponent));
}

}  // namespace kadr
