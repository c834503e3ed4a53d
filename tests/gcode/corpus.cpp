#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rs274_oracle.h"
#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

/// Short programs, one for each thing that the dialect can do; the name says which. Beside NAME.ngc stand
/// NAME.tbl, its tool table where it needs one, and NAME.canon, its trace, written with KADR_REGENERATE=1 and
/// read by a person. A name that ends in "_refused" is that of a program with an error. What is called from
/// files lies in subs/.
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(KADR_SOURCE_DIR) / "tests/gcode/corpus";
const std::string kHead = "# written by test_gcode with KADR_REGENERATE=1\n";
/// First words of a program that rs274 does not run as kadr does, and why not.
const std::string kBeyond = "(beyond rs274: ";

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> programs() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    if (entry.path().extension() == ".ngc") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// A program of the corpus with its table and the files that it may call.
TestProgram read_program(const fs::path& path) {
  TestProgram program;
  program.text = contents(path);
  const fs::path table = fs::path(path).replace_extension(".tbl");
  if (fs::exists(table)) {
    SourceSet sources;
    Diagnostics diagnostics;
    const std::uint32_t file = sources.add(SourceText(table.filename().string(), contents(table)));
    program.tools = read_tool_table(sources, file, diagnostics);
    REQUIRE_FALSE(diagnostics.has_errors());
  }
  for (const auto& entry : fs::directory_iterator(kCorpus / "subs"))
    program.files[entry.path().filename().string()] = contents(entry.path());
  return program;
}

std::string trace_of(const fs::path& path, const TestProgram& program) {
  InterpretOptions options;
  options.tools = program.tools;
  options.sub_folders = {(kCorpus / "subs").string()};
  std::string text = kHead;
  SourceSet sources;
  Diagnostics diagnostics;
  const std::uint32_t file = sources.add(SourceText(path.string(), program.text));
  interpret(
      sources, file, options,
      [&](const Block& block) {
        const std::size_t before = text.size();
        append_canon(text, block);
        if (text.size() != before) text += '\n';
      },
      diagnostics);
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity == Severity::error) text += fmt::format("ERROR {} {}\n", d.span.line, code_name(d.code));
  }
  return text;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

TEST_CASE("each program of the corpus has the trace that stands beside it") {
  REQUIRE(programs().size() > 20);
  for (const fs::path& path : programs()) {
    CAPTURE(path.stem().string());
    const std::string trace = trace_of(path, read_program(path));
    const fs::path golden = fs::path(path).replace_extension(".canon");
    if (std::getenv("KADR_REGENERATE") != nullptr) std::ofstream(golden, std::ios::binary) << trace;
    CHECK(trace == contents(golden));
    const bool refused = trace.find("\nERROR ") != std::string::npos;
    CHECK(refused == ends_with(path.stem().string(), "_refused"));
  }
}

TEST_CASE("each program of the corpus has the calls that rs274 makes of it") {
  const std::string rs274 = find_rs274();
  if (rs274.empty()) {
    MESSAGE("skipped: rs274 (package linuxcnc-uspace) is not installed; KADR_RS274 may name it");
    return;
  }
  std::size_t compared = 0, beyond = 0;
  for (const fs::path& path : programs()) {
    const TestProgram program = read_program(path);
    if (program.text.rfind(kBeyond, 0) == 0) {
      ++beyond;
      continue;
    }
    ++compared;
    const Trace other = oracle_trace(rs274, program);
    CHECK_MESSAGE(other.refused == ends_with(path.stem().string(), "_refused"), path.stem().string());
    const std::string difference = first_difference(own_trace(program), other);
    CHECK_MESSAGE(difference.empty(), path.stem().string(), ": ", difference);
  }
  MESSAGE("corpus: " << compared << " programs compared, " << beyond << " beyond rs274");
}
