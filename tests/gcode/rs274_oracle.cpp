#include "rs274_oracle.h"

#include <doctest/doctest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gcode/interpret/state.h"
#include "rs274_trace.h"

namespace kadr::gcode::test {
namespace {

namespace fs = std::filesystem;

constexpr int kOracleSeconds = 4;
// exit statuses of `timeout`: 124 when the time is over, from 125 when the command could not run or a signal
// ended it
constexpr int kTimedOut = 124;

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "kadr_rs274_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void write_files(const fs::path& folder, const TestProgram& program) {
  std::ofstream(folder / "program.ngc") << program.text;
  for (const auto& [name, text] : program.files) std::ofstream(folder / name) << text;
}

/// The stand-alone rs274 takes the lengths of its table as inches.
std::string oracle_table(const ToolTable& table, double diameter_unit_mm) {
  std::string text;
  for (const Tool& tool : table.tools) {
    text += fmt::format("T{} P{}", tool.number, tool.pocket);
    for (std::size_t axis = 0; axis < kProgramAxes; ++axis) {
      const char letter = kAxisLetters[axis];
      const double offset = tool.offset[axis];
      if (offset == 0) continue;
      text +=
          fmt::format(" {}{:.12f}", letter, is_rotary_letter(letter) ? offset : offset / kMillimetresPerInch);
    }
    text += fmt::format(" D{:.12f} I{:.6f} J{:.6f} Q{}\n", tool.diameter_mm / diameter_unit_mm,
                        tool.front_angle_deg, tool.back_angle_deg, tool.orientation);
  }
  return text;
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

std::string find_rs274() {
  if (const char* named = std::getenv("KADR_RS274")) return named;
  std::istringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    if (fs::exists(fs::path(folder) / "rs274")) return (fs::path(folder) / "rs274").string();
  }
  return {};
}

Trace oracle_trace(const std::string& rs274, const TestProgram& program) {
  const TemporaryFolder folder;
  write_files(folder.path(), program);
  std::ofstream(folder.path() / "tools.tbl") << oracle_table(program.tools, program.diameter_unit_mm);
  std::ofstream(folder.path() / "parameters.var") << "";
  // HOME: rs274 maps its tool table to a file there, which other runs must not share
  // the trace comes by standard output, errors by standard error
  const std::string command = fmt::format(
      "cd '{0}' && HOME='{0}' timeout {1} '{2}' -t tools.tbl -v parameters.var -g program.ngc >out 2>err",
      folder.path().string(), kOracleSeconds, rs274);
  const int status = std::system(command.c_str());
  Trace trace;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  trace.no_verdict = code >= kTimedOut;
  trace.refused = code != 0;
  if (trace.no_verdict) return trace;
  trace.calls = oracle_calls(lines_of(read_text(folder.path() / "out")), program.tools);
  for (const std::string& line : lines_of(read_text(folder.path() / "err"))) {
    if (line != "executing" && line.rfind("link (updating", 0) != 0) trace.refusal += line + "\n";
  }
  return trace;
}

Trace own_trace(const TestProgram& program) {
  const TemporaryFolder folder;
  InterpretOptions options;
  options.tools = program.tools;
  std::string name = "program.ngc";
  if (!program.files.empty()) {
    write_files(folder.path(), program);
    name = (folder.path() / name).string();
  }
  const Outcome outcome = run(program.text, options, name);
  Trace trace;
  trace.calls = own_calls(outcome.blocks);
  trace.refused = outcome.diagnostics.has_errors();
  if (trace.refused) trace.refusal = outcome.rendered;
  for (const Diagnostic& d : outcome.diagnostics.list()) {
    if (d.severity == Severity::error) trace.errors.push_back(d.code);
  }
  return trace;
}

}  // namespace kadr::gcode::test
