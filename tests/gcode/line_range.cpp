#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>

#include "rs274_generator.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

InterpretOptions from(std::uint32_t line, std::optional<std::uint32_t> to = {}) {
  InterpretOptions options;
  options.from_line = line;
  options.to_line = to;
  return options;
}

InterpretOptions until(std::uint32_t line) {
  InterpretOptions options;
  options.to_line = line;
  return options;
}

/// What the error of a program says, and its help: "no block stands on this line | the nearest ...".
std::string told(const std::string& text, const InterpretOptions& options) {
  const Outcome outcome = run(text, options);
  for (const Diagnostic& d : outcome.diagnostics.list())
    if (d.severity == Severity::error) return d.label + " | " + d.help;
  return "nothing";
}

/// The lines of the file that a program's blocks stand on, in their order.
std::vector<std::uint32_t> lines_of(const Outcome& outcome) {
  std::vector<std::uint32_t> lines;
  for (const Block& block : outcome.blocks) lines.push_back(block.span.line);
  return lines;
}

/// All that a block says.
std::string text_of(const Block& block) {
  std::string text = fmt::format("{} ", static_cast<int>(block.kind()));
  append_canon(text, block);
  if (const Move* m = move_of(block))
    text += fmt::format(" {} {} {} {} {} {} {} {}", m->length_u, m->feed_u_s, m->duration_s, m->pitch_u_rev,
                        m->path_tolerance_mm, static_cast<int>(m->path_mode), m->feed_override_enabled,
                        static_cast<int>(m->feed_length));
  return text;
}

/// Where a block leaves the machine.
AxisValues place_after(const Block& block, const AxisValues& before) {
  if (const auto* probe = std::get_if<Probe>(&block.action)) return probe->contact;
  const Move* move = move_of(block);
  return move == nullptr || is<RigidTap>(block) ? before : move->end;
}

bool waits(const Block& block) {
  const auto* digital = std::get_if<DigitalOutput>(&block.action);
  const auto* analog = std::get_if<AnalogOutput>(&block.action);
  return (digital != nullptr && digital->with_motion) || (analog != nullptr && analog->with_motion);
}

}  // namespace

TEST_CASE("a program that is entered at a line has the blocks from there on, and what holds before them") {
  const std::string text =
      "G21 G90 F600 T3 M6\n"  // 1
      "S8000 M3 M8\n"         // 2
      "G0 Z5\n"               // 3
      "G0 X10 Y20\n"          // 4
      "M64 P1\n"              // 5
      "G1 Z-2\n"              // 6
      "X30\n"                 // 7
      "M2\n";
  const Outcome outcome = run(text, from(7));
  const std::vector<std::string> wanted = {
      "SET_FEED_RATE 600.000000",
      "SELECT_TOOL 3",
      "CHANGE_TOOL_NUMBER 3",
      "SET_SPINDLE_SPEED 0 8000.000000",
      "START_SPINDLE_CLOCKWISE 0",
      "FLOOD_ON",
      "SET_DIGITAL 1 on @now",
      "APPROACH 10.000000 20.000000 -2.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 XY Z",
      "STRAIGHT_FEED 30.000000 20.000000 -2.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000"};
  REQUIRE(outcome.trace.size() > wanted.size());
  CHECK(std::vector<std::string>(outcome.trace.begin(),
                                 outcome.trace.begin() + static_cast<std::ptrdiff_t>(wanted.size())) ==
        wanted);
  CHECK(lines_of(outcome)[4] == 2);  // a setting stands on its own line
}

TEST_CASE("settings that are as before the first line are not set again") {
  const Outcome outcome = run("G21 S100 M3\nM8\nM64 P0\nM5 M9\nM65 P0\nM49\nM48\nG0 X1\nM2\n", from(8));
  CHECK(outcome.trace.front() == "SET_SPINDLE_SPEED 0 100.000000");
  CHECK(outcome.trace[1].starts_with("APPROACH"));
}

