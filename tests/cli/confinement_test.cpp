#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

/// What a file names stays below its folder, links followed, unless --allow says otherwise.
using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;
using Json = nlohmann::json;

namespace fs = std::filesystem;

namespace {

/// No program, machine, table or scenario: a line of it is in the message of whoever reads it.
const std::string kSecret = "[SECRET77 = = \n";

/// A folder `in` with a scenario or problem, and beside it what it must not read.
struct Ward {
  Scratch scratch;
  Ward() {
    for (const char* folder : {"in", "in/sub", "out", "open"}) fs::create_directory(scratch.file(folder));
    scratch.write("out/secret", kSecret);
    scratch.write("in/p.ngc", "G21 G90\nG1 X10 F600\nM2\n");
    scratch.write("in/inner", kSecret);
    scratch.write("open/given", kSecret);
    fs::create_symlink("../out/secret", scratch.file("in/link"));
    fs::create_symlink(scratch.file("out/secret"), scratch.file("in/far"));
    fs::create_symlink("../out", scratch.file("in/linked"));
    fs::create_symlink("link", scratch.file("in/link_of_link"));
    fs::create_symlink("../inner", scratch.file("in/sub/inner"));
    fs::create_symlink("../../out/secret", scratch.file("in/sub/link"));
    fs::create_symlink("../out/secret", scratch.file("open/evil"));
    fs::create_symlink("open", scratch.file("opened"));
    fs::create_symlink("../open/given", scratch.file("in/given"));
  }
  std::vector<std::string> ways_out() const {
    return {"../out/secret",  scratch.file("out/secret"),
            "link",           "far",
            "linked/secret",  "link_of_link",
            "sub/link",       "sub/../../out/secret",
            "../in/sub/link", scratch.file("in/link"),
            "../open/given"};
  }
  std::vector<std::string> ways_inside() const {
    return {"inner", "sub/inner", "sub/../inner", "./inner", "../in/inner", scratch.file("in/inner")};
  }
  Finished run(std::vector<std::string> arguments) const {
    return call(std::move(arguments), scratch.path());
  }
};

/// A key that names a file: the text of in/f.toml with another file's name for @.
struct Key {
  const char* what;
  std::string text;
  bool scenario;
};

const std::string kScenario = "format = 1\nname = \"n\"\n";
const std::vector<Key> kKeys = {
    {"scenario program", kScenario + "program = \"@\"\nmachine = \"mill3\"\n", true},
    {"scenario machine", kScenario + "program = \"p.ngc\"\nmachine = \"@\"\n", true},
    {"scenario tools", kScenario + "program = \"p.ngc\"\nmachine = \"mill3\"\ntools = \"@\"\n", true},
    {"scenario ini", kScenario + "program = \"p.ngc\"\nmachine = \"mill3\"\nini = \"@\"\n", true},
    {"problem program", "format = 1\n[path]\nprogram = \"@\"\nmachine = \"mill3\"\n", false},
    {"problem machine", "format = 1\n[path]\nprogram = \"p.ngc\"\nmachine = \"@\"\n", false},
    {"problem tools", "format = 1\n[path]\nprogram = \"p.ngc\"\nmachine = \"mill3\"\ntools = \"@\"\n", false},
    {"problem table",
     "format = 1\n[path]\ntable = \"@\"\nmax_mm_s = 600\n[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = "
     "400\n"
     "max_acceleration_mm_s2 = 1200\n",
     false},
    {"machine of a formula",
     "format = 1\n[path]\nmachine = \"@\"\nlength_mm = 10\nnodes = 11\nmax_mm_s = 10\n[[axis]]\nname = "
     "\"X\"\n",
     false},
};

/// The commands that read in/f.toml.
std::vector<std::vector<std::string>> commands(const Key& key) {
  if (!key.scenario) return {{"tube", "in/f.toml"}, {"tube", "in/f.toml", "--json"}};
  return {{"run", "-s", "in/f.toml", "--no-log"},
          {"run", "-s", "in/f.toml", "--no-log", "--json"},
          {"scenario", "run", "in/f.toml"},
          {"scenario", "check", "in/f.toml"},
          {"scenario", "check", "in/f.toml", "--format", "sarif"},
          {"scenario", "list", "in/f.toml"}};
}

void name_file(const Ward& ward, const Key& key, const std::string& name) {
  std::string text = key.text;
  ward.scratch.write("in/f.toml", text.replace(text.find('@'), 1, name));
}

bool quotes(const Finished& run) { return contains(run.out + run.err, "SECRET77"); }
bool refuses(const Finished& run) {
  return run.code > 0 && contains(run.out + run.err, "K3014") && !quotes(run);
}

}  // namespace

