#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "emulator/scenario/scenario.h"
#include "machine/base/parse_number.h"
#include "scenarios/generator/wind.h"
#include "tests/cli/run_kadr.h"

using namespace kadr;
using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

/// The words of the line of a page that begins with a command.
std::vector<std::string> words_of(const std::string& page, const std::string& command) {
  const std::size_t at = page.find("\n    " + command + " ");
  REQUIRE(at != std::string::npos);
  std::istringstream line(page.substr(at + 1, page.find('\n', at + 1) - at - 1));
  return {std::istream_iterator<std::string>(line), {}};
}

/// Runs a command of a page, "kadr ..." as words.
Finished run_words(std::vector<std::string> words, const Scratch& scratch) {
  REQUIRE(words.front() == "kadr");
  words.erase(words.begin());
  return call(words, scratch.path());
}

}  // namespace

TEST_CASE("kadr wind writes a program of each kind, which winder4 accepts") {
  const Scratch scratch;
  // few circuits: planning 10 000 blocks three times would only take time
  const std::vector<std::vector<std::string>> windings = {{"hoop", "--length-mm", "24"},
                                                          {"helix", "--length-mm", "100", "--band-mm", "40"},
                                                          {"dome", "--length-mm", "100", "--band-mm", "60"}};
  for (std::vector<std::string> arguments : windings) {
    const std::string kind = arguments.front(), file = kind + ".ngc";
    CAPTURE(kind);
    arguments.insert(arguments.begin(), "wind");
    const Finished printed = call(arguments, scratch.path());
    CHECK(printed.code == 0);
    CHECK(printed.err.empty());
    CHECK(printed.out.starts_with("(kadr wind " + kind + " --radius-mm "));

    arguments.insert(arguments.end(), {"-o", file});
    const Finished written = call(arguments, scratch.path());
    CHECK(written.code == 0);
    CHECK(written.out.empty());
    CHECK(written.err.starts_with("kadr: wrote " + file + ": "));
    CHECK(scratch.read(file) == printed.out);

    const Finished check = call({"check", file, "-m", "winder4"}, scratch.path());
    CHECK(check.code == 0);
    CHECK(contains(check.out, file + " on winder4 (shipped)"));
    CHECK(!contains(check.out, "OUTSIDE"));
  }
}

TEST_CASE("line 1 of a winding program is the command that writes it again") {
  const Scratch scratch;
  const std::string text = call({"wind", "dome", "--band-mm", "30", "--polar-mm", "25.5"}).out;
  std::istringstream line(text.substr(1, text.find(')') - 1));
  const std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
  CHECK(words.size() == 3 + 2 * scenarios::wind_parameters("dome").size());
  CHECK(run_words(words, scratch).out == text);
}

TEST_CASE("the help of a winding has every parameter with its bounds and its default") {
  for (const scenarios::WindKind& kind : scenarios::wind_kinds()) {
    CAPTURE(kind.name);
    const Finished help = call({"wind", std::string(kind.name), "--help"});
    CHECK(help.code == 0);
    for (const scenarios::WindParameter& p : kind.parameters) {
      CHECK(contains(help.out, "\n  " + scenarios::wind_flag(p.key) + " N "));
      CHECK(contains(help.out, number_text(p.least) + " to " + number_text(p.most) + " (default " +
                                   number_text(p.preset) + ")"));
    }
    CHECK(contains(call({"wind", "--help"}).out, "\n  " + std::string(kind.name) + " "));
  }
}

TEST_CASE("a parameter of a winding that can't be is refused: exit 2, no file, nothing on standard output") {
  const Scratch scratch;
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"hoop", "--radius-mm", "3"}, "kadr: wind hoop: radius_mm is 3, allowed 5 to 2000\n"},
      {{"hoop", "--gap-mm", "-5"}, "kadr: wind hoop: gap_mm is -5, allowed 1 to 1000\n"},
      {{"hoop", "--layers", "1.5"}, "kadr: wind hoop: layers is 1.5, a whole number is needed\n"},
      {{"helix", "--angle-deg", "89"}, "kadr: wind helix: angle_deg is 89, allowed 10 to 85\n"},
      {{"dome", "--polar-mm", "60"}, "kadr: wind dome: polar_mm is 60, allowed up to 0.95 radius_mm = 57\n"},
      {{"hoop", "--length-mm", "10_000", "--step-deg", "0.1", "--layers", "10"},
       "kadr: wind hoop: the program would have about 60036000 blocks, allowed 5000000\n"},
      {{"hoop", "--radius-mm", "1,5"}, "--radius-mm takes a number; got '1,5'\n"},
      {{"hoop", "--radius-mm", "nan"}, "--radius-mm takes a number; got 'nan'\n"},
      {{"hoop", "--radius-mm"}, "--radius-mm"},
      {{"hoop", "--radius-mm", "50", "--radius-mm", "60"}, "--radius-mm"},
      {{"hoop", "--angle-deg", "45"}, "--angle-deg"},
      {{"hoop", "--radius", "50"}, "--radius"},
      {{"knot"}, "kadr wind: there is no command 'knot'; commands: hoop, helix, dome\n"},
  };
  for (auto [arguments, complaint] : cases) {
    const std::string& expected = complaint;
    CAPTURE(expected);
    arguments.insert(arguments.begin(), "wind");
    arguments.insert(arguments.end(), {"-o", "part.ngc"});
    const Finished run = call(arguments, scratch.path());
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CAPTURE(run.err);
    CHECK(contains(run.err, complaint));
    CHECK(!scratch.has("part.ngc"));
  }
  const Finished nowhere = call({"wind", "hoop", "-o", "no/part.ngc"}, scratch.path());
  CHECK(nowhere.code == 2);
  CHECK(nowhere.err == "kadr: no/part.ngc: No such file or directory\n");
}

TEST_CASE("kadr wind speaks JSON") {
  const Scratch scratch;
  const std::vector<std::string> hoop = {"wind", "hoop", "--length-mm", "24"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), hoop.begin(), hoop.end());
    return call(more, scratch.path());
  };
  const Json printed = Json::parse(with({"--json"}).out);
  CHECK(printed["text"] == with({}).out);
  CHECK(printed["file"].is_null());
  // two layers of 4 turns and three closing turns, 72 blocks each
  CHECK(printed["blocks"] == 11 * 72);
  const Finished written = with({"--json", "-o", "hoop.ngc"});
  CHECK(written.err.empty());
  CHECK(Json::parse(written.out)["file"] == "hoop.ngc");
  CHECK(scratch.read("hoop.ngc") == printed["text"]);
}

TEST_CASE("the commands on the page of a winding scenario write the program that it runs, and check it") {
  const Scratch scratch;
  for (const std::string name : {"05_hoop", "06_helix", "14_dome"}) {
    CAPTURE(name);
    const std::string folder = std::string(KADR_SOURCE_DIR) + "/scenarios/" + name;
    std::ostringstream page;
    page << std::ifstream(folder + "/README.md", std::ios::binary).rdbuf();
    const std::vector<std::string> words = words_of(page.str(), "kadr wind");
    const Finished written = run_words(words, scratch);
    CAPTURE(written.err);
    REQUIRE(written.code == 0);
    SourceSet sources;
    const auto scenario = scenario::read_scenario(folder, sources);
    REQUIRE(scenario.has_value());
    CHECK(!scenario->generated_program.empty());
    CHECK(scratch.read(words.back()) == scenario->generated_program);
    std::vector<std::string> check = words_of(page.str(), "kadr run");
    check[1] = "check";
    CHECK(run_words(check, scratch).code == 0);
  }
}
