#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

/// A row of the table in docs/gcode.md: | grbl | `X10` | runs | ... |
struct DialectRow {
  std::string dialect, program, reading;
};

/// The cell from `at` on, without blanks and ` around it; `at` moves behind it.
std::string cell_of(const std::string& line, std::size_t& at) {
  const std::size_t end = line.find(" |", at);
  std::string cell = line.substr(at, end - at);
  at = end + 3;
  if (cell.size() > 1 && cell.front() == '`') cell = cell.substr(1, cell.size() - 2);
  return cell;
}

std::vector<DialectRow> dialect_rows() {
  std::ifstream in(std::filesystem::path(KADR_SOURCE_DIR) / "docs/gcode.md");
  std::vector<DialectRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("| ", 0) != 0) continue;
    std::size_t at = 2;
    DialectRow row;
    row.dialect = cell_of(line, at);
    if (!kDialects.find(row.dialect)) continue;
    row.program = cell_of(line, at);
    row.reading = cell_of(line, at);
    for (std::size_t n = row.program.find("\\n"); n != std::string::npos; n = row.program.find("\\n"))
      row.program.replace(n, 2, "\n");
    rows.push_back(row);
  }
  return rows;
}

/// "runs" without any message, "told" by notes alone, "refused" by an error.
std::string reading_of(const Outcome& outcome) {
  if (outcome.diagnostics.has_errors()) return "refused";
  if (outcome.diagnostics.warnings() > 0) return "warned of";
  return outcome.diagnostics.list().empty() ? "runs" : "told";
}

}  // namespace

TEST_CASE("docs/gcode.md: each row of the table of dialects is read as it says") {
  std::set<std::string> dialects;
  const std::vector<DialectRow> rows = dialect_rows();
  REQUIRE(rows.size() > 40);
  for (const DialectRow& row : rows) {
    InterpretOptions options;
    options.dialect = *kDialects.find(row.dialect);
    options.axis_letters = "XYZ";
    const Outcome outcome = run(row.program + "\n", options);
    CAPTURE(row.dialect);
    CAPTURE(row.program);
    CAPTURE(outcome.rendered);
    CHECK(reading_of(outcome) == row.reading);
    dialects.insert(row.dialect);
  }
  CHECK(dialects.size() == kDialects.strings().size() - 1);
}
