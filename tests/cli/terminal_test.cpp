#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Launch;
using kadr::test::run_kadr;
using kadr::test::Scratch;
namespace test = kadr::test;

namespace {

Finished with_environment(std::vector<std::string> arguments, const std::string& folder,
                          std::vector<std::string> environment) {
  Launch launch;
  launch.arguments = std::move(arguments);
  launch.folder = folder;
  launch.environment = std::move(environment);
  return run_kadr(launch);
}

/// A terminal turns "\n" into "\r\n".
std::string without_returns(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
  return text;
}

}  // namespace

TEST_CASE("the locale changes no byte of any output") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  scratch.write("six.ngc", test::kSixMistakes);
  const std::vector<std::string> russian = {"LC_ALL=ru_RU.UTF-8", "LANG=ru_RU.UTF-8",
                                            "LC_NUMERIC=de_DE.UTF-8"};
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"check", "square.ngc"},
                                             {"plan", "square.ngc"},
                                             {"plan", "square.ngc", "--csv"},
                                             {"canon", "square.ngc"},
                                             {"check", "six.ngc"},
                                             {"run", "square.ngc", "--json"},
                                             {"machine", "show"},
                                             {"explain", "--list"},
                                             {"info", "square.lcmlog"},
                                             {"run", "missing.ngc"}}) {
    CAPTURE(arguments.front());
    const Finished plain = call(arguments, scratch.path());
    const Finished local = with_environment(arguments, scratch.path(), russian);
    CHECK(plain.code == local.code);
    CHECK(plain.out == local.out);
    CHECK(plain.err == local.err);
  }
}

TEST_CASE("a terminal gets the same data as a file; colours only in messages, a bar only while it runs") {
  if (test::lacks_terminals()) return;
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  Launch launch;
  launch.arguments = {"check", "square.ngc"};
  launch.folder = scratch.path();
  launch.environment = {"TERM=xterm"};
  launch.terminal = true;
  const Finished terminal = run_kadr(launch);
  CHECK(terminal.code == 0);
  CHECK(without_returns(terminal.out) == call({"check", "square.ngc"}, scratch.path()).out);
}

TEST_CASE(
    "a long run draws a bar on a terminal and erases it; plain progress and a dumb terminal have no codes") {
  if (test::lacks_terminals()) return;
  const Scratch scratch;
  // some hours of machine time: more than 0.3 s of wall time on any computer
  scratch.write("long.ngc", test::back_and_forth(20'000));
  Launch launch;
  launch.arguments = {"run", "long.ngc", "--no-log", "--until", "600"};
  launch.folder = scratch.path();
  launch.environment = {"TERM=xterm"};
  launch.terminal = true;
  const Finished bar = run_kadr(launch);
  CHECK(bar.code == 0);
  CHECK(contains(bar.out, " s of machine "));
  CHECK(contains(bar.out, "\r\x1b[K"));
  CHECK(contains(bar.out, "x real time"));
  launch.environment = {"TERM=dumb"};
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
  launch.environment = {"TERM=xterm", "CI=true"};
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
  launch.environment = {"TERM=xterm"};
  launch.arguments.push_back("--progress=never");
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
}

TEST_CASE("a long problem of kadr tube tells on a terminal how far it is, and nothing anywhere else") {
  if (test::lacks_terminals()) return;
  const Scratch scratch;
  // 8000 levels at 400 nodes: 2e10 pairs of levels a pass, seconds on any computer
  scratch.write(
      "long.toml",
      "format = 1\n[path]\nlength_mm = 800\nnodes = 400\nmax_mm_s = 600\n[[axis]]\nname = \"X\"\nunit = "
      "\"mm\"\nmax_mm_s = 400\nmax_acceleration_mm_s2 = 1200\nslope_mm = 420\n[classical]\nlevels = 8000\n");
  Launch launch;
  launch.arguments = {"tube", "long.toml", "--method", "classical"};
  launch.folder = scratch.path();
  const Finished piped = run_kadr(launch);
  CHECK(piped.code == 0);
  CHECK(piped.err.empty());
  launch.environment = {"TERM=xterm"};
  launch.terminal = true;
  const Finished bar = run_kadr(launch);
  CHECK(bar.code == 0);
  CHECK(contains(bar.out, "tube  classical: levels  "));
  CHECK(contains(bar.out, "\r\x1b[K"));
  // erased before the answer, which is the same bytes
  const auto answer = bar.out.rfind("\x1b[K");
  CHECK(contains(without_returns(bar.out.substr(answer)), piped.out));
  launch.arguments.push_back("-q");
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
}

TEST_CASE(
    "colour: auto for messages on a terminal, always and never by flag, NO_COLOR and CLICOLOR_FORCE kept") {
  if (test::lacks_terminals()) return;
  const Scratch scratch;
  scratch.write("six.ngc", test::kSixMistakes);
  const std::string& folder = scratch.path();
  CHECK(!contains(call({"run", "six.ngc"}, folder).err, "\x1b"));
  CHECK(contains(call({"run", "six.ngc", "--color", "always"}, folder).err, "\x1b["));
  CHECK(contains(call({"check", "six.ngc", "--color=always"}, folder).out, "\x1b["));
  CHECK(contains(with_environment({"run", "six.ngc"}, folder, {"CLICOLOR_FORCE=1"}).err, "\x1b["));
  CHECK(!contains(with_environment({"run", "six.ngc"}, folder, {"CLICOLOR_FORCE=0"}).err, "\x1b["));
  CHECK(!contains(with_environment({"run", "six.ngc"}, folder, {"CLICOLOR_FORCE=1", "NO_COLOR=1"}).err,
                  "\x1b["));

  Launch launch;
  launch.arguments = {"run", "six.ngc"};
  launch.folder = folder;
  launch.terminal = true;
  launch.environment = {"TERM=xterm"};
  CHECK(contains(run_kadr(launch).out, "\x1b[1;31m"));
  launch.environment = {"TERM=xterm", "NO_COLOR=1"};
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
  launch.environment = {"TERM=xterm"};
  launch.arguments.push_back("--color=never");
  CHECK(!contains(run_kadr(launch).out, "\x1b"));
}
