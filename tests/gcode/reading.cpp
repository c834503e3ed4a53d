#include <doctest/doctest.h>

#include "gcode/read/program.h"
#include "random_lines.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

std::string printed_back(const std::string& text) {
  SourceSet sources;
  const std::uint32_t file = sources.add(SourceText("part.ngc", text));
  Diagnostics diagnostics;
  Report report(diagnostics);
  Names names;
  Program program(sources, file, ReadingBounds(), names, report);
  std::string out;
  while (const Line* line = program.next()) append_source(out, *line);
  return out;
}

}  // namespace

TEST_CASE("a parsed program prints back byte for byte, whatever its blanks, case, line ends and mistakes") {
  Random random(seed());
  for (std::uint64_t i = 0; i < count(3000); ++i) {
    std::string text = random.chance(0.1) ? "\xEF\xBB\xBF" : "";
    const std::uint64_t lines = random.below(6);
    for (std::uint64_t k = 0; k < lines; ++k) {
      text += random_line(random);
      text += random.chance(0.3) ? "\r\n" : "\n";
    }
    if (random.chance(0.5)) text += random_line(random);
    CAPTURE(text);
    REQUIRE(printed_back(text) == text);
  }
}

TEST_CASE("blanks mean nothing, even inside words and numbers, and case means nothing") {
  CHECK(last_point("g 0 x 1 2 . 5 y - 3\n")[0] == 12.5);
  CHECK(last_point("g 0 x 1 2 . 5 y - 3\n")[1] == -3);
  CHECK(last_point("\tG0\tX[ 2 m o d 3 ] ys i n [30]\n")[0] == 2);
}

TEST_CASE("numbers may lack digits before or after the point, and are correctly rounded at any length") {
  CHECK(last_point("G0 X5. Y.25 Z+7 A-.5\n") == AxisValues{5, .25, 7, -.5});
  CHECK(last_point("G0 X0.1000000000000000055511151231257827\n")[0] == 0.1);
  CHECK(last_point("G0 X123456.123456789012345678\n")[0] == 123456.123456789012345678);
}

