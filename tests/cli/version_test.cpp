#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using test::call;
using test::contains;
using test::Finished;
using test::Scratch;
using Json = nlohmann::json;

namespace {

std::string three_numbers(int a, int b, int c) { return fmt::format("{}.{}.{}", a, b, c); }

}  // namespace

TEST_CASE("kadr version names version, commit, compiler, flags, libraries, log format and pages") {
  const Finished version = call({"version"});
  CHECK(version.code == 0);
  CHECK(version.out.substr(0, 10) == call({"--version"}).out.substr(0, 10));
  const Json j = Json::parse(call({"version", "--json"}).out);
  CHECK(version.out.starts_with("kadr " + j["kadr"].get<std::string>() + '\n'));
  for (const char* key : {"commit", "compiler", "build"})
    CHECK(contains(version.out, fmt::format("\n{} {}\n", key, j[key].get<std::string>())));
  CHECK(contains(version.out, fmt::format("\nlog format {}\n", j["log_format"].get<int>())));
  CHECK(j["log_format"] == 2);
  for (const char* page : {"report", "compare", "teaching"}) {
    REQUIRE(j["pages"].contains(page));
    const bool built = j["pages"][page] == true;
    CHECK(contains(version.out, built ? page : j["pages"][page].get<std::string>()));
  }
  for (const auto& [name, number] : j["libraries"].items())
    CHECK(contains(version.out, ' ' + name + ' ' + number.get<std::string>()));
}

TEST_CASE("kadr version: compiler and libraries are those of this build") {
  // the tests are compiled by the same compiler with the same headers
  const Json j = Json::parse(call({"version", "--json"}).out);
#if defined(__clang__)
  CHECK(j["compiler"] == "clang " + three_numbers(__clang_major__, __clang_minor__, __clang_patchlevel__));
#else
  CHECK(j["compiler"] == "gcc " + three_numbers(__GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__));
#endif
  CHECK(j["libraries"]["fmt"] ==
        three_numbers(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100));
  CHECK(j["libraries"]["nlohmann-json"] ==
        three_numbers(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH));
  for (const char* name :
       {"CVODE", "Eigen", "LCM", "CLI11", "toml++", "fmt", "expected", "nlohmann-json", "xxHash", "zlib"}) {
    CAPTURE(name);
    const std::string number = j["libraries"][name];
    CHECK(number.find_first_not_of("0123456789.") == std::string::npos);
    CHECK(contains(number, "."));
  }
}

TEST_CASE("the commit is in no log: builds of two commits write the same bytes") {
  const std::string commit = Json::parse(call({"version", "--json"}).out)["commit"];
  CHECK(!commit.empty());
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  const Finished run = call({"run", "square.ngc"}, scratch.path());
  CHECK(run.code == 0);
  for (const std::string& text : {scratch.read("square.lcmlog"), run.out, run.err})
    CHECK_FALSE(contains(text, commit));
}

TEST_CASE("the program is at any address and has read-only relocations; a hardened build has what it says") {
  if (!test::has_program("readelf")) return;
  const std::string program = KADR_BINARY_DIR "/kadr";
  const std::string head = test::shell("readelf -W --file-header --segments --dynamic " + program).out;
  CHECK(contains(head, "DYN ("));
  CHECK(contains(head, "GNU_RELRO"));
  CHECK(contains(head, "BIND_NOW"));
  const std::string build = Json::parse(call({"version", "--json"}).out)["build"];
  if (!contains(build, ", hardened")) return;
  const std::string symbols = test::shell("readelf -W --dyn-syms " + program).out;
  CHECK(contains(symbols, " __stack_chk_fail"));
  CHECK(contains(symbols, "__glibcxx_assert_fail"));
  if (!contains(build, "-O0")) CHECK(contains(symbols, "_chk@GLIBC"));
}
