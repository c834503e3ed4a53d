#include "machine/base/numbers.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "machine/base/hash.h"
#include "machine/base/parse_number.h"
#include "tests/support/seed.h"

using namespace kadr;

namespace {

std::uint64_t seed_of(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Distance from an 80-bit reference in units of the last place of the double nearest to it.
double error_ulp(double value, long double reference) {
  const double nearest = static_cast<double>(reference);
  const double ulp = std::nextafter(std::fabs(nearest), INFINITY) - std::fabs(nearest);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - reference) / ulp);
}

/// Calls f(u) for random u in [0, 1), KADR_COUNT times.
template <class F>
void sample(F&& f) {
  std::mt19937_64 random(seed_of("KADR_SEED", 1));
  const std::uint64_t count = seed_of("KADR_COUNT", 1'000'000);
  for (std::uint64_t i = 0; i < count; ++i) f(static_cast<double>(random() >> 11) * 0x1p-53);
}

// x87 reduces its argument with a 66-bit pi, glibc's sinl exactly; the reference here is glibc's
constexpr double kTurn = 6.283185307179586;

}  // namespace

TEST_CASE("sine and cosine are within 1 ulp of the 80-bit library inside one turn") {
  double worst_sin = 0, worst_cos = 0;
  sample([&](double u) {
    const double angle = (2 * u - 1) * kTurn;
    const SinCos s = exact_sincos(angle);
    worst_sin = std::fmax(worst_sin, error_ulp(s.sin, sinl(angle)));
    worst_cos = std::fmax(worst_cos, error_ulp(s.cos, cosl(angle)));
  });
  MESSAGE("sin ", worst_sin, " cos ", worst_cos, " ulp");
  CHECK(worst_sin < 1.0);
  CHECK(worst_cos < 1.0);
}

TEST_CASE("sine and cosine stay within 1 ulp up to an angle of 1e6 rad") {
  double worst = 0;
  sample([&](double u) {
    const double angle = (2 * u - 1) * 1e6;
    const SinCos s = exact_sincos(angle);
    worst = std::fmax(worst, std::fmax(error_ulp(s.sin, sinl(angle)), error_ulp(s.cos, cosl(angle))));
  });
  CHECK(worst < 1.0);
}

TEST_CASE("near every multiple of pi/2 up to 1000 turns the small one of sine and cosine keeps its digits") {
  double worst = 0;
  for (int n = -4000; n <= 4000; ++n) {
    const double angle = n * (kPi / 2);
    const SinCos s = exact_sincos(angle);
    worst = std::fmax(worst, std::fmax(error_ulp(s.sin, sinl(angle)), error_ulp(s.cos, cosl(angle))));
  }
  CHECK(worst < 1.0);
}

TEST_CASE("sine and cosine at places one can check") {
  CHECK(exact_sincos(0).sin == 0.0);
  CHECK(exact_sincos(0).cos == 1.0);
  CHECK(exact_sincos(kPi / 2).sin == 1.0);
  CHECK(exact_sincos(kPi).cos == -1.0);
  // sin(double nearest to pi) is pi's rounding error
  CHECK(exact_sincos(kPi).sin == 1.2246467991473532e-16);
  CHECK(exact_sincos(1e-300).sin == 1e-300);
  CHECK(std::isnan(exact_sincos(INFINITY).sin));
}

TEST_CASE("the angle of a point is within 2 ulp of the 80-bit library in all octants and scales") {
  std::mt19937_64 scales(kadr::test::property_seed(7));
  double worst = 0;
  sample([&](double u) {
    const double turn = kTurn * u;
    const double scale = std::ldexp(1.0, static_cast<int>(scales() % 1900) - 950);
    const double x = std::cos(turn) * scale, y = std::sin(turn) * scale;
    worst = std::fmax(worst, error_ulp(exact_atan2(y, x), atan2l(y, x)));
  });
  sample([&](double u) {  // flat angles, where x is much larger than y
    const double y = std::ldexp(u - 0.5, -static_cast<int>(scales() % 60));
    worst = std::fmax(worst, error_ulp(exact_atan2(y, 1.0), atan2l(y, 1.0L)));
  });
  MESSAGE(worst, " ulp");
  CHECK(worst < 2.0);
}

TEST_CASE("the angle of a point on an axis, at the origin and at infinity is the library's") {
  const double values[] = {0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 1e308, -1e308, INFINITY, -INFINITY};
  for (double y : values)
    for (double x : values) {
      CAPTURE(x);
      CAPTURE(y);
      CHECK(exact_atan2(y, x) == std::atan2(y, x));
      CHECK(std::signbit(exact_atan2(y, x)) == std::signbit(std::atan2(y, x)));
    }
  CHECK(std::isnan(exact_atan2(std::nan(""), 1)));
}

TEST_CASE("the exponential is within 2 ulp of the 80-bit library for |x| <= 700") {
  double worst = 0;
  sample([&](double u) {
    const double x = (2 * u - 1) * 700;
    worst = std::fmax(worst, error_ulp(exact_exp(x), expl(x)));
    const double small = (2 * u - 1) * 0.4;
    worst = std::fmax(worst, error_ulp(exact_exp(small), expl(small)));
  });
  MESSAGE(worst, " ulp");
  CHECK(worst < 2.0);
  CHECK(exact_exp(0) == 1.0);
  CHECK(exact_exp(1000) == INFINITY);
  CHECK(exact_exp(-1000) == 0.0);
  CHECK(exact_exp(-740) == doctest::Approx(std::exp(-740.0)).epsilon(1e-9));  // denormal
}

