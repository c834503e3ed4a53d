#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "emulator/scenario/scenario.h"
#include "emulator/text/json.h"
#include "emulator/text/text.h"
#include "machine/base/terminal_text.h"

namespace kadr::scenario {
namespace {

std::size_t failures(const std::vector<ScenarioResult>& results) {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const ScenarioResult& r) { return !r.passed(); }));
}

/// The differences, line by line; empty if there are none.
std::string differences(const ScenarioResult& result) {
  std::string out;
  if (!result.failure.empty()) out += fmt::format("{}\n", displayable(result.failure));
  bool told = !result.failure.empty();
  for (const ScenarioCheck& check : result.checks) {
    if (check.passed) continue;
    out += fmt::format("{}: {}, expected {}\n", displayable(check.what), displayable(check.measured),
                       displayable(check.expected));
    told = told || check.what == "diagnostics";
  }
  // the program's messages explain a refusal; they are noise where a number differs
  if (told) out += result.diagnostics;
  return out;
}

}  // namespace

std::string render_result(const ScenarioResult& result) {
  const auto passed = std::count_if(result.checks.begin(), result.checks.end(),
                                    [](const ScenarioCheck& c) { return c.passed; });
  std::string out =
      fmt::format("{:<7} {:<22} {:>11.3f} s  {} of {} checks\n", result.passed() ? "passed" : "FAILED",
                  displayable(result.name), result.machine_s, passed, result.checks.size());
  const std::string what = differences(result);
  std::size_t at = 0;
  while (at < what.size()) {
    const std::size_t end = what.find('\n', at);
    out += fmt::format("        {}\n", what.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

std::string render_totals(const std::vector<ScenarioResult>& results) {
  const std::size_t failed = failures(results);
  return fmt::format("{} passed, {} failed\n", results.size() - failed, failed);
}

std::string render_junit(const std::vector<ScenarioResult>& results) {
  double total_s = 0;
  for (const ScenarioResult& r : results) total_s += r.machine_s;
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format(
      "<testsuite name=\"kadr scenarios\" tests=\"{}\" failures=\"{}\" errors=\"0\" time=\"{:.6f}\">\n",
      results.size(), failures(results), total_s);
  for (const ScenarioResult& r : results) {
    out += fmt::format("  <testcase classname=\"kadr.scenarios\" name=\"{}\" file=\"{}\" time=\"{:.6f}\"",
                       text::xml_text(displayable(r.name)), text::xml_text(displayable(r.file)), r.machine_s);
    if (r.passed()) {
      out += "/>\n";
      continue;
    }
    const std::string what = differences(r);
    out += fmt::format(">\n    <failure message=\"{}\">{}</failure>\n  </testcase>\n",
                       text::xml_text(what.substr(0, what.find('\n'))), text::xml_text(what));
  }
  return out + "</testsuite>\n";
}

std::string render_json(const std::vector<ScenarioResult>& results) {
  auto list = text::Json::array();
  for (const ScenarioResult& r : results) {
    text::Json item = {
        {"name", r.name}, {"file", r.file}, {"passed", r.passed()}, {"machine_s", r.machine_s}};
    if (!r.failure.empty()) item["failure"] = r.failure;
    auto checks = text::Json::array();
    for (const ScenarioCheck& c : r.checks)
      checks.push_back(
          {{"what", c.what}, {"expected", c.expected}, {"measured", c.measured}, {"passed", c.passed}});
    item["checks"] = std::move(checks);
    list.push_back(std::move(item));
  }
  return text::json_text(list) + '\n';
}

}  // namespace kadr::scenario