TEST_CASE("whatever a scenario or problem names, no way leads out of its folder, by any command") {
  const Ward ward;
  for (const Key& key : kKeys) {
    bool every_command = true;
    for (const std::string& way : ward.ways_out()) {
      name_file(ward, key, way);
      const auto all = commands(key);
      // every command by the first way, the first command by every way
      for (std::size_t i = 0; i < (every_command ? all.size() : 1); ++i) {
        const Finished run = ward.run(all[i]);
        INFO(key.what, ": ", way, "\n", run.out, run.err);
        CHECK(refuses(run));
      }
      every_command = false;
    }
  }
}

TEST_CASE("what lies below the folder is read by any name, and what --allow names") {
  const Ward ward;
  for (const Key& key : kKeys) {
    for (const std::string& way : ward.ways_inside()) {
      name_file(ward, key, way);
      const Finished run = ward.run(commands(key).front());
      INFO(key.what, ": ", way, "\n", run.out, run.err);
      CHECK(quotes(run));
    }
    for (const char* allowed : {"open", "opened", "."}) {
      for (const std::string way : {"../open/given", "given", "../opened/given"}) {
        name_file(ward, key, way);
        std::vector<std::string> command = commands(key).front();
        command.insert(command.end(), {"--allow", "nowhere", "--allow", allowed});
        const Finished run = ward.run(command);
        INFO(key.what, ": ", way, " ", allowed, "\n", run.out, run.err);
        CHECK(quotes(run));
      }
    }
    // an allowed folder is bounded as the own one is
    for (const std::string way : {"../open/evil", "../open/../out/secret", "link"}) {
      name_file(ward, key, way);
      std::vector<std::string> command = commands(key).front();
      command.insert(command.end(), {"--allow", "open"});
      const Finished run = ward.run(command);
      INFO(key.what, ": ", way, "\n", run.out, run.err);
      CHECK(refuses(run));
    }
  }
}

TEST_CASE("every command that reads a scenario takes --allow") {
  const Ward ward;
  const Key& program = kKeys.front();
  name_file(ward, program, "../out/secret");
  for (std::vector<std::string> command : commands(program)) {
    command.insert(command.end(), {"--allow", "out"});
    const Finished run = ward.run(command);
    INFO(command[0], " ", command[1], "\n", run.out, run.err);
    CHECK_FALSE(contains(run.out + run.err, "K3014"));
  }
}

TEST_CASE("the message of an outside file has key, folder and remedy") {
  const Ward ward;
  name_file(ward, kKeys.front(), "../out/secret");
  const Finished run = ward.run({"scenario", "check", "in/f.toml", "--allow", "open"});
  CHECK(contains(run.out, "error[K3014]: file outside the folder of the file that names it\n"));
  CHECK(contains(run.out, " --> in/f.toml:3:11\n"));
  CHECK(contains(run.out, "in/../out/secret lies outside"));
  CHECK(contains(run.out, "allowed: files below in, open, where links lead"));
  CHECK(contains(run.out, "--allow DIR"));
}

