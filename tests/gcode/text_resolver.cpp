#include "gcode/read/text_resolver.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support.h"

using namespace kadr;
using namespace kadr::gcode;
using namespace kadr::gcode::test;

namespace {

namespace fs = std::filesystem;

/// A folder of its own, emptied at the end.
struct TextFolder {
  fs::path path = fs::temp_directory_path() / ("kadr_texts_" + std::to_string(::getpid()));
  TextFolder() { fs::create_directories(path); }
  ~TextFolder() { fs::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

}  // namespace

TEST_CASE("folders give a name's file, the first folder first, and say where they looked") {
  const TextFolder folder;
  fs::create_directories(folder.path / "first");
  folder.write("part.ngc", "second");
  folder.write("first/part.ngc", "first");
  const std::string first = (folder.path / "first").string(), second = folder.path.string();
  const FoundText found = FolderTexts({first, second}).find("part");
  REQUIRE(found.text);
  CHECK(found.text->text() == "first");
  CHECK(found.text->name() == first + "/part.ngc");
  CHECK(FolderTexts({second, first}).find("part").text->text() == "second");
  const FoundText none = FolderTexts({first, second}).find("other");
  CHECK_FALSE(none.text);
  CHECK(none.refusal.empty());
  CHECK(none.looked == "kadr looked for other.ngc in " + first + ", " + second);
  CHECK(FolderTexts({}).find("other").looked ==
        "a program from standard input has no folder; --subs names one");
}

TEST_CASE(
    "a name with a path, a link that leads out, and a folder are refused, also where a later folder has the "
    "file") {
  const TextFolder folder;
  fs::create_directories(folder.path / "in");
  fs::create_directories(folder.path / "in" / "part.ngc");
  folder.write("out.ngc", "outside");
  folder.write("part.ngc", "plain");
  fs::create_symlink(folder.path / "out.ngc", folder.path / "in" / "out.ngc");
  const FolderTexts texts({(folder.path / "in").string(), folder.path.string()});
  const auto refusal = [&](const std::string& name) {
    const FoundText found = texts.find(name);
    CHECK_FALSE(found.text);
    CHECK(found.help == (name == "out"
                             ? "put the file below the program's folder, or allow the folder that it is "
                               "in with --allow DIR"
                             : "put the file below the program's folder, or name its folder with --subs"));
    return found.refusal;
  };
  CHECK(refusal("in/out") == "the name holds a path");
  CHECK(refusal("..") == "the name holds a path");
  CHECK(refusal("out").ends_with("/in/out.ngc is a link that leads out of its folder"));
  CHECK(refusal("part").ends_with("/in/part.ngc is not a plain file"));
  // the link is followed where the user allows it
  const FolderTexts allowing({(folder.path / "in").string()}, 0, {folder.path.string()});
  CHECK(allowing.find("out").text->text() == "outside");
}

TEST_CASE("a program's own folder comes before the others, and standard input has none") {
  const TextFolder folder;
  folder.write("part.ngc", "beside");
  CHECK(FolderTexts::beside((folder.path / "program.ngc").string(), {"/nowhere"}).find("part").text);
  CHECK_FALSE(FolderTexts::beside("-", {"/nowhere"}).find("part").text);
  CHECK(FolderTexts::beside("program.ngc", {"/nowhere"}).find("part").looked ==
        "kadr looked for part.ngc in ., /nowhere");
}

TEST_CASE("texts in memory go before the files behind them, and a program may be read from them alone") {
  const TextFolder folder;
  folder.write("part.ngc", "on disk");
  folder.write("other.ngc", "on disk");
  const FolderTexts disk({folder.path.string()});
  MemoryTexts open(&disk);
  open.put("part", "half typed");
  open.put("part", "in the editor");
  CHECK(open.find("part").text->text() == "in the editor");
  CHECK(open.find("part").text->name() == "part.ngc");
  CHECK(open.find("other").text->text() == "on disk");
  CHECK(open.find("third").looked == "kadr looked for third.ngc in " + folder.path.string());
  CHECK(MemoryTexts().find("third").looked == "third.ngc is not among the files at hand");

  MemoryTexts dropped;
  dropped.put("square", "O<square> sub\nG0 X#1\nO<square> endsub\n");
  SourceSet sources;
  const std::uint32_t program = sources.add(SourceText("-", "O<square> call [7]\nO<circle> call\nM2\n"));
  InterpretOptions options;
  options.called_files = &dropped;
  Diagnostics diagnostics;
  std::vector<double> x;
  interpret(
      sources, program, options,
      [&](const Block& block) {
        if (const auto* rapid = std::get_if<Traverse>(&block.action)) x.push_back(rapid->end[0]);
      },
      diagnostics);
  CHECK(x == std::vector<double>{7});
  REQUIRE(diagnostics.errors() == 1);
  CHECK(diagnostics.list()[0].code == Code::sub_not_found);
  CHECK(diagnostics.list()[0].notes.at(0) == "circle.ngc is not among the files at hand");
  REQUIRE(sources.size() == 2);
  CHECK(sources[1].name() == "square.ngc");
}
