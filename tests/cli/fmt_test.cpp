#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace {

const std::string kUntidy = "g1x10 f600 g90 (side)\r\ny 2.50 (end)\nm2\n";
const std::string kTidy = "G90 G1 X10 F600 (side)\nY2.5            (end)\nM2\n";

}  // namespace

TEST_CASE("kadr fmt prints a program in normal form, from a file and from standard input") {
  const Scratch scratch;
  scratch.write("part.ngc", kUntidy);
  const Finished file = call({"fmt", "part.ngc"}, scratch.path());
  CHECK(file.code == 0);
  CHECK(file.out == kTidy);
  CHECK(file.err.empty());
  CHECK(scratch.read("part.ngc") == kUntidy);
  CHECK(call({"fmt", "-"}, scratch.path(), kUntidy).out == kTidy);
  // the trace, line numbers included, is the same
  scratch.write("tidy.ngc", kTidy);
  CHECK(call({"canon", "tidy.ngc"}, scratch.path()).out == call({"canon", "part.ngc"}, scratch.path()).out);
}

TEST_CASE("kadr fmt --check names the programs that differ and changes none") {
  const Scratch scratch;
  scratch.write("untidy.ngc", kUntidy);
  scratch.write("tidy.ngc", kTidy);
  const Finished both = call({"fmt", "--check", "tidy.ngc", "untidy.ngc"}, scratch.path());
  CHECK(both.code == 1);
  CHECK(both.out == "untidy.ngc\n");
  CHECK(scratch.read("untidy.ngc") == kUntidy);
  const Finished good = call({"fmt", "--check", "tidy.ngc"}, scratch.path());
  CHECK(good.code == 0);
  CHECK(good.out.empty());
  CHECK(call({"fmt", "--check", "--in-place", "tidy.ngc"}, scratch.path()).code == 2);
}

TEST_CASE("kadr fmt --in-place rewrites what differs, keeps mode and link, leaves nothing beside") {
  const Scratch scratch;
  scratch.write("part.ngc", kUntidy);
  ::chmod(scratch.file("part.ngc").c_str(), 0640);
  REQUIRE(::symlink("part.ngc", scratch.file("link.ngc").c_str()) == 0);
  const Finished done = call({"fmt", "--in-place", "link.ngc"}, scratch.path());
  CHECK(done.code == 0);
  CHECK(done.out.empty());
  CHECK(scratch.read("part.ngc") == kTidy);
  CHECK(!scratch.has("part.ngc.part"));
  struct stat status {};
  REQUIRE(::lstat(scratch.file("link.ngc").c_str(), &status) == 0);
  CHECK(S_ISLNK(status.st_mode));
  REQUIRE(::stat(scratch.file("part.ngc").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  CHECK(call({"fmt", "--in-place", "-"}, scratch.path(), kUntidy).code == 2);
}

TEST_CASE("kadr fmt leaves a line with a mistake as it is, tells it, and rewrites no such file") {
  const Scratch scratch;
  const std::string bad = "g0 x1\n  g1 x1.2.3\n";
  scratch.write("bad.ngc", bad);
  const Finished printed = call({"fmt", "bad.ngc", "--format", "gcc"}, scratch.path());
  CHECK(printed.code == 1);
  CHECK(printed.out == "G0 X1\n  g1 x1.2.3\n");
  CHECK(printed.err.substr(0, 20) == "bad.ngc:2:10: error:");
  const Finished in_place = call({"fmt", "--in-place", "bad.ngc"}, scratch.path());
  CHECK(in_place.code == 1);
  CHECK(scratch.read("bad.ngc") == bad);
  CHECK(in_place.err.find("bad.ngc: left unchanged; fix its errors first") != std::string::npos);
  const Finished sarif = call({"fmt", "bad.ngc", "--format", "sarif"}, scratch.path());
  CHECK(Json::parse(sarif.err)["runs"][0]["results"].size() == 1);
}

TEST_CASE("kadr fmt goes on behind a file that can't be read, and speaks JSON") {
  const Scratch scratch;
  scratch.write("part.ngc", kUntidy);
  const Finished two = call({"fmt", "missing.ngc", "part.ngc"}, scratch.path());
  CHECK(two.code == 2);
  CHECK(two.out == kTidy);
  CHECK(two.err == "kadr: missing.ngc: No such file or directory\n");
  const Json j = Json::parse(call({"fmt", "part.ngc", "--json"}, scratch.path()).out);
  REQUIRE(j.size() == 1);
  CHECK(j[0]["program"] == "part.ngc");
  CHECK(j[0]["differs"] == true);
  CHECK(j[0]["text"] == kTidy);
  CHECK(j[0]["diagnostics"].empty());
}
