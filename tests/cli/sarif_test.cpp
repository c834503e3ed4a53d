#include <doctest/doctest.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "emulator/text/sarif.h"
#include "machine/base/utf8.h"
#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

bool is_text(const Json& holder, const char* key) {
  return holder.contains(key) && holder[key].contains("text") && holder[key]["text"].is_string() &&
         !holder[key]["text"].get<std::string>().empty();
}

/// A URI reference: no blank, no byte that would have to be escaped.
bool is_uri(const std::string& text) {
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::string("-._~:/?#@!$&'()*+,;=%").find(c) > 99)
      return false;
  return !text.empty();
}

void check_location(const Json& location) {
  const Json& physical = location.at("physicalLocation");
  CHECK(is_uri(physical.at("artifactLocation").at("uri").get<std::string>()));
  const Json& region = physical.at("region");
  CHECK(region.at("startLine").get<int>() >= 1);
  CHECK(region.at("startColumn").get<int>() >= 1);
  CHECK(region.at("endColumn").get<int>() >= region.at("startColumn").get<int>());
  CHECK(region.at("snippet").at("text").is_string());
  CHECK(physical.at("contextRegion").at("startLine") == region.at("startLine"));
}

void check_result(const Json& result, const Json& rules) {
  const std::string id = result.at("ruleId");
  CHECK(rules.at(result.at("ruleIndex").get<std::size_t>()).at("id") == id);
  const std::string level = result.at("level");
  CHECK((level == "error" || level == "warning" || level == "note"));
  CHECK(is_text(result, "message"));
  for (const Json& location : result.at("locations")) check_location(location);
  if (!result.at("locations").empty())
    CHECK(result.at("partialFingerprints").at("primaryLocationLineHash").is_string());
  if (!result.contains("relatedLocations")) return;
  std::set<int> ids;
  for (const Json& related : result["relatedLocations"]) {
    check_location(related);
    CHECK(is_text(related, "message"));
    CHECK(ids.insert(related.at("id").get<int>()).second);
  }
  for (const Json& stack : result.at("stacks"))
    for (const Json& frame : stack.at("frames")) check_location(frame.at("location"));
}

/// Requirements of the schema of SARIF 2.1.0 for the objects that kadr writes, and further ones of code hosts.
void check_document(const Json& j) {
  CHECK(j.at("version") == "2.1.0");
  CHECK(j.at("$schema").get<std::string>().find("sarif-2.1.0") != std::string::npos);
  REQUIRE(j.at("runs").size() == 1);
  const Json& run = j["runs"][0];
  const Json& driver = run.at("tool").at("driver");
  CHECK(driver.at("name") == "kadr");
  CHECK(driver.at("version").is_string());
  CHECK(run.at("columnKind") == "unicodeCodePoints");
  CHECK(run.at("invocations").at(0).at("executionSuccessful").is_boolean());
  std::set<std::string> ids;
  for (const Json& rule : driver.at("rules")) {
    CHECK(ids.insert(rule.at("id").get<std::string>()).second);
    CHECK(rule.at("name").get<std::string>().find('_') == std::string::npos);
    CHECK(is_text(rule, "shortDescription"));
    CHECK(is_text(rule, "fullDescription"));
    CHECK(is_text(rule, "help"));
  }
  std::set<std::string> used;
  bool errors_over = false;
  for (const Json& result : run.at("results")) {
    check_result(result, driver["rules"]);
    used.insert(result["ruleId"].get<std::string>());
    if (result["level"] != "error") errors_over = true;
    if (errors_over) CHECK(result["level"] != "error");
  }
  CHECK(used == ids);
}

}  // namespace

TEST_CASE("kadr check --format sarif is one document for all programs, errors first, the same each time") {
  const Scratch scratch;
  // line 2 passes by tolerance only: a warning before the errors of the other program
  scratch.write("a b.ngc", "G21 G90 G0 X10 Y0\nG2 X-10.02 I-10 F500\nM2\n");
  scratch.write("six.ngc", test::kSixMistakes);
  const std::vector<std::string> arguments = {"check", "a b.ngc", "six.ngc", "--format", "sarif"};
  const Finished check = call(arguments, scratch.path());
  CHECK(check.code == 1);
  CHECK(check.err.empty());
  const Json j = Json::parse(check.out);
  check_document(j);
  const Json& results = j["runs"][0]["results"];
  REQUIRE(results.size() == 7);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(results[i]["level"] == "error");
    CHECK(results[i]["locations"][0]["physicalLocation"]["region"]["startLine"] == i + 3);
  }
  CHECK(results[6]["level"] == "warning");
  CHECK(results[6]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "a%20b.ngc");
  CHECK(j["runs"][0]["invocations"][0]["exitCode"] == 1);
  CHECK(call(arguments, scratch.path()).out == check.out);
}

TEST_CASE("--format sarif of the other commands goes to standard error, alone there") {
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  scratch.write("square.ngc", test::kSquare);
  for (const std::string command : {"run", "plan", "canon"}) {
    CAPTURE(command);
    const Finished bad = call({command, "six.ngc", "--format", "sarif"}, scratch.path());
    CHECK(bad.code == 1);
    const Json j = Json::parse(bad.err);
    check_document(j);
    CHECK(j["runs"][0]["results"].size() == 6);
    // a program without mistakes: a document without results
    const Finished good = call({command, "square.ngc", "--format", "sarif"}, scratch.path());
    CHECK(good.code == 0);
    const Json empty = Json::parse(good.err);
    check_document(empty);
    CHECK(empty["runs"][0]["results"].empty());
  }
}