TEST_CASE("Z is last where the approach goes down, first where it goes up, or as the machine says") {
  const auto ways = [](const std::string& text, std::vector<std::string> groups) {
    InterpretOptions options = from(2);
    options.approach = std::move(groups);
    const Outcome outcome = run(text, options);
    REQUIRE(outcome.all<Approach>().size() == 1);
    return outcome.all<Approach>()[0].ways;
  };
  using Ways = std::vector<std::string>;
  CHECK(ways("G21 G0 X1 Y1 Z-1 A5\nX2\nM2\n", {}) == Ways{"XYA", "Z"});
  CHECK(ways("G21 G0 X1 Y1 Z1\nX2\nM2\n", {}) == Ways{"Z", "XY"});
  CHECK(ways("G21 G0 X1 Z1\nX2\nM2\n", {"XYABCUVW", "Z"}) == Ways{"X", "Z"});
  CHECK(ways("G21 G0 X1 Y1 Z-1\nX2\nM2\n", {"Z", "X", "Y"}) == Ways{"Z", "X", "Y"});
  CHECK(ways("G21 G0 X0\nX2\nM2\n", {}).empty());
}

TEST_CASE("a line in a loop is entered in its first pass, with the loop's count") {
  const std::string text = "G21 G91 F100\no1 repeat [3]\n#1=[#1+1]\nG1 X#1\no1 endrepeat\nM2\n";
  const Outcome outcome = run(text, from(4));
  REQUIRE(outcome.moves().size() == 3);
  CHECK(outcome.moves()[2].end[0] == 6);
  CHECK(run(text, from(2)).moves().size() == 3);
  CHECK(told(text, from(5)) ==
        "o1 endrepeat begins nothing that is run | the nearest lines that can be entered are 4 and 6");
}

TEST_CASE("a program is entered where a call stands, not in the subroutine or a file that is called") {
  const std::string text =
      "G21 F100\n"       // 1
      "o100 sub\n"       // 2
      "G1 X#1\n"         // 3
      "o100 endsub\n"    // 4
      "G1 X1\n"          // 5
      "o100 call [2]\n"  // 6
      "o100 call [3]\n"  // 7
      "M2\n";
  CHECK(lines_of(run(text, from(7))).back() == 8);
  CHECK(run(text, from(7)).moves().size() == 1);
  CHECK(told(text, from(3)) ==
        "it stands in a subroutine, called on line 6 | the nearest lines that can be entered are 1 and 5");
}

TEST_CASE("a program can't be entered inside compensation, a cycle, a NURBS or a thread") {
  CHECK(told("G21 F100\nG41.1 D2 G1 X20\nG1 X40\nG40 G1 X60 Y9\nG1 X80\nM2\n", from(3)) ==
        "cutter compensation has been on since line 2 | the nearest lines that can be entered are 2 and 5");
  const std::string cycle = "G21 F100\nG81 X1 Z-1 R2\nX5\nM8\nG81 X9 Z-1 R2\nG80\nM2\n";
  CHECK(told(cycle, from(3)) ==
        "it repeats the G81 of a line before it | the nearest lines that can be entered are 2 and 4");
  CHECK(told(cycle, from(5)) == "nothing");
  CHECK(told("G21 F100 G1 X0 Y0\nG5.2 X0 Y1 P1\nX2 Y2 P1\nX3 Y0 P1\nG5.3\nG1 X9\nM2\n", from(3)) ==
        "it stands in the middle of the NURBS that begins on line 2 | the nearest lines that can be entered "
        "are "
        "2 and 6");
  const std::string thread = "G21 S100 M3\nG33 Z-5 K1\nG33 Z-9 K1\nG0 X5\nG33 Z0 K1\nM5\nM2\n";
  CHECK(told(thread, from(2)) == "nothing");
  CHECK(
      told(thread, from(3)) ==
      "it goes on with the thread of the move before it | the nearest lines that can be entered are 2 and 4");
  CHECK(told(thread, from(5)) == "nothing");
}

