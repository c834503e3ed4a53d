#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using kadr::test::shell;

/// Programs in several files, and the bounds that a user sets.
TEST_CASE("a called file is part of a run: --subs finds it, its text is in the inputs' hash") {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.file("lib"));
  scratch.write("main.ngc", "G21 F600\nO<hole> call [12]\nM2\n");
  scratch.write("lib/hole.ngc", "O<hole> sub\nG1 X#1\nO<hole> endsub\n");
  CHECK(call({"run", "main.ngc"}, scratch.path()).code == 1);
  const Finished first = call({"run", "main.ngc", "--subs", "lib", "-o", "a.lcmlog"}, scratch.path());
  CHECK(first.code == 0);
  const Finished again = call({"run", "main.ngc", "--subs", "lib", "-o", "b.lcmlog"}, scratch.path());
  CHECK(scratch.read("a.lcmlog") == scratch.read("b.lcmlog"));
  // the same motion from another text is another input
  scratch.write("lib/hole.ngc", "O<hole> sub\nG1 X#1 (again)\nO<hole> endsub\n");
  CHECK(call({"run", "main.ngc", "--subs", "lib", "-o", "c.lcmlog"}, scratch.path()).code == 0);
  CHECK(scratch.read("a.lcmlog") != scratch.read("c.lcmlog"));
  const Finished trace = call({"canon", "main.ngc", "--subs", "lib"}, scratch.path());
  CHECK(contains(trace.out, "STRAIGHT_FEED 12.000000"));
  CHECK(contains(trace.out, "@lib/hole.ngc:2\n"));
  CHECK(contains(trace.out, "PROGRAM_END @3\n"));
}

TEST_CASE("every command whose messages name --limit has it") {
  const Scratch scratch;
  scratch.write("loop.ngc", "O1 repeat [50]\nG0 X1\nO1 endrepeat\nM2\n");
  scratch.write("scenario.toml", "format = 1\nname = \"s\"\nprogram = \"loop.ngc\"\nmachine = \"mill3\"\n");
  scratch.write("tube.toml", "format = 1\n[path]\nprogram = \"loop.ngc\"\nmachine = \"mill3\"\n");
  for (const char* command : {"run loop.ngc --no-log", "check loop.ngc", "plan loop.ngc", "canon loop.ngc",
                              "scenario run scenario.toml", "scenario check scenario.toml", "tube tube.toml",
                              "run -s scenario.toml --no-log"}) {
    CAPTURE(command);
    const bool reads = !contains(command, "scenario check");
    const Finished bounded = shell(fmt::format("kadr {} --limit loop_passes=49", command), scratch.path());
    CHECK(contains(bounded.out + bounded.err, "allowed: 49 in all (--limit loop_passes=N)") == reads);
    const Finished free = shell(fmt::format("kadr {} --limit loop_passes=50", command), scratch.path());
    CHECK_FALSE(contains(free.out + free.err, "--limit"));
  }
  const Finished formed = call({"fmt", "loop.ngc", "--limit", "line_bytes=10"}, scratch.path());
  CHECK(contains(formed.err, "allowed: 10 (--limit line_bytes=N)"));
  CHECK(call({"fmt", "loop.ngc", "--limit", "line_bytes=20"}, scratch.path()).code == 0);
  CHECK(contains(call({"fmt", "loop.ngc", "--limit", "file_bytes=10"}, scratch.path()).err,
                 "(--limit file_bytes=N)"));
}

TEST_CASE("--limit sets the bounds of a program, and refuses what it does not know") {
  const Scratch scratch;
  scratch.write("loop.ngc", "O1 repeat [50]\nG91 G0 X0.1\nO1 endrepeat\nM2\n");
  CHECK(call({"canon", "loop.ngc"}, scratch.path()).code == 0);
  const Finished few = call({"canon", "loop.ngc", "--limit", "loop_passes=49"}, scratch.path());
  CHECK(few.code == 1);
  CHECK(contains(few.err, "allowed: 49 in all (--limit loop_passes=N)"));
  CHECK(call({"check", "loop.ngc", "--limit", "blocks=10"}, scratch.path()).code == 1);
  CHECK(call({"check", "loop.ngc", "--limit", "blocks=10", "--limit", "blocks=1_000"}, scratch.path()).code ==
        0);
  for (const char* bad : {"passes=5", "blocks", "blocks=", "blocks=-1", "call_depth=99999999999"}) {
    CAPTURE(bad);
    CHECK(call({"canon", "loop.ngc", "--limit", bad}, scratch.path()).code == 2);
  }
}
