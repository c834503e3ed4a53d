#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;

namespace {

/// Every way in which a command is given an input, IN being its name.
std::vector<std::vector<std::string>> commands(const std::string& in) {
  return {{"check", in},
          {"canon", in},
          {"fmt", in},
          {"plan", in},
          {"run", in, "--no-log"},
          {"check", "p.ngc", "-m", in},
          {"check", "p.ngc", "--tools", in},
          {"machine", "check", in},
          {"machine", "show", in},
          {"run", "-s", in, "--no-log"},
          {"tube", in}};
}

}  // namespace

TEST_CASE("a scenario in place of a program is told what takes it") {
  const Scratch scratch;
  scratch.write("s.toml", "format = 1\n");
  for (const char* command : {"run", "check", "plan", "canon", "fmt"}) {
    const Finished done = call({command, "s.toml"}, scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "s.toml: a TOML file is no program; kadr run -s FILE runs a scenario\n"));
  }
}

TEST_CASE("a pipe or device as any input is refused at once, with its name") {
  const Scratch scratch;
  scratch.write("p.ngc", "G0 X1\nM2\n");
  REQUIRE(::mkfifo(scratch.file("pipe").c_str(), 0600) == 0);
  for (const auto& [in, reason] : {std::pair<std::string, std::string>{"pipe", "is a pipe, not a file"},
                                   {"/dev/zero", "is a device or socket"}}) {
    for (const std::vector<std::string>& command : commands(in)) {
      CAPTURE(command.front());
      CAPTURE(command.back());
      const Finished done = call(command, scratch.path());
      CHECK(done.code == 2);
      CHECK(contains(done.err, in + ": " + reason));
    }
  }
}

TEST_CASE("an input far larger than any of its kind is refused before it is read") {
  const Scratch scratch;
  scratch.write("p.ngc", "G0 X1\nM2\n");
  scratch.write("large", "");
  std::filesystem::resize_file(scratch.file("large"), std::uintmax_t{1} << 42);
  for (const std::vector<std::string>& command : commands("large")) {
    CAPTURE(command.front());
    CAPTURE(command.back());
    const Finished done = call(command, scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "large: 4398046511104 bytes; at most "));
  }
  CHECK(contains(call({"check", "large"}, scratch.path()).err,
                 "at most 1073741824 are read (--limit file_bytes=N)"));
  CHECK(contains(call({"check", "p.ngc", "--limit", "file_bytes=5"}, scratch.path()).err,
                 "p.ngc: 9 bytes; at most 5 are read (--limit file_bytes=N)"));
  scratch.write("s.toml", "format = 1\nname = \"s\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"scenario", "run", "s.toml"}, {"run", "-s", "s.toml", "--no-log"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--limit", "file_bytes=5"});
    const Finished done = call(arguments, scratch.path());
    CHECK(done.code != 0);
    CHECK(contains(done.out + done.err, "p.ngc: 9 bytes; at most 5 are read (--limit file_bytes=N)"));
  }
}

TEST_CASE("what a scenario names and is no file is told as what it is") {
  const Scratch scratch;
  REQUIRE(::mkfifo(scratch.file("pipe").c_str(), 0600) == 0);
  std::filesystem::create_directory(scratch.file("folder"));
  for (const auto& [name, reason] : {std::pair<std::string, std::string>{"pipe", "is a pipe, not a file"},
                                     {"folder", "is a folder, not a file"},
                                     {"none.ngc", "there is no file "}}) {
    scratch.write("s.toml", "format = 1\nname = \"s\"\nprogram = \"" + name + "\"\nmachine = \"mill3\"\n");
    const Finished done = call({"run", "-s", "s.toml", "--no-log"}, scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "[K3201]"));
    CHECK(contains(done.err, reason));
  }
}

TEST_CASE("of several scenarios one that can't be read leaves the others checked and listed") {
  const Scratch scratch;
  scratch.write("p.ngc", "G0 X1\nM2\n");
  scratch.write(
      "s.toml",
      "format = 1\nname = \"good\"\nsummary = \"a line\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n");
  scratch.write("large.toml", "");
  std::filesystem::resize_file(scratch.file("large.toml"), std::uintmax_t{1} << 42);
  for (const char* command : {"check", "list"}) {
    CAPTURE(command);
    const Finished done = call({"scenario", command, "large.toml", "s.toml"}, scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "kadr: large.toml: 4398046511104 bytes; at most "));
    CHECK(contains(done.out, "good"));
  }
}
