#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"
#include "tests/support/golden.h"

using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Scratch;
namespace fs = std::filesystem;

namespace {

const fs::path kBad = fs::path(KADR_SOURCE_DIR) / "tests/bad/tube";

std::vector<std::string> bad_problems() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(kBad))
    if (file.path().extension() == ".toml") names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A problem with an axis X of 420 mm and further lines.
std::string problem(const std::string& path, const std::string& rest = "") {
  return "format = 1\n[path]\n" + path +
         "\n[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = 400\nmax_acceleration_mm_s2 = 1200\nslope_mm = "
         "420\n" +
         rest;
}

}  // namespace

TEST_CASE("each bad problem is refused with its golden text, exit 2, nothing on standard output") {
  const auto names = bad_problems();
  CHECK(names.size() >= 10);
  for (const std::string& name : names) {
    CAPTURE(name);
    const Finished refused = call({"tube", name + ".toml"}, kBad.string());
    CHECK(refused.code == 2);
    CHECK(refused.out.empty());
    kadr::test::check_golden((kBad / (name + ".txt")).string(), "tests/cli/tube_refusals_test.cpp",
                             refused.err);
  }
}

TEST_CASE("any piece of a good problem or of its table is refused or solved, never a fault of kadr") {
  const fs::path docs = fs::path(KADR_SOURCE_DIR) / "docs/tube";
  const Scratch scratch;
  fs::copy(docs / "layer.csv", scratch.file("layer.csv"));
  fs::copy(docs / "layer.toml", scratch.file("layer.toml"));
  const std::string toml = scratch.read("layer.toml"), csv = scratch.read("layer.csv");
  for (std::size_t at = 0; at < toml.size(); at += 1 + toml.size() / 40) {
    CAPTURE(at);
    scratch.write("cut.toml", toml.substr(0, at));
    scratch.write("hole.toml", toml.substr(0, at) + toml.substr(std::min(at + 9, toml.size())));
    for (const char* name : {"cut.toml", "hole.toml"}) {
      const Finished run = call({"tube", name, "--method", "greedy"}, scratch.path());
      CHECK(run.code >= 0);
      CHECK(run.code <= 2);
    }
  }
  for (std::size_t at = 0; at < csv.size(); at += 1 + csv.size() / 40) {
    CAPTURE(at);
    scratch.write("layer.csv", csv.substr(0, at) + csv.substr(std::min(at + 5, csv.size())));
    const Finished run = call({"tube", "layer.toml", "--method", "greedy"}, scratch.path());
    CHECK(run.code >= 0);
    CHECK(run.code <= 2);
  }
}

TEST_CASE("the smallest and the strangest problems have laws, or a reason and a node") {
  const Scratch scratch;
  const auto run = [&](const std::string& text) {
    scratch.write("p.toml", text);
    const Finished out = call({"tube", "p.toml"}, scratch.path());
    INFO(text, out.out, out.err);
    CHECK(out.code >= 0);
    CHECK(out.code <= 1);
    CHECK(out.out.find("nan") == std::string::npos);
    return out;
  };
  const std::string ends = "max_mm_s = 600\n";
  CHECK(run(problem("length_mm = 800\nnodes = 3\n" + ends)).code == 0);
  CHECK(run(problem("length_mm = 800\nnodes = 4\n" + ends, "[jerk]\nmax_mm_s3 = 1e4\n")).code == 0);
  run(problem("length_mm = 1e9\nnodes = 5\nmax_mm_s = 1e-6\n"));
  run(problem("length_mm = 1e-3\nnodes = 500\nmax_mm_s = 1e9\n"));
  run(problem("length_mm = 800\nnodes = 50\n" + ends, "[tube]\nlevels = 2\n[classical]\nlevels = 2\n"));
  run(problem("length_mm = 800\nnodes = 50\n" + ends, "[tube]\nlevels = 3\ngrid = \"nominal-kept\"\n"));
  run(problem("length_mm = 800\nnodes = 50\n" + ends, "[penalty]\nweight_s5_per_mm2 = 1e6\n"));
  run(problem("length_mm = 800\nnodes = 50\n" + ends, "waves = [{ amplitude_mm = 1e8, turns = 1e5 }]\n"));
  run(problem("length_mm = 800\nnodes = 50\n" + ends, "[jerk]\nmax_mm_s3 = 1e-6\n"));
  run(problem("length_mm = 800\nnodes = 50\nbegin_mm_s = 370\nend_mm_s = 1\n" + ends,
              "[[zone]]\nfrom_mm = 200\nto_mm = 220\nmax_mm_s = 1\n"));
}

TEST_CASE("a law that can't brake in time is told with node and place, exit 1") {
  const Scratch scratch;
  // from 500 mm/s to 10 mm/s in 8 mm: 15 600 mm/s2 along the path, X' = 0.525 of them 8 200, 1200 are allowed
  scratch.write("p.toml", problem("length_mm = 800\nnodes = 101\nmax_mm_s = 600\nbegin_mm_s = 500\n",
                                  "[[zone]]\nat_mm = 12\nmax_mm_s = 10\n"));
  const Finished out = call({"tube", "p.toml", "--method", "greedy"}, scratch.path());
  CHECK(out.code == 1);
  CHECK(out.out.find("no law   greedy: node 0, s = 0.000 mm: the speed must be 500") != std::string::npos);
}

TEST_CASE(
    "what else can't be started: no file, a folder, an unknown method, a jerk limit that is not given") {
  const Scratch scratch;
  scratch.write("p.toml", problem("length_mm = 800\nnodes = 50\nmax_mm_s = 600\n"));
  const auto complaint = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "tube");
    const Finished out = call(arguments, scratch.path());
    CHECK(out.code == 2);
    CHECK(out.out.empty());
    return out.err;
  };
  CHECK(complaint({"missing.toml"}) == "kadr: missing.toml: No such file or directory\n");
  CHECK(complaint({"."}).find("kadr: .: ") == 0);
  CHECK(complaint({"p.toml", "--method", "tub"})
            .find("--method takes one of classical, tube, greedy, optimum, certified, "
                  "jerk-limited; got 'tub'") != std::string::npos);
  CHECK(complaint({"p.toml", "--method", "jerk-limited"}).find("write [jerk] with max_mm_s3") !=
        std::string::npos);
  CHECK(complaint({"p.toml", "--csv", "nowhere/p.csv", "--method", "greedy"}) ==
        "kadr: nowhere/p.csv: No such file or directory\n");
  CHECK(complaint({}).find("PROBLEM") != std::string::npos);
}