TEST_CASE("the logarithm is within 2 ulp of the 80-bit library from 1e-308 to 1e308 and next to 1") {
  double worst = 0;
  sample([&](double u) {
    const double x = std::exp((2 * u - 1) * 709);
    worst = std::fmax(worst, error_ulp(exact_log(x), logl(x)));
    const double near = 1 + (u - 0.5) * 1e-3;
    if (near != 1) worst = std::fmax(worst, error_ulp(exact_log(near), logl(near)));
    const double around = 0.5 + u * 1.5;
    worst = std::fmax(worst, error_ulp(exact_log(around), logl(around)));
  });
  MESSAGE(worst, " ulp");
  CHECK(worst < 2.0);
  CHECK(exact_log(1) == 0.0);
  CHECK(exact_log(0) == -INFINITY);
  CHECK(exact_log(5e-324) == std::log(5e-324));
  CHECK(std::isnan(exact_log(-1)));
}

TEST_CASE("the power is within 2 ulp of the 80-bit library wherever the result is a normal double") {
  std::mt19937_64 random(kadr::test::property_seed(11));
  double worst = 0;
  sample([&](double u) {
    const double base = std::exp((2 * u - 1) * 100);
    const double largest = 700 / std::fabs(std::log(base));
    const double exponent = (static_cast<double>(random() >> 11) * 0x1p-52 - 1) * std::fmin(largest, 1e5);
    worst = std::fmax(worst, error_ulp(exact_pow(base, exponent), powl(base, exponent)));
  });
  MESSAGE(worst, " ulp");
  CHECK(worst < 2.0);
}

TEST_CASE("the power at places one can check") {
  CHECK(exact_pow(2, 10) == 1024.0);
  CHECK(exact_pow(2, -1074) == 5e-324);
  CHECK(exact_pow(9, 0.5) == 3.0);
  CHECK(exact_pow(1, 1e300) == 1.0);
  CHECK(exact_pow(0, 0) == 1.0);
  CHECK(exact_pow(0, 2) == 0.0);
  CHECK(exact_pow(0, -2) == INFINITY);
  CHECK(exact_pow(10, 400) == INFINITY);
  CHECK(exact_pow(10, -400) == 0.0);
  CHECK(std::isnan(exact_pow(-1, 2)));
}

TEST_CASE("the elementary functions give the same bits with every compiler, optimisation level and CPU") {
  // arguments from integers alone: a linear congruential generator, scaled by powers of two
  Hash64 hash;
  std::uint64_t state = 1;
  const auto next = [&state] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  const auto feed = [&hash](double x) { hash.integer(std::bit_cast<std::int64_t>(x)); };
  for (int i = 0; i < 100'000; ++i) {
    const double a = next(), b = next();
    const SinCos s = exact_sincos((a - 0.5) * 4096);
    feed(s.sin);
    feed(s.cos);
    feed(exact_atan2(a - 0.5, b - 0.5));
    feed(exact_exp((a - 0.5) * 1024));
    feed(exact_log(a + 0x1p-60));
    feed(exact_pow(a * 16 + 0x1p-60, (b - 0.5) * 64));
  }
  CHECK(hash_text(hash.digest()) == "17d2bfa9aac5f255");
}

TEST_CASE("a number is read without a locale, and a decimal comma is never one") {
  CHECK(parse_number("1_000.5") == 1000.5);
  CHECK(parse_number("-.5") == -0.5);
  CHECK(parse_number("5.") == 5.0);
  CHECK(parse_number("+2e4") == 20000.0);
  CHECK(parse_number("2E-3") == 0.002);
  CHECK(parse_number("0.1") == 0.1);
  CHECK(parse_number("1e-400") == 0.0);
  for (const char* bad :
       {"",    "1,5", "1 5", " 1",   "1 ",   "0x10", "inf", "nan",   ".",     "-",     "1e",
        "1e+", "_1",  "1_",  "1__0", "1_.5", "1._5", "--1", "1.2.3", "1e400", "1e1.5", "12mm"})
    CHECK_MESSAGE(!parse_number(bad), bad);
}

TEST_CASE("the shortest text of any double reads back as the same double") {
  std::mt19937_64 random(seed_of("KADR_SEED", 1));
  for (int i = 0; i < 100'000; ++i) {
    double x = 0;
    const std::uint64_t bits = random();
    static_assert(sizeof x == sizeof bits);
    __builtin_memcpy(&x, &bits, sizeof x);
    if (!std::isfinite(x)) continue;
    const auto back = parse_number(number_text(x));
    REQUIRE_MESSAGE(back, number_text(x));
    CHECK(*back == x);
  }
  CHECK(number_text(0.0025) == "0.0025");
  CHECK(number_text(1e6) == "1000000");
  CHECK(number_text(INFINITY) == "inf");
}
