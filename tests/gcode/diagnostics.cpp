#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "gcode/read/report.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

const std::filesystem::path kBad = std::filesystem::path(KADR_SOURCE_DIR) / "tests/bad/gcode";
const std::string kGoldenHead = "# written by test_gcode with KADR_REGENERATE=1\n";

std::string golden_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> bad_programs() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(kBad)) {
    const auto extension = entry.path().extension();
    if (extension == ".ngc" || extension == ".tbl" || extension == ".ini") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// The machine that the bad programs are read for: a mill with a turntable, a bound on blocks.
InterpretOptions small_machine() {
  InterpretOptions options;
  options.axis_letters = "XYZC";
  options.bounds.blocks = 50;
  options.bounds.loop_passes = 1000;
  return options;
}

machine::OwnerCode owner_call(char letter, int number, const char* sub) {
  machine::OwnerCode own;
  own.code = {letter, number, {}};
  own.call = sub;
  return own;
}

/// The bounds on sizes are small where a program is to exceed them.
InterpretOptions machine_for(const std::string& program) {
  InterpretOptions options = small_machine();
  if (program.find("_stock.") != std::string::npos) options.stock = StockPlane{2, -5, true};
  if (program.rfind("K1042", 0) == 0) options.bounds.file_bytes = 64;
  if (program.rfind("K1043", 0) == 0) options.bounds.line_bytes = 64;
  if (program.rfind("K1044", 0) == 0) options.bounds.lines = 50;
  if (program.rfind("K1302", 0) == 0) options.bounds.messages = 10;
  if (program.rfind("K105", 0) == 0) options.dialect = Dialect::fanuc;  // macro B
  if (program.rfind("K1125", 0) == 0) options.units_said = false;
  if (program.rfind("K1128", 0) == 0) options.startup = "G18 G64 P0.1 X5 M3 G28";
  // where they are entered or left
  const std::size_t range = program.find("_line_");
  const auto line = [&] { return static_cast<std::uint32_t>(std::stoul(program.substr(range + 6))); };
  if (program.rfind("K1070", 0) == 0 || program.rfind("K1072", 0) == 0) options.from_line = line();
  if (program.rfind("K1071", 0) == 0) options.to_line = line();
  if (program.rfind("K1140", 0) == 0) options.ignored = {{'M', 31, {}}, {'M', 42, {}}, {'G', 1870, {}}};
  if (program.rfind("K1141", 0) == 0) options.ignored = {{'M', 8, {}}, {'G', 10, {}}};
  if (program.rfind("K1142", 0) == 0) options.codes.own = {owner_call('M', 150, "clamp")};
  for (const auto& dialect : kDialects)
    if (program.find(fmt::format("_{}.", dialect.word)) != std::string::npos) options.dialect = dialect.value;
  static const MemoryTexts two_subs = [] {
    MemoryTexts texts;
    texts.put("a", "o<a> sub\no<a> endsub\no<b> sub\no<b> endsub\n");
    return texts;
  }();
  if (program.rfind("K1045", 0) == 0) options.called_files = &two_subs;
  return options;
}

/// The tools of NAME.tools next to a bad program NAME.ngc.
std::optional<ToolTable> tools_beside(std::filesystem::path path) {
  path.replace_extension(".tools");
  if (!std::filesystem::exists(path)) return std::nullopt;
  SourceSet sources;
  Diagnostics diagnostics;
  return read_tool_table(sources, sources.add(SourceText("tools", golden_text(path))), diagnostics);
}

/// A program, or a tool table or INI file alone.
Outcome outcome_of(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (path.extension() == ".ngc") {
    InterpretOptions options = machine_for(name);
    options.tools = tools_beside(path);
    return run(golden_text(path), options, name);
  }
  Outcome outcome;
  SourceSet sources;
  const std::uint32_t file = sources.add(SourceText(name, golden_text(path)));
  if (path.extension() == ".ini") {
    read_ini_file(sources, file, outcome.diagnostics);
  } else {
    read_tool_table(sources, file, outcome.diagnostics);
  }
  for (const Diagnostic& d : outcome.diagnostics.list()) outcome.rendered += render_human(d, sources);
  return outcome;
}

}  // namespace

TEST_CASE("each bad program is told in the words of its golden text") {
  REQUIRE(bad_programs().size() > 40);
  for (const auto& path : bad_programs()) {
    const std::string rendered = kGoldenHead + outcome_of(path).rendered;
    auto golden = path;
    golden.replace_extension(".txt");
    if (std::getenv("KADR_REGENERATE") != nullptr) std::ofstream(golden, std::ios::binary) << rendered;
    CAPTURE(path.string());
    CHECK(rendered == golden_text(golden));
  }
}

TEST_CASE("a bad program is told under the code that begins its name, and every code has a bad program") {
  std::set<std::string> seen;
  for (const auto& path : bad_programs()) {
    const std::string name = path.filename().string();
    const Outcome outcome = outcome_of(path);
    seen.insert(name.substr(0, 5));
    if (name[0] != 'K') continue;
    CAPTURE(name);
    REQUIRE_FALSE(outcome.diagnostics.list().empty());
    const std::vector<Code> codes = outcome.codes();
    CHECK(std::any_of(codes.begin(), codes.end(), [&](Code c) { return code_name(c) == name.substr(0, 5); }));
  }
  for (const CodeEntry& entry : all_codes()) {
    const std::string name = code_name(entry.code);
    // a thousand errors need a test of their own
    if ((name[1] != '1' && name[1] != '2') || entry.code == Code::too_many_errors) continue;
    CAPTURE(name);
    CHECK(seen.count(name) == 1);
  }
}

