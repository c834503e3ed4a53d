#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;

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
