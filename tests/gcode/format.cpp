#include "gcode/format/format.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "random_lines.h"
#include "rs274_generator.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;
namespace fs = std::filesystem;

namespace {

struct Formatted {
  std::string text;
  Diagnostics diagnostics;
  bool good = false;
};

Formatted formatted(const std::string& text) {
  Formatted result;
  SourceSet sources;
  const std::uint32_t file = sources.add(SourceText("part.ngc", text));
  result.good = format_program(sources, file, result.diagnostics, result.text);
  return result;
}

std::string form(const std::string& text) { return formatted(text).text; }

/// The blocks of a program, line numbers included, and its diagnostics.
std::string meaning(const std::string& text) {
  const Outcome outcome = run(text);
  std::string out;
  for (const Block& block : outcome.blocks) {
    append_canon(out, block);
    out += '\n';
  }
  std::vector<std::string> told;
  for (const Diagnostic& d : outcome.diagnostics.list())
    told.push_back(code_name(d.code) + " in line " + std::to_string(d.span.line));
  std::sort(told.begin(), told.end());
  for (const std::string& t : told) out += t + '\n';
  return out;
}

/// The normal form is its own normal form and means the same, line by line.
void check_form(const std::string& text) {
  CAPTURE(text);
  const std::string once = form(text);
  CAPTURE(once);
  REQUIRE(form(once) == once);
  REQUIRE(meaning(once) == meaning(text));
}

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("words come in the order in which they act, one blank apart") {
  CHECK(form("m3 s500 f100 x1 g1 g90 n10\n") == "G90 G1 X1 F100 S500 M3 N10\n");
  CHECK(form("n10 m3 s500 f100 x1 g1 g90\n") == "N10 G90 G1 X1 F100 S500 M3\n");
  CHECK(form("G1G94G17G21G40G49G54G64G90G98X1W2V3Y4Z5A6\n") ==
        "G94 G17 G21 G40 G49 G54 G64 G90 G98 G1 X1 Y4 Z5 A6 V3 W2\n");
  CHECK(form("M2 M9 M5 M6 T2\n") == "T2 M6 M5 M9 M2\n");
  CHECK(form("J2 I1 Y2 X1 G2 P3 F5\n") == "G2 X1 Y2 I1 J2 P3 F5\n");
  CHECK(form("G53 G0 X1 G90\n") == "G90 G53 G0 X1\n");
  CHECK(form("^30 @5 G1\n") == "G1 @5 ^30\n");
  CHECK(form("$1 S100 M3\n") == "S100 $1 M3\n");
}

TEST_CASE("numbers lose blanks, plus signs and needless zeros, never their value or their point") {
  CHECK(form("G01 X+01.500 Y - 0.0 Z.5 A1 0 B10.0 C-007\n") == "G1 X1.5 Y-0. Z0.5 A10 B10. C-7\n");
  CHECK(form("N0010 G00 G92.10 M03 T01\n") == "N10 G92.1 G0 T1 M3\n");
  CHECK(plain_number("0.100000000000000005551115123125782700") == "0.1000000000000000055511151231257827");
  CHECK(plain_number("000") == "0");
  CHECK(plain_number("0.") == "0.");
  CHECK(plain_number("01.0", false) == "1");
}

TEST_CASE("settings stand behind the words, whose values they do not change, in their order") {
  CHECK(form("#1=5 X#1 G0 #2=#1\n") == "G0 X#1 #1=5 #2=#1\n");
  CHECK(form("# [1+1] = -.5\n") == "#[1 + 1]=-0.5\n");
  // a name exists from its setting on: before that it would have no value
  CHECK(form("#<Feed Rate>=3 F#<feed rate>\n") == "#<Feed Rate>=3 F#<feed rate>\n");
  CHECK(form("p300 m98\n") == "P300 M98\n");
  CHECK(form("n5 m98p300\n") == "N5 M98 P300\n");
}

TEST_CASE("expressions have blanks round their operators and nowhere else") {
  CHECK(form("x[ 1+2*[3-4]/#5 mod 6 ]\n") == "X[1 + 2 * [3 - 4] / #5 MOD 6]\n");
  CHECK(form("X[-#1**-2] Y-sin[30]\n") == "X[-#1 ** -2] Y-SIN[30]\n");
  CHECK(form("X a tan[1] / [2]\n") == "XATAN[1]/[2]\n");
  CHECK(form("X##1 Y[exists [ #<a b> ]+e x i s t s[#5]]\n") == "X##1 Y[EXISTS[#<a b>] + EXISTS[#5]]\n");
  CHECK(form("X[1 e q #2 and#3 L T 4]\n") == "X[1 EQ #2 AND #3 LT 4]\n");
}

TEST_CASE("comments come last in their order, neighbours below each other") {
  CHECK(form("(one) G0 X1 (MSG,two)\nG0 Y1.25 ; three  \nG1 F5\nX2 (four)\n") ==
        "G0 X1    (one) (MSG,two)\n"
        "G0 Y1.25 ; three\n"
        "G1 F5\n"
        "X2 (four)\n");
  CHECK(form("  (alone)\n\n\n;too\n") == "(alone)\n\n\n;too\n");
  // a long line does not push the comments of its neighbours
  const std::string longest = "G1 X[1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15]";
  CHECK(form("X1 (a)\n" + longest + " (b)\nX12 (c)\n") == "X1  (a)\n" + longest + " (b)\nX12 (c)\n");
}

TEST_CASE("O words indent what they enclose") {
  CHECK(form("o<Bore> sub (hole)\n"
             "o1 if[#1 gt 2]\n"
             "G0 X1\n"
             "(note)\n"
             "o1 else\n"
             "/ G0 X2\n"
             "o1 endif\n"
             "o2 do\n"
             "#1=[#1-1]\n"
             "o2 while[#1]\n"
             "o3 while [#1 lt 3]\n"
             "o4 repeat[2]\n"
             "o4 endrepeat\n"
             "o3 endwhile\n"
             "o<Bore> end sub\n"
             "n5 O<Bore>call[1][#2]\n"
             "o[#1+1]call\n"
             "o5return[3]\n") ==
        "O<Bore> sub (hole)\n"
        "  O1 if [#1 GT 2]\n"
        "    G0 X1\n"
        "    (note)\n"
        "  O1 else\n"
        "/    G0 X2\n"
        "  O1 endif\n"
        "  O2 do\n"
        "    #1=[#1 - 1]\n"
        "  O2 while [#1]\n"
        "  O3 while [#1 LT 3]\n"
        "    O4 repeat [2]\n"
        "    O4 endrepeat\n"
        "  O3 endwhile\n"
        "O<Bore> endsub\n"
        "N5 O<Bore> call [1] [#2]\n"
        "O[#1 + 1] call\n"
        "O5 return [3]\n");
  CHECK(form("O0100\nG1\nM99\n") == "O100\nG1\nM99\n");
}

TEST_CASE("line ends are LF, the last line has one, a byte order mark stays, blanks behind go") {
  CHECK(form("G0  \r\nG1") == "G0\nG1\n");
  CHECK(form("\xEF\xBB\xBFg0 x1\n") == "\xEF\xBB\xBFG0 X1\n");
  CHECK(form("").empty());
  CHECK(form("  \t\n") == "\n");
  CHECK(form("/ n5  g0\n") == "/N5 G0\n");
}

TEST_CASE("what stands behind the closing % stays as it is, also what could not be read") {
  const std::string text = "(head)\n%\ng0 x1\n %\nthis  is  \r\n no program";
  const Formatted f = formatted(text);
  CHECK(f.good);
  CHECK(f.text == "(head)\n%\nG0 X1\n%\nthis  is  \n no program\n");
}

TEST_CASE("a line with a mistake stays as it is and is told, the others get their form") {
  const Formatted f = formatted("g0 x1\n g1  x1.2.3  (bad) \ng1 y2\n");
  CHECK_FALSE(f.good);
  CHECK(f.text == "G0 X1\n g1  x1.2.3  (bad) \nG1 Y2\n");
  REQUIRE(f.diagnostics.list().size() == 1);
  CHECK(f.diagnostics.list()[0].code == Code::bad_number);
}

TEST_CASE("a line number inside a line stays a mistake") {
  check_form("G0 N5 X1\n");
  check_form("#1=2 N5\n");
  check_form("N1 N2\n");
  check_form("(c) N1 G0\n");
}

TEST_CASE("the form of random lines, good and bad, means the same and is final") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(2000); ++i) {
    std::string text = random.chance(0.1) ? "\xEF\xBB\xBF" : "";
    for (std::uint64_t lines = random.below(8); lines > 0; --lines) {
      text += random_line(random);
      text += random.chance(0.3) ? "\r\n" : "\n";
    }
    check_form(text);
  }
}