TEST_CASE("a line without a block, one that is never run and one behind the end are told") {
  const std::string text = "G21 F100\n(remark)\n\nG1 X1\no1 if [0]\nG1 X5\no1 endif\nM2\nG1 X9\n";
  CHECK(told(text, from(2)) ==
        "no block stands on this line | the nearest lines that can be entered are 1 and 4");
  CHECK(told(text, from(3)) ==
        "no block stands on this line | the nearest lines that can be entered are 1 and 4");
  CHECK(
      told(text, from(6)) ==
      "the program never comes here; it ends on line 8 | the nearest lines that can be entered are 5 and 8");
  CHECK(told(text, from(9)) ==
        "the program never comes here; it ends on line 8 | the nearest line that can be entered is 8");
  CHECK(told(text, from(10)) ==
        "there is no line 10: this is the last | the nearest line that can be entered is 8");
  CHECK(run(text, from(8)).moves().empty());
  InterpretOptions deleted = from(2);
  deleted.block_delete = true;
  CHECK(told("G21\n/G0 X1\nM2\n", deleted) ==
        "block delete skips this line | the nearest lines that can be entered are 1 and 3");
}

TEST_CASE("a mistake before the entry is told alone") {
  const std::vector<Code> codes = run("G21 F100\nG1 X$\nG0 X1\nM2\n", from(99)).codes();
  CHECK(codes.size() == 1);
  CHECK(std::find(codes.begin(), codes.end(), Code::entry_line) == codes.end());
}

TEST_CASE("a program ends behind a line, the first time that it has been run, and nothing is reset") {
  const std::string text =
      "G21 F100 S9 M3\n"  // 1
      "o100 sub\n"        // 2
      "G1 X#1\n"          // 3
      "G1 X0\n"           // 4
      "o100 endsub\n"     // 5
      "o1 repeat [2]\n"   // 6
      "o100 call [2]\n"   // 7
      "G1 Y1\n"           // 8
      "o1 endrepeat\n"    // 9
      "M2\n";
  const Outcome called = run(text, until(7));
  CHECK(called.moves().size() == 2);
  CHECK(is<ProgramEnd>(called.blocks.back()));
  CHECK(called.blocks.back().span.line == 7);
  CHECK(called.all<SpindleStop>().empty());
  CHECK(called.diagnostics.list().empty());
  CHECK(run(text, until(3)).moves().size() == 1);
  CHECK(run(text, until(8)).moves().size() == 3);
  CHECK(run(text, until(9)).moves().size() == 3);
  CHECK(run(text, until(10)).moves().size() == 6);
  CHECK(run(text, from(8, 8)).moves().size() == 1);
  CHECK(told(text, from(8, 7)) == "it stands before line 8, where the program is entered | ");
  CHECK(told(text, until(11)) == "the program ends here, and has not come to line 11 | ");
  CHECK(told("G21 F100\nG5.2 X0 Y1 P1\nX2 Y2 P1\nX3 Y0 P1\nG5.3\nM2\n", until(3)) ==
        "it stands in the middle of the NURBS that begins on line 2 | ");
  // what compensation holds back is made
  CHECK(run("G21 F100\nG41.1 D2 G1 X20\nG1 X40\nG1 Y50\nM2\n", until(3)).moves().size() == 2);
}

TEST_CASE("a probe before the entry needs the stock plane") {
  const std::string text = "G21 F100 G0 Z5\nG38.2 Z-9\nG10 L20 P1 Z0\nG0 Z1\nM2\n";
  CHECK(only_code(text, from(4)) == Code::entry_probe);
  InterpretOptions options = from(4);
  options.stock = StockPlane{2, -3, true};
  const Outcome outcome = run(text, options);
  CHECK(outcome.diagnostics.list().empty());
  REQUIRE(outcome.all<Approach>().size() == 1);
  CHECK(outcome.all<Approach>()[0].end[2] == -3);
  CHECK(outcome.moves()[0].end[2] == -2);
}

