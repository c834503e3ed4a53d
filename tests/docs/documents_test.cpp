#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/docs/console_blocks.h"

using namespace kadr::docs;
namespace fs = std::filesystem;

namespace {

/// A folder to run in: the project's scenarios and machine files are there, the output files of commands are deleted.
class Workplace {
 public:
  Workplace() : path_(fs::temp_directory_path() / ("kadr_docs_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
    for (const char* name : {"scenarios", "machine", "docs", "emulator"})
      if (fs::exists(fs::path(KADR_SOURCE_DIR) / name))
        fs::create_directory_symlink(fs::path(KADR_SOURCE_DIR) / name, path_ / name);
  }
  ~Workplace() { fs::remove_all(path_); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

void check_document(const std::string& name) {
  const fs::path file = fs::path(KADR_SOURCE_DIR) / name;
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const std::vector<std::string> document = split_lines(text.str());
  const std::vector<Example> examples = parse_examples(document);
  REQUIRE_FALSE(examples.empty());
  const Workplace workplace;
  std::vector<std::vector<std::string>> outputs;
  for (const Example& example : examples)
    outputs.push_back(run_command(example.command, workplace.path(), KADR_BINARY_DIR));
  if (std::getenv("KADR_REGENERATE") != nullptr) {
    std::ofstream(file, std::ios::binary) << with_outputs(document, examples, outputs);
    return;
  }
  for (std::size_t i = 0; i < examples.size(); ++i) {
    std::string shown;
    for (const std::string& line : outputs[i]) shown += line + "\n";
    CHECK_MESSAGE(matches_output(examples[i].expected, outputs[i]), name, ":", examples[i].command_line,
                  ": $ ", examples[i].command, "\ngives\n", shown);
  }
}

}  // namespace

TEST_CASE("README.md: every command gives the output that stands below it") { check_document("README.md"); }

TEST_CASE("docs/install.md: every command gives the output that stands below it") {
  check_document("docs/install.md");
}

TEST_CASE("docs/pipeline.md: every command gives the output that stands below it") {
  check_document("docs/pipeline.md");
}

TEST_CASE("docs/machine_keys.md: every command gives the output that stands below it") {
  check_document("docs/machine_keys.md");
}

TEST_CASE("docs/gcode.md: every command gives the output that stands below it") {
  check_document("docs/gcode.md");
}

TEST_CASE("docs/from_line.md: every command gives the output that stands below it") {
  check_document("docs/from_line.md");
}

TEST_CASE("docs/override.md: every command gives the output that stands below it") {
  check_document("docs/override.md");
}

TEST_CASE("docs/diff.md: every command gives the output that stands below it") {
  check_document("docs/diff.md");
}

TEST_CASE("docs/time_law.md: every command gives the output that stands below it") {
  check_document("docs/time_law.md");
}

TEST_CASE("docs/interpolators.md: every command gives the output that stands below it") {
  check_document("docs/interpolators.md");
}

TEST_CASE("docs/rapids.md: every command gives the output that stands below it") {
  check_document("docs/rapids.md");
}

TEST_CASE("docs/smoothing.md: every command gives the output that stands below it") {
  check_document("docs/smoothing.md");
}

TEST_CASE("docs/report.md: every command gives the output that stands below it") {
  check_document("docs/report.md");
}

TEST_CASE("docs/machine_file.md: every command gives the output that stands below it") {
  check_document("docs/machine_file.md");
}

TEST_CASE("docs/programs.md: every command gives the output that stands below it") {
  check_document("docs/programs.md");
}

TEST_CASE("docs/output.md: every command gives the output that stands below it") {
  check_document("docs/output.md");
}

TEST_CASE("an output that differs from the document is seen") {
  const auto document = split_lines(
      "text\n```console\n$ echo one\n> echo two\none\ntwo\n$ false\n(exit 1)\n```\n```\n$ no\n```\n");
  const auto examples = parse_examples(document);
  REQUIRE(examples.size() == 2);
  CHECK(examples[0].command == "echo one\necho two");
  const std::vector<std::vector<std::string>> outputs = {run_command(examples[0].command, "/", "/"),
                                                         run_command(examples[1].command, "/", "/")};
  CHECK(matches_output(examples[0].expected, outputs[0]));
  CHECK(matches_output(examples[1].expected, outputs[1]));
  CHECK_FALSE(matches_output({"one", "three"}, outputs[0]));
  CHECK_FALSE(matches_output({"one"}, outputs[0]));
  CHECK_FALSE(matches_output({}, outputs[1]));
  CHECK_FALSE(matches_output({"one", "two", "more"}, outputs[0]));
  CHECK(with_outputs(document, examples, {{"1", "two"}, {"(exit 1)"}}) ==
        "text\n```console\n$ echo one\n> echo two\n1\ntwo\n$ false\n(exit 1)\n```\n```\n$ no\n```\n");
}

TEST_CASE("docs/motion_laws.md: every command gives the output that stands below it") {
  check_document("docs/motion_laws.md");
}

TEST_CASE("wildcards stand for text within a line, or for lines") {
  CHECK(matches_line("wall [..] s, [..]x real time", "wall 0.94 s, 41x real time"));
  CHECK_FALSE(matches_line("wall [..] s", "wall 0.94 s, 41x"));
  CHECK(matches_output({"a", "[...]", "z"}, {"a", "b", "c", "z"}));
  CHECK(matches_output({"a", "[...]"}, {"a"}));
  CHECK_FALSE(matches_output({"a", "[...]", "z"}, {"a", "b", "c"}));
}
