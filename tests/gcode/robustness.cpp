#include <doctest/doctest.h>

#include <cmath>

#include <fmt/format.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Reads a text and checks what every program must keep, good or bad.
void survive(const std::string& text) {
  CAPTURE(text);
  const Outcome outcome = run(text);
  REQUIRE(outcome.diagnostics.errors() <= 1000);
  for (const Block& b : outcome.blocks) {
    if (const auto* dwell = std::get_if<Dwell>(&b.action)) REQUIRE(dwell->time_s >= 0);
    const Move* move = move_of(b);
    if (move == nullptr) continue;
    for (const double v : move->end) REQUIRE(std::isfinite(v));
    REQUIRE(std::isfinite(move->length_u));
    REQUIRE(std::isfinite(move->feed_u_s));
    REQUIRE(move->feed_u_s >= 0);
    REQUIRE(std::isfinite(move->duration_s));
    REQUIRE((!is<Feed>(b) || move->feed_u_s > 0 || move->length_u == 0));
    const auto* arc = std::get_if<Arc>(&b.action);
    if (arc == nullptr) continue;
    REQUIRE(std::isfinite(arc->center_first_mm));
    REQUIRE(std::isfinite(arc->center_second_mm));
    REQUIRE(arc->turns != 0);
  }
  if (!outcome.diagnostics.has_errors()) REQUIRE(is<ProgramEnd>(outcome.blocks.back()));
}

std::string random_bytes(Random& random) {
  std::string text(random.below(200), '\0');
  for (char& c : text) c = static_cast<char>(random.below(256));
  return text;
}

/// Tokens of the dialect in no sensible order.
std::string token_soup(Random& random) {
  static const char* const kTokens[] = {
      "G0",    "G1",  "G2",        "G3",     "G4",      "G10", "G17", "G18", "G19", "G20",   "G21",   "G28",
      "G28.1", "G53", "G54",       "G59.3",  "G61.1",   "G64", "G80", "G90", "G91", "G90.1", "G91.1", "G92",
      "G92.3", "G93", "G94",       "G43.1",  "G49",     "G81", "X",   "Y",   "Z",   "A",     "U",     "I",
      "J",     "K",   "R",         "P",      "L",       "F",   "S",   "T",   "M3",  "M6",    "M8",    "M49",
      "M50",   "M2",  "#",         "=",      "1",       "2.5", "-3",  "0",   "1e9", ".001",  "99999", "[",
      "]",     "SIN", "ATAN",      "/",      "**",      "MOD", "+",   "-",   "#1",  "#5420", "(MSG,", ")",
      "(a)",   ";",   "%",         "N5",     "\n",      "\n",  "X1",  "Y2",  "Z-3", "I1",    "J-1",   "R5",
      "F100",  "P2",  "#1=[#1+1]", "L20 P1", "X[1/#1]", "\n",  "\n"};
  std::string text;
  const std::uint64_t tokens = random.below(60);
  for (std::uint64_t i = 0; i < tokens; ++i) {
    text += kTokens[random.below(std::size(kTokens))];
    if (random.chance(0.5)) text += ' ';
  }
  return text;
}

/// A valid program of lines and arcs, twice: in absolute and in incremental words.
struct TwoForms {
  std::string absolute = "F600 G90 G0 X0 Y0 Z0\n";
  std::string incremental = "F600 G91 G0 X0 Y0 Z0\n";
};
TwoForms random_path(Random& random) {
  TwoForms forms;
  double x = 0, y = 0, z = 0;
  for (int i = 0; i < 30; ++i) {
    const double nx = std::floor(random.real(-1000, 1000)) / 8, ny = std::floor(random.real(-1000, 1000)) / 8;
    const double nz = std::floor(random.real(-100, 100)) / 8;
    const double half = std::hypot(nx - x, ny - y) / 2;
    const bool arc = random.chance(0.4) && half > 1;
    const std::string rest =
        arc ? fmt::format(" R{}", (std::floor(half) + 2) * (random.chance(0.5) ? 1 : -1)) : std::string();
    const char* const code = arc ? (random.chance(0.5) ? "G2" : "G3") : random.chance(0.5) ? "G1" : "G0";
    forms.absolute += fmt::format("{} X{} Y{} Z{}{}\n", code, nx, ny, nz, rest);
    forms.incremental += fmt::format("{} X{} Y{} Z{}{}\n", code, nx - x, ny - y, nz - z, rest);
    x = nx, y = ny, z = nz;
  }
  return forms;
}

}  // namespace

TEST_CASE("random bytes never crash, hang or make a block that is not finite") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(3000); ++i) survive(random_bytes(random));
}

TEST_CASE("soups of tokens never crash, hang or make a block that is not finite") {
  Random random(seed() + 1);
  for (std::uint64_t i = 0; i < count(5000); ++i) survive(token_soup(random));
}

TEST_CASE("a path in absolute and in incremental words makes the same blocks") {
  Random random(seed() + 2);
  for (std::uint64_t i = 0; i < count(200); ++i) {
    const TwoForms forms = random_path(random);
    CAPTURE(forms.absolute);
    const auto a = run(forms.absolute).trace, b = run(forms.incremental).trace;
    REQUIRE(a == b);
  }
}

TEST_CASE("any offset leaves the shape of a path unchanged") {
  Random random(seed() + 3);
  for (std::uint64_t i = 0; i < count(200); ++i) {
    const TwoForms forms = random_path(random);
    const auto plain = run(forms.absolute).moves();
    const auto moved = run("G10 L2 P2 X128 Y-64\nG55\nG92 X32\n" + forms.absolute).moves();
    REQUIRE(plain.size() == moved.size());
    // system 2 at (128, -64); at machine 0 the program read -128, named 32: offset of G92 is -160
    for (std::size_t k = 1; k < plain.size(); ++k) {
      REQUIRE(moved[k].end[0] == plain[k].end[0] - 32);
      REQUIRE(moved[k].end[1] == plain[k].end[1] - 64);
      REQUIRE(moved[k].length_u == doctest::Approx(plain[k].length_u).epsilon(1e-12));
      REQUIRE(moved[k].turns == plain[k].turns);
    }
  }
}
