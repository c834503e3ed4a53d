#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "emulator/log_tools/export/envelope.h"
#include "emulator/log_tools/export/log_samples.h"

using namespace kadr::log_tools;

TEST_CASE("a pattern's star stands for any text, also none") {
  CHECK(matches_pattern("feed.commanded_mm_s", "feed.*"));
  CHECK(matches_pattern("axis.X.load_mm", "axis.*.load*"));
  CHECK(matches_pattern("feed.line", "feed.line"));
  CHECK(matches_pattern("feed.line", "*"));
  CHECK(matches_pattern("feed.line", "feed.line*"));
  CHECK_FALSE(matches_pattern("axis.X.load_mm", "axis.*.load"));
  CHECK_FALSE(matches_pattern("feed.line", "feed"));
  CHECK_FALSE(matches_pattern("feed.line", ""));
}

TEST_CASE("an envelope keeps the lowest and highest value of a run of any length") {
  // 1000 values of 1 ms in at most 8 pieces: 1000/8 = 125 ms needs pieces of 128 ms, so 8 of them; a spike at 0.500 s
  Envelope envelope(0, 0.001, 8);
  for (int i = 1; i <= 1000; ++i) envelope.add(0.001 * i, i == 500 ? -7 : i == 777 ? 9 : 1);
  const auto pieces = envelope.pieces();
  REQUIRE(pieces.size() == 8);
  CHECK(pieces[0].end_s == doctest::Approx(0.128));
  CHECK(pieces[7].end_s == doctest::Approx(1.0));
  CHECK(pieces[3].low == -7);  // 0.384 to 0.512 s
  CHECK(pieces[3].high == 1);
  CHECK(pieces[6].high == 9);  // 0.768 to 0.896 s
  CHECK(pieces[0].low == 1);
}

TEST_CASE("a sample at a piece's end belongs to it, and what is not a number leaves no mark") {
  Envelope envelope(0, 0.1, 4);
  envelope.add(0.1, 3);
  envelope.add(0.2, std::numeric_limits<double>::quiet_NaN());
  envelope.add(0.3, 5);
  const auto pieces = envelope.pieces();
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[0].high == 3);
  CHECK(pieces[1].empty);
  CHECK(pieces[2].low == 5);
}
