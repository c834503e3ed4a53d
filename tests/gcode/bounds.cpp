#include <doctest/doctest.h>

#include <fstream>
#include <regex>
#include <string>

#include <fmt/format.h>

#include "gcode/read/report.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// The bounds with names, all others removed.
InterpretOptions bounded(std::initializer_list<std::pair<std::string_view, std::uint64_t>> bounds) {
  InterpretOptions options;
  for (const BoundEntry& entry : bound_entries()) set_bound(options.bounds, entry.name, 0);
  for (const auto& [name, value] : bounds) REQUIRE(set_bound(options.bounds, name, value));
  return options;
}

/// Subs that call the next one twice: 2^(n-1) calls of the last.
std::string doubled_calls(int n) {
  std::string text;
  for (int i = 1; i < n; ++i) text += fmt::format("O{0} sub\nO{1} call\nO{1} call\nO{0} endsub\n", i, i + 1);
  return text + fmt::format("O{0} sub\nO{0} endsub\nO1 call\nM2\n", n);
}

void check_ends(const std::string& text, const InterpretOptions& options, Code code,
                const std::string& allowed) {
  CAPTURE(text.substr(0, 100));
  const Outcome outcome = run(text, options);
  CHECK(outcome.codes() == std::vector<Code>{code});
  CHECK(outcome.rendered.find("allowed: " + allowed) != std::string::npos);
}

}  // namespace