TEST_CASE("a called file lies below its program's folder, or an allowed one, also of a scenario's program") {
  const Ward ward;
  const Scratch& scratch = ward.scratch;
  scratch.write("out/part.ngc", "O<part> sub\nSECRET77\nO<part> endsub\n");
  scratch.write("in/main.ngc", "O<part> call\nM2\n");
  scratch.write("in/f.toml", kScenario + "program = \"main.ngc\"\nmachine = \"mill3\"\n");
  scratch.write("in/t.toml", "format = 1\n[path]\nprogram = \"main.ngc\"\nmachine = \"mill3\"\n");
  fs::create_symlink("../out/part.ngc", scratch.file("in/part.ngc"));
  for (std::vector<std::string> command : std::vector<std::vector<std::string>>{
           {"run", "in/main.ngc", "--no-log"},
           {"check", "in/main.ngc"},
           {"plan", "in/main.ngc"},
           {"canon", "in/main.ngc"},
           {"run", "-s", "in/f.toml", "--no-log"},
           {"scenario", "run", "in/f.toml"},
           {"tube", "in/t.toml"},
       }) {
    const Finished run = ward.run(command);
    INFO(command[0], "\n", run.out, run.err);
    CHECK(run.code > 0);
    CHECK(contains(run.out + run.err, "in/part.ngc is a link that leads out of its folder"));
    CHECK_FALSE(quotes(run));
    command.insert(command.end(), {"--allow", "out"});
    CHECK(quotes(ward.run(command)));
  }
  // a folder where called files are looked for is bounded, too
  fs::create_symlink("../out/part.ngc", scratch.file("open/other.ngc"));
  scratch.write("in/main.ngc", "O<other> call\nM2\n");
  CHECK_FALSE(quotes(ward.run({"check", "in/main.ngc", "--subs", "open"})));
  CHECK(quotes(ward.run({"check", "in/main.ngc", "--subs", "open", "--allow", "out"})));
}

TEST_CASE("scenarios found in a folder lie below it; the others still run") {
  const Ward ward;
  const Scratch& scratch = ward.scratch;
  const std::string good = kScenario + "program = \"p.ngc\"\nmachine = \"mill3\"\n";
  for (const char* folder : {"all", "all/a", "all/b"}) fs::create_directory(scratch.file(folder));
  scratch.write("all/a/scenario.toml", good);
  scratch.write("all/a/p.ngc", scratch.read("in/p.ngc"));
  fs::create_symlink("../../out/secret", scratch.file("all/b/scenario.toml"));
  fs::create_symlink("../out", scratch.file("all/c"));
  scratch.write("out/scenario.toml", kSecret);
  for (const char* what : {"run", "check", "list"}) {
    const Finished run = ward.run({"scenario", what, "all"});
    INFO(run.out, run.err);
    CHECK(run.code > 0);
    CHECK(contains(run.out + run.err,
                   "all/b/scenario.toml: lies outside all; --allow DIR allows files below another"));
    CHECK(contains(run.out + run.err, "all/c/scenario.toml: lies outside all"));
    CHECK_FALSE(quotes(run));
    CHECK(quotes(ward.run({"scenario", what, "all", "--allow", "out"})));
  }
  CHECK_FALSE(quotes(ward.run({"run", "-s", "all/b", "--no-log"})));
  // a file that the user names may lie anywhere
  CHECK(quotes(ward.run({"run", "-s", "all/b/scenario.toml", "--no-log"})));
}

TEST_CASE("what the user names may lie anywhere") {
  const Ward ward;
  name_file(ward, kKeys.front(), "p.ngc");
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"run", "in/link", "--no-log"},
                                             {"run", "-s", "in/f.toml", "in/../out/secret", "--no-log"},
                                             {"run", "-s", "in/f.toml", "-m", "in/link", "--no-log"},
                                             {"run", "-s", "in/f.toml", "--tools", "out/secret", "--no-log"},
                                             {"check", "in/linked/secret"},
                                             {"tube", "in/link"}})
    CHECK(quotes(ward.run(command)));
}