TEST_CASE("six mistakes in one program give exactly six diagnostics") {
  const Outcome outcome = run(golden_text(kBad / "six_mistakes.ngc"), small_machine());
  CHECK(outcome.codes() == std::vector<Code>{Code::word_not_run, Code::bad_number, Code::arc_end_off_circle,
                                             Code::axis_not_on_machine, Code::decimal_comma,
                                             Code::word_unused});
}

TEST_CASE("a mistake is told once, not again by what depends on it") {
  // the position is unknown after the broken line, so the arc is not judged
  CHECK(only_code("F1 G1 X10 Y1.2.3\nG2 X20 I5\n") == Code::bad_number);
  // ... until the axes are given again
  CHECK(run("F1 G1 X1.2.3\nG1 X0 Y0\nG2 X20 I5\n").codes() ==
        std::vector<Code>{Code::bad_number, Code::arc_end_off_circle});
  // the cycle that is not run leaves no motion behind, its hole positions are not errors
  CHECK(only_code("F1\nG87 X1 Y1 Z-1 R1\nX2\nX3\nG80\n") == Code::word_not_run);
  // a failed setting is not blamed on its readers
  CHECK(only_code("#1=[1/0]\n#2=[1/#1]\nG0 X[SQRT[#1-5]]\n") == Code::division_by_zero);
  // the feed stood on the broken line
  CHECK(only_code("G1 X1 F1,5\nX2\nX3\n") == Code::decimal_comma);
  // G20 of a refused line still holds
  const Outcome outcome = run("G20 G99\nG0 X1\n");
  CHECK(outcome.moves()[0].end[0] == 25.4);
}

TEST_CASE("a line with a mistake keeps its plain end point for the lines after it") {
  CHECK(only_code("F1 G1 X10 P3\nG2 X20 I5\n") == Code::word_unused);
}

TEST_CASE("a file of nothing but mistakes stops after 1000 errors with a note") {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "G1 X\n";
  const Outcome outcome = run(text);
  CHECK(outcome.diagnostics.errors() == 1000);
  CHECK(outcome.diagnostics.list().size() == 1001);
  CHECK(outcome.diagnostics.list().back().code == Code::too_many_errors);
  CHECK(outcome.diagnostics.list().back().severity == Severity::note);
}

TEST_CASE("any number of warnings is counted, a thousand shown") {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "G4 P200\n";
  const Outcome outcome = run(text);
  CHECK_FALSE(outcome.diagnostics.has_errors());
  CHECK(outcome.diagnostics.warnings() == 3000);
  CHECK(outcome.diagnostics.list().size() == 1001);
  CHECK(outcome.diagnostics.list().back().label == "2000 more warnings are not shown");
}

TEST_CASE("the bound on blocks ends the program with an error") {
  InterpretOptions options;
  options.bounds.blocks = 3;
  const Outcome outcome = run("G0 X1\nX2\nX3\nX4\nX5\n", options);
  CHECK(outcome.blocks.size() == 3);
  CHECK(outcome.codes() == std::vector<Code>{Code::too_many_blocks});
}

TEST_CASE("a diagnostic carries the calls in force, and of very many both halves") {
  Diagnostics diagnostics;
  Report report(diagnostics);
  std::vector<Span> chain = {{0, 10, 1, 5}, {0, 20, 1, 5}};
  report.error(problem(Code::division_by_zero, {0, 1, 1, 1}, ""));
  report.set_call_chain(&chain);
  report.error(problem(Code::division_by_zero, {0, 2, 1, 1}, ""));
  for (std::uint32_t line = 30; chain.size() < 100; ++line) chain.push_back({0, line, 1, 5});
  report.warning(problem(Code::word_shared, {0, 3, 1, 1}, ""));
  chain.clear();
  report.error(problem(Code::division_by_zero, {0, 4, 1, 1}, ""));
  const auto& list = diagnostics.list();
  REQUIRE(list.size() == 4);
  CHECK(list[0].calls.empty());
  CHECK(list[1].calls == std::vector<Span>{{0, 20, 1, 5}, {0, 10, 1, 5}});
  CHECK(list[1].calls_left_out == 0);
  // 100 calls: lines 10, 20, 30 .. 127; the innermost 32 are 127 .. 96, the outermost end with 20, 10
  REQUIRE(list[2].calls.size() == Report::kMaxCalls);
  CHECK(list[2].calls_left_out == 36);
  CHECK(list[2].calls[0].line == 127);
  CHECK(list[2].calls[31].line == 96);
  CHECK(list[2].calls[32].line == 59);
  CHECK(list[2].calls[63].line == 10);
  CHECK(list[3].calls.empty());
}

TEST_CASE("a mistake that a line makes on every pass is told once and found every time") {
  Diagnostics diagnostics;
  Report report(diagnostics);
  for (int pass = 0; pass < 5000; ++pass) {
    report.error(problem(Code::division_by_zero, {0, 7, 3, 1}, ""));
    report.warning(problem(Code::word_shared, {0, 7, 3, 1}, ""));
  }
  report.error(problem(Code::division_by_zero, {0, 7, 9, 1}, "another place"));
  CHECK(report.errors() == 5001);
  CHECK_FALSE(report.full());
  CHECK(diagnostics.errors() == 2);
  CHECK(diagnostics.warnings() == 1);
}
