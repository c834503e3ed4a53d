#include <doctest/doctest.h>
#include <fmt/format.h>

#include <sstream>
#include <string>

#include "tests/cli/run_kadr.h"

/// `cmake --install` into a new folder, and kadr used from there.
namespace test = kadr::test;
using test::contains;
using test::Finished;
using test::Scratch;
using test::shell;

namespace {

Finished install(const Scratch& scratch, const std::string& prefix) {
  return shell(fmt::format("cmake --install {} --prefix \"$PWD/{}\"", KADR_BINARY_DIR, prefix),
               scratch.path());
}

/// Every file below a folder with the time of its last change and its size.
std::string listing(const Scratch& scratch, const std::string& folder) {
  return shell("find " + folder + " -printf '%p %T@ %s\\n' | LC_ALL=C sort", scratch.path()).out;
}

}  // namespace

TEST_CASE("cmake --install brings kadr's own things to their places, and nothing else") {
  const Scratch scratch;
  REQUIRE(install(scratch, "p").code == 0);
  CHECK(shell("cd p && ls -d *", scratch.path()).out == "bin\nshare\n");
  CHECK(shell("cd p && ls bin share", scratch.path()).out ==
        "bin:\nkadr\n\nshare:\nbash-completion\ndoc\nfish\nkadr\nman\nzsh\n");
  for (const char* file :
       {"doc/kadr/README.md", "doc/kadr/LICENSE", "doc/kadr/CHANGELOG.md", "doc/kadr/CONTRIBUTING.md",
        "doc/kadr/SECURITY.md", "doc/kadr/CITATION.cff", "doc/kadr/docs/pipeline.md",
        "doc/kadr/docs/tube/laying.toml", "doc/kadr/scenarios/README.md", "kadr/kadr.lcm",
        "kadr/machines/mill3.toml", "kadr/scenarios/01_first_cut/scenario.toml", "man/man1/kadr.1",
        "bash-completion/completions/kadr", "zsh/site-functions/_kadr",
        "fish/vendor_completions.d/kadr.fish"}) {
    CAPTURE(file);
    CHECK(scratch.has(std::string("p/share/") + file));
  }
  // sources stay at home, and no folder is empty
  CHECK(shell("find p -name '*.cpp' -o -name '*.h' -o -name CMakeLists.txt -o -type d -empty", scratch.path())
            .out == "");
  // every scenario of the tree is there
  CHECK(shell("ls p/share/kadr/scenarios/*/scenario.toml | wc -l", scratch.path()).out ==
        shell("ls " KADR_SOURCE_DIR "/scenarios/*/scenario.toml | wc -l").out);
}

TEST_CASE("every relative link of an installed document leads to an installed file") {
  const Scratch scratch;
  REQUIRE(install(scratch, "p").code == 0);
  // "page target", a line per link, without those to the network and within the same page
  const Finished links = shell(
      "cd p/share/doc/kadr && grep -oE '\\]\\([^) ]+\\)' -- *.md docs/*.md | sed -E 's/:\\]\\(/ /; s/[)]$//; "
      "s/#.*//' | grep -vE ' (https?:.*)?$'",
      scratch.path());
  CHECK(contains(links.out, "docs/HACKING.md ../CONTRIBUTING.md\n"));
  std::istringstream lines(links.out);
  for (std::string page, target; lines >> page >> target;) {
    CAPTURE(page);
    CAPTURE(target);
    const auto slash = page.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : page.substr(0, slash + 1);
    CHECK(shell("test -e p/share/doc/kadr/" + folder + target, scratch.path()).code == 0);
  }
}

TEST_CASE("two installations are the same, byte for byte; man and completions are what the program prints") {
  const Scratch scratch;
  REQUIRE(install(scratch, "p").code == 0);
  REQUIRE(install(scratch, "q").code == 0);
  const Finished same = shell("diff -r p q", scratch.path());
  CHECK(same.code == 0);
  CHECK(same.out == "");
  const Finished text = shell(
      "cd p/share; kadr man | cmp - man/man1/kadr.1; kadr completion bash | cmp - "
      "bash-completion/completions/kadr; "
      "kadr completion zsh | cmp - zsh/site-functions/_kadr; "
      "kadr completion fish | cmp - fish/vendor_completions.d/kadr.fish",
      scratch.path());
  CHECK(text.code == 0);
  CHECK(text.out + text.err == "");
}

TEST_CASE("an installed kadr runs installed scenarios and writes nothing beside them") {
  const Scratch scratch;
  REQUIRE(install(scratch, "p").code == 0);
  const std::string before = listing(scratch, "p");
  REQUIRE(contains(before, "p/share/kadr/scenarios/01_first_cut/program.ngc "));
  REQUIRE(shell("mkdir here", scratch.path()).code == 0);
  const std::string here = scratch.file("here");
  // the log goes to the current folder
  const Finished run =
      shell("../p/bin/kadr run ../p/share/kadr/scenarios/01_first_cut/program.ngc -m mill3", here);
  CHECK(run.code == 0);
  CHECK(contains(run.out, "\nsteps hash      6a854240b74fe9b6\n"));
  CHECK(shell("ls", here).out == "program.lcmlog\n");
  const Finished scenario = shell("../p/bin/kadr scenario run ../p/share/kadr/scenarios/01_first_cut", here);
  CHECK(scenario.code == 0);
  CHECK(contains(scenario.out, "1 passed, 0 failed\n"));
  // README's commands name scenarios from the folder that README is in
  const Finished check =
      shell("cd ../p/share/doc/kadr && ../../../bin/kadr check scenarios/02_pocket/program.ngc", here);
  CHECK(check.code == 0);
  CHECK(shell("ls", here).out == "program.lcmlog\n");
  CHECK(listing(scratch, "p") == before);
}