TEST_CASE("SARIF shows all diagnostics unless --max-errors says a number") {
  const Scratch scratch;
  std::string text;
  for (int i = 0; i < 50; ++i) text += "G0 X1 X2\n";
  scratch.write("many.ngc", text);
  const auto results = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"check", "many.ngc", "--format", "sarif"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Json::parse(call(arguments, scratch.path()).out)["runs"][0]["results"];
  };
  const Json all = results({});
  CHECK(all.size() == 50);
  // equal lines have different fingerprints
  std::set<std::string> fingerprints;
  for (const Json& result : all)
    fingerprints.insert(result["partialFingerprints"]["primaryLocationLineHash"].get<std::string>());
  CHECK(fingerprints.size() == 50);
  // and how many are not shown
  const Json seven = results({"--max-errors", "7"});
  REQUIRE(seven.size() == 8);
  CHECK(seven[7]["level"] == "note");
  CHECK(
      kadr::test::contains(seven[7]["message"]["text"].get<std::string>(), "43 more diagnostics not shown"));
}

TEST_CASE("the fingerprint of a mistake stays when lines are put before it") {
  const Scratch scratch;
  const auto fingerprint = [&](const std::string& text) {
    scratch.write("p.ngc", text);
    const Json j = Json::parse(call({"check", "p.ngc", "--format", "sarif"}, scratch.path()).out);
    return j["runs"][0]["results"][0]["partialFingerprints"]["primaryLocationLineHash"].get<std::string>();
  };
  const std::string plain = fingerprint("G0 X1\nG999 X2\n");
  CHECK(fingerprint("(head)\nG0 X1\n\nG999 X2\r\n") == plain);
  CHECK(fingerprint("G0 X1\nG999 X3\n") != plain);
}

TEST_CASE("a mistake inside a subroutine is a result with a stack, its columns in code points") {
  using namespace kadr;
  SourceSet sources;
  const auto part = sources.add(SourceText("/work shop/parts/part.ngc", "(деталь) O<bore> call [5]\n"));
  const auto sub = sources.add(SourceText("/elsewhere/bore.ngc", "O<bore> sub\nG0 X[1/0]\nO<bore> endsub\n"));
  Diagnostic d{Code::division_by_zero, Severity::error, {sub, 2, 6, 3}, "", "label", {"note"}, "help"};
  // "(деталь) " is 9 code points and 15 bytes
  d.calls = {{part, 1, 16, 16}};
  text::SarifLog log("/work shop");
  log.add(d, sources);
  const Json j = Json::parse(text::json_text(log.document(1)));
  check_document(j);
  const Json& result = j["runs"][0]["results"][0];
  CHECK(result["message"]["text"] == "a division by zero: label\nnote\nhelp: help");
  const Json& at = result["locations"][0]["physicalLocation"];
  CHECK(at["artifactLocation"]["uri"] == "file:///elsewhere/bore.ngc");
  CHECK(at["region"]["snippet"]["text"] == "1/0");
  CHECK(at["contextRegion"]["snippet"]["text"] == "G0 X[1/0]");
  const Json& called = result["relatedLocations"][0]["physicalLocation"];
  CHECK(called["artifactLocation"]["uri"] == "parts/part.ngc");
  CHECK(called["region"]["startColumn"] == 10);
  CHECK(called["region"]["endColumn"] == 26);
  const Json& frames = result["stacks"][0]["frames"];
  REQUIRE(frames.size() == 2);
  CHECK(frames[0]["location"]["physicalLocation"]["region"]["startLine"] == 2);
  CHECK(frames[1]["location"]["physicalLocation"]["region"]["startLine"] == 1);
}

TEST_CASE("a mistake without a place, bytes that are not UTF-8 and a line of 60,000 bytes make good SARIF") {
  using namespace kadr;
  SourceSet sources;
  const auto file = sources.add(SourceText("caf\xe9.ngc", "G0 X\xff" + std::string(60'000, 'y') + "\n"));
  text::SarifLog log("");
  log.add({Code::limit_not_plannable, Severity::warning, {}, "", "", {}, ""}, sources);
  log.add({Code::bad_character, Severity::error, {file, 1, 5, 60'001}, "", "\xff", {}, ""}, sources);
  const std::string text = text::json_text(log.document(2));
  CHECK(text.size() < 10'000);
  CHECK(is_utf8(text));
  const Json j = Json::parse(text);
  check_document(j);
  CHECK(j["runs"][0]["invocations"][0]["executionSuccessful"] == false);
  CHECK(j["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] ==
        "caf%E9.ngc");
  CHECK(j["runs"][0]["results"][1]["locations"].empty());
}

TEST_CASE("kadr scenario check tells what is wrong with a scenario file without running it") {
  const Scratch scratch;
  scratch.write("part.ngc", test::kSquare);
  scratch.write("scenario.toml",
                "format = 1\nname = \"square\"\nsummary = \"a square\"\nprogram = \"part.ngc\"\n"
                "machine = \"mill3\"\n");
  const Finished good = call({"scenario", "check", "scenario.toml"}, scratch.path());
  CHECK(good.code == 0);
  CHECK(good.out == "scenario.toml: scenario square, program part.ngc, machine mill3: no errors\n");
  scratch.write("scenario.toml",
                "format = 1\nname = \"square\"\nsummary = \"a square\"\nprogram = \"part.ngc\"\n"
                "machine = \"mill3\"\nnonsense = 1\n");
  const Finished bad = call({"scenario", "check", "scenario.toml", "--format", "gcc"}, scratch.path());
  CHECK(bad.code == 1);
  CHECK(bad.out.substr(0, 25) == "scenario.toml:6:1: error:");
  const Finished sarif = call({"scenario", "check", "scenario.toml", "--format", "sarif"}, scratch.path());
  CHECK(sarif.code == 1);
  check_document(Json::parse(sarif.out));
}