TEST_CASE("a log lists the files that were read: role, name as written, bytes and hash, wherever they are") {
  const Scratch scratch;
  for (const char* folder : {"one", "one/sub", "two", "two/sub", "lib"})
    fs::create_directory(scratch.file(folder));
  const std::string machine = call({"machine", "show", "mill3"}).out;
  scratch.write("lib/hole.ngc", "O<hole> sub\nG1 X#1\nO<hole> endsub\n");
  scratch.write("lib/shop.toml", machine);
  for (const std::string folder : {"one", "two"}) {
    scratch.write(folder + "/s.toml", kScenario +
                                          "program = \"sub/p.ngc\"\nmachine = \"../lib/shop.toml\"\n"
                                          "tools = \"t.tbl\"\n");
    scratch.write(folder + "/sub/p.ngc", "G21 F600\nO<hole> call [3]\nM2\n");
    scratch.write(folder + "/t.tbl", "T1 P1 Z10\n");
    const Finished run =
        call({"run", "-s", folder + "/s.toml", "--subs", "lib", "--allow", "lib", "-o", folder + ".lcmlog"},
             scratch.path());
    INFO(run.err);
    REQUIRE(run.code == 0);
  }
  CHECK(scratch.read("one.lcmlog") == scratch.read("two.lcmlog"));
  const Json files = Json::parse(call({"info", "one.lcmlog", "--json"}, scratch.path()).out)[0]["files"];
  std::string listed;
  for (const Json& file : files) {
    listed += file["role"].get<std::string>() + " " + file["name"].get<std::string>() + " " +
              std::to_string(file["bytes"].get<int>()) + "\n";
    CHECK(file["hash"].get<std::string>().size() == 16);
  }
  CHECK(listed == "scenario s.toml " + std::to_string(scratch.read("one/s.toml").size()) +
                      "\nmachine ../lib/shop.toml " + std::to_string(machine.size()) +
                      "\nprogram sub/p.ngc 29\ntools t.tbl 10\ncalled hole.ngc 34\n");
  const Finished info = call({"info", "one.lcmlog"}, scratch.path());
  CHECK(contains(info.out, "  read        scenario  " + files[0]["hash"].get<std::string>()));
  CHECK(contains(info.out, "            called    " + files[4]["hash"].get<std::string>() +
                               "            34 bytes  hole.ngc\n"));
  // another text under the same name is seen
  scratch.write("two/t.tbl", "T1 P1 Z11\n");
  call({"run", "-s", "two/s.toml", "--subs", "lib", "--allow", "lib", "-o", "two.lcmlog"}, scratch.path());
  const Json others = Json::parse(call({"info", "two.lcmlog", "--json"}, scratch.path()).out)[0]["files"];
  CHECK(others[3]["hash"] != files[3]["hash"]);
  CHECK(others[2] == files[2]);
}

TEST_CASE(
    "of a run without a scenario a log lists what the user named, without folders; a shipped machine is no "
    "file") {
  const Scratch scratch;
  fs::create_directory(scratch.file("in"));
  scratch.write("in/p.ngc", "G0 X1\nM2\n");
  REQUIRE(call({"run", "in/p.ngc", "-m", "mill3", "-o", "a.lcmlog"}, scratch.path()).code == 0);
  const Json files = Json::parse(call({"info", "a.lcmlog", "--json"}, scratch.path()).out)[0]["files"];
  REQUIRE(files.size() == 1);
  CHECK(files[0]["role"] == "program");
  CHECK(files[0]["name"] == "p.ngc");
  REQUIRE(call({"run", "-", "-o", "b.lcmlog"}, scratch.path(), "G0 X1\nM2\n").code == 0);
  const Json piped = Json::parse(call({"info", "b.lcmlog", "--json"}, scratch.path()).out)[0]["files"];
  CHECK(piped[0]["name"] == "stdin");
  CHECK(piped[0]["hash"] == files[0]["hash"]);
}
