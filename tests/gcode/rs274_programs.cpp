#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rs274_oracle.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

namespace fs = std::filesystem;

constexpr int kTools = 99;
constexpr std::uintmax_t kLargestProgram_bytes = 4 << 20;

std::string program_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> programs_under(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".ngc" &&
        entry.file_size() <= kLargestProgram_bytes)
      paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// NAME.tbl next to NAME.ngc, else a table with most tools that a program may want.
ToolTable tools_of(const fs::path& path) {
  ToolTable table;
  const fs::path beside = fs::path(path).replace_extension(".tbl");
  if (fs::exists(beside)) {
    SourceSet sources;
    Diagnostics diagnostics;
    return read_tool_table(sources, sources.add(SourceText(beside.string(), program_text(beside))),
                           diagnostics);
  }
  for (int number = 1; number <= kTools; ++number) {
    Tool tool;
    tool.number = tool.pocket = number;
    tool.offset[2] = 10 + number;
    tool.diameter_mm = 6;
    table.tools.push_back(tool);
  }
  return table;
}

/// A program with the files of its folder, which it may call.
TestProgram read_lines(const fs::path& path) {
  TestProgram program;
  program.text = program_text(path);
  for (const auto& entry : fs::directory_iterator(path.parent_path())) {
    if (entry.is_regular_file() && entry.path().extension() == ".ngc" && entry.path() != path)
      program.files[entry.path().filename().string()] = program_text(entry.path());
  }
  program.tools = tools_of(path);
  program.diameter_unit_mm = 25.4;  // what rs274 takes where it compensates
  return program;
}

}  // namespace

/// KADR_PROGRAMS names a folder of programs that nobody made for this test, such as the examples of a
/// controller; those that need a machine of their own (remapped codes) are refused by both.
TEST_CASE("the programs of a folder make the same canonical calls as in rs274") {
  const char* folder = std::getenv("KADR_PROGRAMS");
  const std::string rs274 = find_rs274();
  if (folder == nullptr || rs274.empty()) {
    MESSAGE("skipped: KADR_PROGRAMS names no folder, or rs274 is not installed");
    return;
  }
  std::size_t compared = 0, refused = 0, endless = 0, unfinished = 0;
  for (const fs::path& path : programs_under(folder)) {
    const TestProgram program = read_lines(path);
    const Trace other = oracle_trace(rs274, program);
    if (other.no_verdict) {
      ++endless;
      continue;
    }
    // kadr ends such a program where its text ends
    if (other.refusal.find("File ended with no percent sign or program end") != std::string::npos) {
      ++unfinished;
      continue;
    }
    ++compared;
    if (other.refused) ++refused;
    const std::string difference = first_difference(own_trace(program), other);
    CHECK_MESSAGE(difference.empty(), path.string(), ": ", difference);
  }
  CHECK(compared > 0);
  MESSAGE("programs: " << compared << " compared, " << refused << " refused by rs274, " << unfinished
                       << " without M2, " << endless << " that rs274 never ends");
}