TEST_CASE("an output that waits for a motion at the entry still waits for the first one behind it") {
  const Outcome outcome = run("G21 F100\nM62 P1\nG1 X1\nM62 P2\nG1 X5\nM2\n", from(5));
  const std::vector<DigitalOutput> outputs = outcome.all<DigitalOutput>();
  REQUIRE(outputs.size() == 2);
  CHECK_FALSE(outputs[0].with_motion);
  CHECK(outputs[0].number == 1);
  CHECK(outputs[1].with_motion);
}

TEST_CASE("from the line of its entry on a program has the blocks of a full run") {
  const std::uint64_t programs = count(150);
  std::uint64_t entered = 0, refused = 0;
  for (std::uint64_t i = 0; i < programs; ++i) {
    Random random(seed() * 1000 + i);
    Subjects subjects;
    subjects.offsets = random.chance(0.5), subjects.rotation = random.chance(0.2);
    subjects.machine = random.chance(0.7), subjects.polar = random.chance(0.2);
    subjects.tools = random.chance(0.5), subjects.turning = random.chance(0.2);
    subjects.outputs = random.chance(0.5), subjects.stored = random.chance(0.3);
    subjects.cycles = random.chance(0.4), subjects.splines = random.chance(0.3);
    subjects.threads = random.chance(0.3);
    Generator generator(random, subjects);
    const TestProgram made = generator.program();
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < made.text.size();) {
      const std::size_t end = std::min(made.text.find('\n', at), made.text.size());
      lines.push_back(made.text.substr(at, end - at));
      at = end + 1;
    }
    // a loop around some of its lines, and what holds at its end
    const std::size_t begin = random.below(lines.size()), end = begin + random.below(lines.size() - begin);
    std::string text;
    for (std::size_t l = 0; l + 1 < lines.size(); ++l) {
      if (l == begin) text += "o1 repeat [2]\n";
      text += lines[l] + "\n";
      if (l == std::min(end, lines.size() - 2)) text += "o1 endrepeat\n";
    }
    text +=
        "(DEBUG, #5420 #5421 #5422 #<_feed> #<_rpm> #<_spindle_on> #<_mist> #<_flood> #<_metric> "
        "#<_plane>)\n";
    text += lines.back() + "\n";
    InterpretOptions options;
    options.tools = made.tools;
    const Outcome full = run(text, options);
    if (full.diagnostics.has_errors()) continue;
    const auto last_line = static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n'));
    for (int n = 0; n < 8; ++n) {
      options.from_line = 1 + static_cast<std::uint32_t>(random.below(last_line));
      CAPTURE(text);
      CAPTURE(*options.from_line);
      const Outcome part = run(text, options);
      if (part.diagnostics.has_errors()) {
        ++refused;
        const std::vector<Code> codes = part.codes();
        CHECK(std::count(codes.begin(), codes.end(), Code::entry_line) == 1);
        CHECK(part.diagnostics.errors() == 1);
        continue;
      }
      ++entered;
      const auto approach = std::find_if(part.blocks.begin(), part.blocks.end(),
                                         [](const Block& b) { return is<Approach>(b); });
      REQUIRE(approach != part.blocks.end());
      std::size_t same = 0;
      const auto behind = static_cast<std::size_t>(part.blocks.end() - approach) - 1;
      while (same < behind && same < full.blocks.size() &&
             text_of(part.blocks[part.blocks.size() - 1 - same]) ==
                 text_of(full.blocks[full.blocks.size() - 1 - same]))
        ++same;
      // all but what waits for the next motion
      for (auto block = approach + 1; block != part.blocks.end() - static_cast<std::ptrdiff_t>(same); ++block)
        CHECK(waits(*block));
      AxisValues place{};
      for (std::size_t b = 0; b + same < full.blocks.size(); ++b) {
        place = place_after(full.blocks[b], place);
        CHECK(full.blocks[b].span.line != *options.from_line);
      }
      CHECK(std::get<Approach>(approach->action).end == place);
    }
  }
  MESSAGE(entered, " entered, ", refused, " refused");
  CHECK(entered > programs);
}
