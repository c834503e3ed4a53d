#include <doctest/doctest.h>

#include "rs274_generator.h"
#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// Programs about these subjects.
void compare_subjects(std::string_view family, std::uint64_t programs, const Subjects& subjects) {
  compare_with_rs274(family, programs, [&](Random& random) { return Generator(random, subjects).program(); });
}

}  // namespace

TEST_CASE("random valid programs make the same canonical calls as rs274") {
  compare_subjects("basic", 60, {.offsets = true, .machine = true});
}

TEST_CASE("polar words make the same canonical calls as in rs274") {
  compare_subjects("polar", 20, {.offsets = true, .polar = true});
}

TEST_CASE("rotated work systems and G52 make the same canonical calls as in rs274") {
  compare_subjects("rotation", 30, {.offsets = true, .rotation = true});
}

TEST_CASE("tool changes and tool lengths make the same canonical calls as in rs274") {
  compare_subjects("toolchange", 30, {.tools = true});
}

TEST_CASE("feed per revolution, surface speed and diameters make the same canonical calls as in rs274") {
  compare_subjects("turning", 30, {.offsets = true, .machine = true, .turning = true});
}

TEST_CASE("outputs and inputs make the same canonical calls as in rs274") {
  compare_subjects("outputs", 20, {.machine = true, .outputs = true});
}

TEST_CASE("stored modes make the same canonical calls as in rs274") {
  compare_subjects("stored", 30, {.offsets = true, .machine = true, .stored = true});
}

TEST_CASE("everything in one program makes the same canonical calls as in rs274") {
  compare_subjects("mixed", 40,
                   {.offsets = true,
                    .rotation = true,
                    .machine = true,
                    .polar = true,
                    .tools = true,
                    .turning = true,
                    .outputs = true,
                    .stored = true,
                    .cycles = true,
                    .splines = true,
                    .threads = true,
                    .probes = true});
}

TEST_CASE("random combinations of words on one line are accepted or refused as rs274 does") {
  static const char* const kWords[] = {
      "G0",    "G1",   "G2",  "G3",   "G4",      "G10",   "G17", "G18",   "G20",   "G21", "G28",
      "G28.1", "G30",  "G40", "G43",  "G43.1",   "G49",   "G53", "G54",   "G59.3", "G61", "G61.1",
      "G64",   "G80",  "G90", "G91",  "G90.1",   "G91.1", "G92", "G92.1", "G92.3", "G93", "X1",
      "Y2",    "Z3",   "A4",  "I1",   "J1",      "K1",    "R5",  "P1",    "P0",    "L2",  "L20",
      "F50",   "S100", "H0",  "Q1",   "D1",      "M3",    "M5",  "M6",    "M7",    "M9",  "M0",
      "M48",   "M50",  "M60", "#1=2", "(MSG,a)", "N7",    "X#1", "F0",    "Y[1/0]"};
  compare_verdict_with_rs274("words", 60, [](Random& random) {
    TestProgram program;
    std::string& text = program.text;
    text = random.chance(0.5) ? "F100 G1 X0\n" : random.chance(0.5) ? "F100 G2 X1 R5\n" : "";
    const std::uint64_t words = 1 + random.below(5);
    for (std::uint64_t k = 0; k < words; ++k)
      text += std::string(kWords[random.below(std::size(kWords))]) + " ";
    text += "\nM2\n";
    return program;
  });
}