TEST_CASE("the form of random valid programs means the same and is final") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(60); ++i) {
    Subjects subjects{.offsets = true, .machine = true};
    if (i % 2 == 1)
      subjects = {.offsets = true, .rotation = true, .polar = true, .tools = true, .cycles = true};
    check_form(Generator(random, subjects).program().text);
  }
}

TEST_CASE("the form of every program of the scenarios and of every bad program means the same and is final") {
  int programs = 0;
  for (const char* folder : {"scenarios", "tests/bad/gcode"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(KADR_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".ngc") continue;
      // more of the same, and under the sanitizers, which count less, minutes of it
      if (std::getenv("KADR_COUNT") != nullptr && entry.file_size() > 20'000) continue;
      CAPTURE(entry.path().string());
      check_form(file_text(entry.path()));
      ++programs;
    }
  }
  CHECK(programs > 60);
}

TEST_CASE("an expression of a megabyte is formatted without a deep stack") {
  std::string text = "X[1";
  for (int i = 0; i < 200'000; ++i) text += "+1";
  CHECK(form(text + "]\n").size() > 800'000);
}

TEST_CASE("the form of nested O words grows with their number, not with its square") {
  const auto nested = [](int n) {
    std::string text;
    for (int i = 1; i <= n; ++i) text += "o" + std::to_string(i) + " if [1]\n";
    for (int i = n; i >= 1; --i) text += "o" + std::to_string(i) + " endif\n";
    return text + "M2\n";
  };
  const std::string text = nested(2000);
  CHECK(form(text).size() < text.size() + 4000 * 80);
  check_form(nested(100));
  // 40 levels of two blanks
  CHECK(form(nested(100)).find("\n" + std::string(80, ' ') + "O60 if") != std::string::npos);
}
