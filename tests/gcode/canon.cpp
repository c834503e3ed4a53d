#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

std::string dwell_text(double seconds) {
  const Block block{{.line = 7}, Dwell{seconds}};
  std::string out;
  append_canon(out, block);
  return out;
}

}  // namespace

TEST_CASE("numbers have six decimals and no negative zero") {
  CHECK(dwell_text(0.5) == "DWELL 0.500000 @7");
  CHECK(dwell_text(-0.0000004) == "DWELL 0.000000 @7");
  CHECK(dwell_text(-0.0) == "DWELL 0.000000 @7");
  CHECK(dwell_text(-12.0000006) == "DWELL -12.000001 @7");
  CHECK(dwell_text(9.9999999) == "DWELL 10.000000 @7");
  CHECK(dwell_text(123456789.123456) == "DWELL 123456789.123456 @7");
  CHECK(dwell_text(1e300) == fmt::format("DWELL {:.6f} @7", 1e300));
}

TEST_CASE("the fast writer agrees with the library's to one unit of the last place") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(20000); ++i) {
    const double value = random.real(-1, 1) * std::pow(10, random.real(-7, 9));
    const std::string text = dwell_text(value);
    const double read = std::strtod(text.c_str() + 6, nullptr);
    REQUIRE(std::fabs(read - value) <= 0.5000001e-6 + std::fabs(value) * 1e-15);
    REQUIRE(text.find('.') == text.size() - 10);
  }
}

TEST_CASE("each line of the trace ends with the place of its words") {
  SourceSet sources;
  const auto file = sources.add(SourceText("part.ngc", "(first)\n\nG0 X1\n"));
  Diagnostics diagnostics;
  std::string out;
  interpret(
      sources, file, {}, [&](const Block& b) { append_canon(out, b); }, diagnostics);
  CHECK(out.find(" @3PROGRAM_END @") != std::string::npos);
}

TEST_CASE("override switches and comments are no part of the trace") {
  CHECK(run("M49\nM48\n(plain)\n").trace == std::vector<std::string>{"PROGRAM_END"});
}
