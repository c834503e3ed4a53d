#include <doctest/doctest.h>

#include <string>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

ToolTable table_of(const std::string& text, Diagnostics& diagnostics) {
  SourceSet sources;
  return read_tool_table(sources, sources.add(SourceText("tools.tbl", text)), diagnostics);
}

/// The table of a text without mistakes.
ToolTable table_of(const std::string& text) {
  Diagnostics diagnostics;
  ToolTable table = table_of(text, diagnostics);
  CHECK(diagnostics.list().empty());
  return table;
}

}  // namespace

TEST_CASE("a tool table gives every value of every tool") {
  const ToolTable table = table_of(
      "T1 P17 X1 Y-2 Z+3.5 A4 B5 C6 U7 V8 W9 D10.5 I11 J12 Q9 ;a remark with T2 P3\n"
      "T20 P5 Z.25\n");
  REQUIRE(table.tools.size() == 2);
  const Tool& tool = table.tools[0];
  CHECK(tool.number == 1);
  CHECK(tool.pocket == 17);
  CHECK(tool.offset == AxisValues{1, -2, 3.5, 4, 5, 6, 7, 8, 9});
  CHECK(tool.diameter_mm == 10.5);
  CHECK(tool.front_angle_deg == 11);
  CHECK(tool.back_angle_deg == 12);
  CHECK(tool.orientation == 9);
  CHECK(table.find(20) == &table.tools[1]);
  CHECK(table.find(20)->offset[2] == 0.25);
  CHECK(table.find(2) == nullptr);
}

TEST_CASE("words of a tool table stand in any order, in small letters, apart by blanks and tabs") {
  const ToolTable table =
      table_of("\xEF\xBB\xBF;head\r\n\r\n \t\r\n\tz12.5\tp3  t7 d6\r\n; T9 P9\r\nT8 P4;end");
  REQUIRE(table.tools.size() == 2);
  CHECK(table.tools[0].number == 7);
  CHECK(table.tools[0].pocket == 3);
  CHECK(table.tools[0].offset[2] == 12.5);
  CHECK(table.tools[0].diameter_mm == 6);
  CHECK(table.tools[1].number == 8);
}

TEST_CASE("an empty tool table has no tools and no mistakes") {
  CHECK(table_of("").tools.empty());
  CHECK(table_of("\n;only remarks").tools.empty());
}

TEST_CASE("all mistakes of a tool table are told with their places, the good lines are kept") {
  Diagnostics diagnostics;
  const ToolTable table = table_of("T1 P1 Z1,5 H3\nT2 P2 Z4\nT3 Z5\nT2 P4\n", diagnostics);
  REQUIRE(diagnostics.list().size() == 4);
  CHECK(diagnostics.list()[0].code == Code::tool_table_number);
  CHECK(diagnostics.list()[0].span == Span{0, 1, 7, 4});
  CHECK(diagnostics.list()[1].code == Code::tool_table_word);
  CHECK(diagnostics.list()[1].span == Span{0, 1, 12, 2});
  CHECK(diagnostics.list()[2].code == Code::tool_table_missing);
  CHECK(diagnostics.list()[2].span == Span{0, 3, 1, 5});
  CHECK(diagnostics.list()[3].code == Code::tool_table_tool_twice);
  REQUIRE(table.tools.size() == 1);
  CHECK(table.tools[0].number == 2);
}

TEST_CASE("a file that is no tool table stops after 1000 errors") {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "?\n";
  Diagnostics diagnostics;
  table_of(text, diagnostics);
  CHECK(diagnostics.errors() == 1000);
}

TEST_CASE("a printed tool table reads back as the same table") {
  const std::string text = "T1 P17 X1 Y-2 Z3.0625 A4 W0.1 D10.5 J12 Q9\nT20 P5\n";
  const ToolTable table = table_of(text);
  CHECK(render_tool_table(table) == text);
  CHECK(render_tool_table(table_of("t20 p5 z0 ;remark\n")) == "T20 P5\n");
}

TEST_CASE("random bytes never break the reader of tool tables") {
  Random random(seed());
  const std::string letters = "TPXYZABCDIJQH 0123456789.-+e;\t\n\r,\xC3\xFF";
  for (std::uint64_t i = 0; i < count(300); ++i) {
    std::string text;
    for (std::uint64_t k = random.below(200); k > 0; --k) text += letters[random.below(letters.size())];
    Diagnostics diagnostics;
    const ToolTable table = table_of(text, diagnostics);
    Diagnostics again;
    const std::string printed = render_tool_table(table);
    CHECK(render_tool_table(table_of(printed, again)) == printed);
    CHECK_FALSE(again.has_errors());
  }
}
