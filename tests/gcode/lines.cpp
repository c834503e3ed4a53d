#include <doctest/doctest.h>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// Texts that are no programs, or hardly: each ends in a diagnostic with its place, none in a hang.

TEST_CASE("a line of 60,000 bytes runs as a short one does") {
  // 4 + 29,993 + 3 + 29,998 + 2 bytes
  const std::string line = "G0 X" + std::string(29'993, ' ') + "5 (" + std::string(29'998, 'c') + ")\n";
  REQUIRE(line.size() == 60'000);
  CHECK(last_point(line + "Y2\n")[0] == 5);
  CHECK(last_point(line + "Y2\n")[1] == 2);
}

TEST_CASE("a line beyond the bound is told with its length and left out, lines after it are read") {
  InterpretOptions options;
  options.bounds.line_bytes = 20;
  const std::string longest = "G0 X1 (0123456789ab)";
  CHECK(run(longest + "\n", options).diagnostics.list().empty());
  const Outcome outcome = run(longest + " \nG0 X1.2.3\n", options);
  CHECK(outcome.codes() == std::vector<Code>{Code::line_too_long, Code::bad_number});
  CHECK(outcome.rendered.find("21 bytes") != std::string::npos);
  CHECK(outcome.rendered.find("allowed: 20 (--limit line_bytes=N)") != std::string::npos);
}

TEST_CASE("bound 0 on the length of a line is none") {
  InterpretOptions options;
  options.bounds.line_bytes = 0;
  const std::string line = "G0 X5" + std::string(std::size_t{2} << 20, ' ') + "\n";
  CHECK(last_point(line, options)[0] == 5);
  CHECK(only_code(line) == Code::line_too_long);
}

TEST_CASE("a file of 8 MB without a line end is one diagnostic") {
  CHECK(only_code(std::string(std::size_t{8} << 20, 'x')) == Code::line_too_long);
  CHECK(only_code(std::string(std::size_t{8} << 20, '\0')) == Code::line_too_long);
}

TEST_CASE("a NUL byte is a control character and has its place") {
  using namespace std::string_literals;
  const Outcome outcome = run("G0 X1\nG0\0X2\nG0 X3\n"s);
  REQUIRE(outcome.codes() == std::vector<Code>{Code::bad_character});
  CHECK(outcome.diagnostics.list()[0].span == Span{0, 2, 3, 1});
  CHECK(outcome.diagnostics.list()[0].label == "control character 0x00");
}

TEST_CASE("line ends of CR alone make one line, which is refused") {
  CHECK(run("G0 X1\rG1 Y2 F3\rM2\r").codes() == std::vector<Code>{Code::carriage_return});
  CHECK(run("G0 X1\rX2\r").codes() == std::vector<Code>{Code::carriage_return});
}

TEST_CASE("bytes that are not UTF-8 are refused outside comments and told once inside them") {
  CHECK(only_code("G0 X1 \xD5\n") == Code::bad_character);
  const Outcome outcome = run("(\xE4\xE5\xF2)\n(\xE4)\nG0 X1\n");
  CHECK(outcome.codes() == std::vector<Code>{Code::not_utf8});
  CHECK_FALSE(outcome.diagnostics.has_errors());
}

TEST_CASE("a megabyte of random bytes ends after at most 1000 errors") {
  Random random(seed());
  std::string text(std::size_t{1} << 20, '\0');
  for (char& c : text) c = static_cast<char>(random.below(256));
  const Outcome outcome = run(text);
  CHECK(outcome.diagnostics.has_errors());
  CHECK(outcome.diagnostics.errors() <= 1000);
}
