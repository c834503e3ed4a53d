#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Scratch;

namespace {

// docs/promises.md
constexpr double kFixed_MB = 64;
constexpr double kBlock_B = 2500;
constexpr double kSpline_B = 100'000;
constexpr double kTextByte_B = 150;

constexpr std::size_t kText_bytes = 300'000;

/// A text of that many bytes: head, as many pieces as fit, tail.
struct Construct {
  const char* name;
  std::string head;
  std::function<std::string(int)> piece;
  std::string tail;
  int blocks_of_piece = 0;
};

std::string line_of(const char* form, int i) { return fmt::format(fmt::runtime(form), i + 1, i % 2); }

/// The text, and how many blocks it makes.
std::pair<std::string, double> made(const Construct& construct) {
  std::string text = construct.head;
  int pieces = 0;
  for (; text.size() < kText_bytes; ++pieces) text += construct.piece(pieces);
  return {text + construct.tail, static_cast<double>(pieces) * construct.blocks_of_piece};
}

auto lines(const char* form) {
  return [form](int i) { return line_of(form, i); };
}

void check_peak(const Finished& done, const std::string& text, double blocks) {
  CAPTURE(done.err.substr(0, 300));
  CHECK(done.signal == 0);
  CHECK(done.code <= 2);
  const double allowed_MB =
      kFixed_MB + 1e-6 * (kBlock_B * blocks + kTextByte_B * static_cast<double>(text.size()));
  CHECK(done.peak_MB < allowed_MB);
}

}  // namespace

#if !defined(__SANITIZE_ADDRESS__)

TEST_CASE("memory grows with blocks and text, by no more than is promised") {
  const Scratch scratch;
  const std::vector<Construct> programs = {
      {"moves", "F9000\nG1\n", lines("X{1}\n"), "M2\n", 1},
      {"corners", "F9000G64P1\nG1\n", [](int i) { return fmt::format("X{}Y{}\n", i % 2, i / 2 % 2); }, "M2\n",
       1},
      {"arcs", "F9000\nG2I1\n", lines("I1\n"), "M2\n", 1},
      {"outputs", "", lines("M8\n"), "M2\n", 1},
      {"dwells", "", lines("G4P{1}\n"), "M2\n", 1},
      {"holes", "F9\nG81R1Z-1\n", lines("X{1}\n"), "M2\n", 4},
      {"names", "", lines("#<a{0}>=1\n"), "M2\n", 0},
      {"subs", "", lines("O{0}sub\nO{0}endsub\n"), "M2\n", 0},
      {"open branches", "", lines("O{0}if[1]\n"), "", 0},
      {"errors", "", lines("G1X\n"), "", 0},
      {"errors of one line", "", lines("X1 "), "\n", 0},
      {"nurbs", "F9G5.2X1Y1P1L4\n", lines("X{1}Y1P1\n"), "G5.3\nM2\n", 1},
      {"messages", "", lines("(MSG,x)\n"), "M2\n", 1},
  };
  for (const Construct& construct : programs) {
    CAPTURE(construct.name);
    const auto [text, blocks] = made(construct);
    scratch.write("p.ngc", text);
    check_peak(call({"check", "p.ngc", "-q"}, scratch.path()), text, blocks);
    check_peak(call({"run", "p.ngc", "-q", "--no-log", "--until", "0.01"}, scratch.path()), text, blocks);
  }
  std::string splines = "F9000\n";
  for (int i = 0; i < 150; ++i) splines += "G5X1Y1I0J3P0Q-3\nG5X0Y0I1J1P1Q1\n";
  scratch.write("p.ngc", splines + "M2\n");
  check_peak(call({"check", "p.ngc", "-q"}, scratch.path()), splines, 300 * kSpline_B / kBlock_B);
  const std::vector<Construct> settings = {
      {"numbers", "a=[", lines("1,"), "]\n"},
      {"texts", "a=[", lines("'',"), "]\n"},
      {"lists", "a=[", lines("[],"), "]\n"},
      {"tables", "a=[", lines("{{}},"), "]\n"},
      {"keys", "", lines("k{0}=1\n"), ""},
      {"headers", "", lines("[a{0}]\n"), ""},
      {"dotted keys", "", lines("a.b.c.d.e.f.g.h{0}=1\n"), ""},
      {"axes", "", lines("[[axis]]\n"), ""},
  };
  for (const Construct& construct : settings) {
    CAPTURE(construct.name);
    const std::string text = made(construct).first;
    scratch.write("s.toml", text);
    check_peak(call({"machine", "check", "s.toml"}, scratch.path()), text, 0);
    check_peak(call({"scenario", "check", "s.toml"}, scratch.path()), text, 0);
    check_peak(call({"tube", "s.toml"}, scratch.path()), text, 0);
  }
  scratch.write("e.ngc", "M2\n");
  for (const char* form : {"T{0}P{0}\n", "T1P1\n", "T{0}P{0};x\n"}) {
    const std::string text = made({"", "", lines(form), ""}).first;
    scratch.write("t.tbl", text);
    check_peak(call({"check", "e.ngc", "--tools", "t.tbl"}, scratch.path()), text, 0);
  }
}

#endif