TEST_CASE("a closing percent sign ends a program without a call, and what follows is not read") {
  const Outcome outcome = run("(head)\n%\nG0 X1\n%\nthis is no program\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::words_behind_end});
  CHECK(outcome.trace.size() == 1);
  CHECK(outcome.blocks.back().kind() == BlockKind::program_end);
}

TEST_CASE("nothing after M2 or M30 is run") {
  const Outcome outcome = run("G0 X1\nM2\n(remark)\n G0 X2 X3\nG0 X5\n");
  CHECK(outcome.moves().size() == 1);
  CHECK(outcome.codes() == std::vector<Code>{Code::words_behind_end});
  CHECK(outcome.diagnostics.list()[0].span == Span{0, 4, 2, 1});
  // remarks and subroutines
  for (const std::string text :
       {"M2\n(a)\n;b\n\n", "M2\n%\n(notes)\n", "%\nG0 X1\n%\n;notes\n", "M98 P1\nM2\nO1\nG0 X1\nM99\n"}) {
    CAPTURE(text);
    CHECK(run(text).codes().empty());
  }
  CHECK(run("G0 X1\nM30\nG0 X2\n").moves().size() == 1);
}

TEST_CASE("a file without an end gets one program end, an empty file too") {
  CHECK(run("G0 X1").trace.back() == "PROGRAM_END");
  CHECK(run("").trace == std::vector<std::string>{"PROGRAM_END"});
}

TEST_CASE("a deleted block runs unless block delete is on") {
  InterpretOptions options;
  CHECK(run("/N5 G0 X1\n/ X2\n", options).moves().size() == 2);
  options.block_delete = true;
  CHECK(run("/N5 G0 X1\n/ X2\n", options).moves().empty());
}

TEST_CASE("the last comment of a line is the message") {
  const Outcome outcome = run("(MSG,a)(b)\n(first) (msg, Ab C )\n;(MSG, not)\n(  MSG,x)\n(MSG , y)\n");
  CHECK(outcome.trace == std::vector<std::string>{"MESSAGE \" Ab C \"", "MESSAGE \"x\"", "PROGRAM_END"});
  CHECK(outcome.codes() == std::vector<Code>{Code::comment_not_run});
  CHECK_FALSE(outcome.diagnostics.has_errors());
}

TEST_CASE(
    "a technology point is no call, stands before the move of its line, and a text like it is a comment") {
  const Outcome outcome =
      run("F600\nG1 X10\n(TECH s_max=200)\nG1 X20 (tech S_MAX = 1.5)\n(TECHNOLOGY = 5)\n(TECH)\nG1 X30\n");
  CHECK(outcome.diagnostics.list().empty());
  std::vector<double> speeds;
  std::vector<std::size_t> moves_before;
  std::size_t moves = 0;
  for (const Block& b : outcome.blocks) {
    if (is<Feed>(b)) ++moves;
    const auto* point = std::get_if<SpeedPoint>(&b.action);
    if (point == nullptr) continue;
    speeds.push_back(point->max_u_s);
    moves_before.push_back(moves);
  }
  CHECK(speeds == std::vector<double>{200, 1.5});
  CHECK(moves_before == std::vector<std::size_t>{1, 1});
  // under cutter compensation the corner waits for the move behind it; the point does so too
  const Outcome offset = run("F600 G0 Z1\nG41 D4 G1 X10 Y10\nG1 X30\n(TECH s_max=3)\nG1 Y30\nG40 G1 X0\n");
  std::size_t before = 0;
  for (const Block& b : offset.blocks) {
    if (is<SpeedPoint>(b)) break;
    before += is<Feed>(b) && move_of(b)->end[0] > 20;
  }
  CHECK(before == 1);
}

TEST_CASE("debug messages show parameters with six decimals, quotes and bad bytes don't break the trace") {
  const Outcome outcome = run("#7=1.5\n(DEBUG, a #7 #9999 \"q\" \xFF)\n");
  CHECK(outcome.trace[0] == "MESSAGE \" a 1.500000 ###### \\\"q\\\" \xEF\xBF\xBD\"");
}

TEST_CASE("a format in a message holds for the values behind it, what is no format is text") {
  const Outcome outcome = run("#7=2.25\n(DEBUG,%d#7 #7 %f#7 %.1f#7 %lf#7 100% %5d)\n");
  CHECK(outcome.trace[0] == "MESSAGE \"2 2 2.2500 2.2 %lf2.2 100% %5d\"");
}

TEST_CASE("DEBUG is silent while #5599 is 0, MSG and PRINT are not") {
  const Outcome outcome = run("#5599=0\n(DEBUG,a)\n(MSG,b)\n(PRINT,c)\n#5599=1\n(DEBUG,d)\n");
  CHECK(outcome.trace == std::vector<std::string>{"MESSAGE \"b\"", "# c", "MESSAGE \"d\"", "PROGRAM_END"});
}

TEST_CASE("a byte order mark and CR LF line ends are accepted") {
  CHECK(last_point("\xEF\xBB\xBFG0 X1\r\nX2\r\n")[0] == 2);
}

TEST_CASE("spans point at the words that made a block") {
  const Outcome outcome = run("N10 M3 G1 X5 Y6 F100 (cut)\n");
  REQUIRE(outcome.moves().size() == 1);
  // columns: N10=1, M3=5, G1=8 ... Y6 ends at 15
  CHECK(outcome.moves()[0].span == Span{0, 1, 8, 8});
}

TEST_CASE("lines have no length limit") {
  CHECK(last_point("G0 X" + std::string(100000, ' ') + "5 (" + std::string(100000, 'c') + ")\n")[0] == 5);
}