TEST_CASE("whatever a program repeats ends at one bound by its name") {
  const InterpretOptions lines = bounded({{"lines", 10'000}});
  const std::string allowed = "10000 (--limit lines=N)";
  check_ends(doubled_calls(60), lines, Code::too_many_lines, allowed);
  check_ends("M98 P1 L10000\nM2\nO1\nM98 P2 L10000\nM99\nO2\nM98 P3 L10000\nM99\nO3\nM99\n", lines,
             Code::too_many_lines, allowed);
  check_ends("O1 while [1]\nO1 endwhile\nM2\n", lines, Code::too_many_lines, allowed);
  check_ends("O1 do\n#1=1\nO1 while [1]\nM2\n", lines, Code::too_many_lines, allowed);
  check_ends("O1 repeat [1000000000]\nO1 endrepeat\nM2\n", lines, Code::too_many_lines, allowed);
  // a long line takes as long as many short ones
  check_ends("O1 repeat [100]\n#1=1(" + std::string(256'000, 'x') + ")\nO1 endrepeat\nM2\n", lines,
             Code::too_many_lines, allowed);
  // every elseif is a line run
  std::string branches = "O1 repeat [100]\nO2 if [0]\n";
  for (int i = 0; i < 1000; ++i) branches += "O2 elseif [0]\n";
  check_ends(branches + "O2 endif\nO1 endrepeat\nM2\n", lines, Code::too_many_lines, allowed);

  const InterpretOptions blocks = bounded({{"blocks", 100}});
  const std::string allowed_blocks = "100 (--limit blocks=N)";
  for (const char* body : {"G0 X1", "G4 P1", "M8", "(MSG,x)", "M62 P1", "G83 X1 Z-9 R1 Q1 F9"}) {
    CAPTURE(body);
    check_ends(fmt::format("O1 while [1]\n{}\nO1 endwhile\nM2\n", body), blocks, Code::too_many_blocks,
               allowed_blocks);
  }
  check_ends("F9 G83 X1 Z-900 R1 Q.001\nM2\n", blocks, Code::too_many_blocks, allowed_blocks);
  check_ends("F9 G5.2 X1 Y1 P1\nO1 while [1]\nX2 Y2 P1\nO1 endwhile\nG5.3\nM2\n", blocks,
             Code::too_many_blocks, allowed_blocks);
  // what compensation holds back counts as well
  check_ends("F9 G41.1 D1 G1 X9\nO1 while [1]\nZ1\nZ2\nO1 endwhile\nG40 X0\nM2\n", blocks,
             Code::too_many_blocks, allowed_blocks);

  const InterpretOptions messages = bounded({{"messages", 100}});
  for (const char* body : {"(MSG,x)", "(DEBUG,x)", "(PRINT,x)"})
    check_ends(fmt::format("O1 while [1]\n{}\nO1 endwhile\nM2\n", body), messages, Code::too_many_messages,
               "100 (--limit messages=N)");
  // one of 25 601 bytes is 101
  const auto once = [](int bytes) {
    return "O1 repeat [1]\n(MSG," + std::string(static_cast<std::size_t>(bytes), 'x') +
           ")\nO1 endrepeat\nM2\n";
  };
  check_ends(once(25'601), messages, Code::too_many_messages, "100 (--limit messages=N)");
  CHECK(run(once(25'600), messages).codes().empty());
}

TEST_CASE("the order of a NURBS has a bound, and points on one spot need no more time than others") {
  std::string points;
  for (int i = 0; i < 499; ++i) points += fmt::format("X{} Y{} P1\n", i * 37 % 91, i * 53 % 89);
  const auto of_order = [&](int order) { return fmt::format("F9 G5.2 P1 L{}\n{}G5.3\nM2\n", order, points); };
  check_ends(of_order(500), {}, Code::word_out_of_range, "16 (--limit nurbs_order=N)");
  check_ends(of_order(17), {}, Code::word_out_of_range, "16 (--limit nurbs_order=N)");
  CHECK(run(of_order(16)).codes().empty());
  CHECK(run(of_order(17), bounded({{"nurbs_order", 17}})).codes().empty());
  CHECK(run(of_order(18), bounded({})).codes().empty());
  // its length is rounding and nothing else: halving finds no end by itself
  CHECK(run("F9 G0 X1.1 Y1.3\nG5.2 P1 L4\nX1.1 Y1.3 P2\nX1.1 Y1.3 P.7\nX1.1 Y1.3 P.3\nG5.3\nM2\n")
            .codes()
            .empty());
}

TEST_CASE("under the defaults every program ends, and one of many lines that run once is let through") {
  const ReadingBounds defaults;
  for (const std::uint64_t bound :
       {defaults.lines, defaults.messages, defaults.loop_passes, defaults.file_bytes,
        std::uint64_t{defaults.call_depth}, std::uint64_t{defaults.line_bytes}})
    CHECK(bound > 0);
  // blocks: with the lines of the text
  InterpretOptions options = bounded({});
  options.bounds.blocks.reset();
  SourceSet sources;
  Diagnostics diagnostics;
  std::uint64_t blocks = 0;
  const auto file = sources.add(SourceText("p.ngc", "G0 X1\nF1000 G83 X1 Z-900 R0 Q.001\nX2\nX3\nX4\nM2\n"));
  interpret(
      sources, file, options, [&](const Block&) { ++blocks; }, diagnostics);
  CHECK(blocks == ReadingBounds::kBlocks + 7 * ReadingBounds::kBlocksOfLine);
  REQUIRE(diagnostics.list().size() == 1);
  CHECK(diagnostics.list().front().code == Code::too_many_blocks);
  CHECK(render_human(diagnostics.list().front(), sources)
            .find("3000000 and 16 for each line of the text (--limit blocks=N)") != std::string::npos);
  // neither lines that run once are counted, nor their messages
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "G0 X1 (MSG,x)\n";
  CHECK(run(text + "M2\n", bounded({{"lines", 10}, {"messages", 10}})).codes().empty());
  // and each of them may be a cycle of some moves
  constexpr std::uint64_t kHoles = 250'000;
  text = "F100 G83 X1 Z-.5 R0 Q.1\n";
  for (std::uint64_t i = 0; i < kHoles; ++i) text += i % 2 == 0 ? "X2\n" : "X1\n";
  SourceSet plate;
  Diagnostics none;
  blocks = 0;
  const auto holes = plate.add(SourceText("p.ngc", text + "M2\n"));
  interpret(
      plate, holes, options, [&](const Block&) { ++blocks; }, none);
  CHECK(none.list().empty());
  CHECK(blocks > ReadingBounds::kBlocks + kHoles);
}

TEST_CASE("80 kB of open subs gather no more errors than are shown") {
  for (const char* line :
       {"O1 sub\n", "O1 if [1]\n", "O1 endsub\n", "O1 return\n", "O1 break\n", "O1 else\n"}) {
    CAPTURE(line);
    std::string text;
    for (int i = 0; i < 10'000; ++i) text += line;
    const Outcome outcome = run(text);
    CHECK(outcome.diagnostics.errors() <= Report::kMaxErrors);
    CHECK(outcome.diagnostics.errors() >= 1);
  }
}

TEST_CASE("an error that quotes a name of a megabyte keeps little of it") {
  const Outcome outcome = run("G0 X#<" + std::string(1'000'000, 'a') + ">\nM2\n");
  REQUIRE(outcome.diagnostics.list().size() == 1);
  CHECK(outcome.diagnostics.list().front().label.size() < 5000);
}

TEST_CASE("docs/gcode.md lists every bound of programs with its default, and no other") {
  std::ifstream page(KADR_SOURCE_DIR "/docs/gcode.md");
  std::string line, table, expected;
  for (bool inside = false; std::getline(page, line);) {
    if (line.starts_with("| NAME |")) inside = true;
    if (inside && line.empty()) break;
    // the log's bound is no bound of programs
    if (inside && !line.starts_with("| NAME |") && !line.starts_with("|---") &&
        !line.starts_with("| log_bytes |"))
      table += line + "\n";
  }
  for (const BoundEntry& entry : bound_entries())
    expected += fmt::format("| {} | {} | {} |\n", entry.name, entry.normal, entry.bounds);
  CHECK(table == expected);
}
