#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;

namespace {

std::vector<std::string> words(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) out.push_back(word);
  return out;
}

struct HelpLine {
  std::string names;        ///< "-m,--machine"
  std::string type;         ///< "FILE|NAME"; empty: a flag
  std::string description;  ///< with its further lines
};

struct HelpText {
  std::vector<HelpLine> options;
  std::vector<std::string> commands;
};

/// Lines of a help text: two or four blanks, names and type up to a gap of two blanks or the line's end, description.
HelpText parse_help(const std::string& text) {
  HelpText help;
  std::istringstream stream(text);
  bool commands = false;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line[0] != ' ') commands = line == "Subcommands:";
    const auto begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    if (begin >= 10) {
      if (!help.options.empty()) help.options.back().description += line.substr(begin);
      continue;
    }
    if (commands && begin == 2) help.commands.push_back(words(line).front());
    if (line[begin] != '-') continue;
    const auto gap = line.find("  ", begin);
    const std::vector<std::string> left =
        words(line.substr(begin, gap == std::string::npos ? gap : gap - begin));
    const auto description = gap == std::string::npos ? gap : line.find_first_not_of(' ', gap);
    help.options.push_back({left.front(), left.size() > 1 ? left[1] : "",
                            description == std::string::npos ? "" : line.substr(description)});
  }
  return help;
}

std::string long_name(const HelpLine& option) {
  const auto at = option.names.find("--");
  return at == std::string::npos ? option.names.substr(0, 2) : option.names.substr(at);
}

void check_help(const std::string& command, int& options) {
  std::vector<std::string> arguments = words(command);
  arguments.push_back("--help");
  const HelpText help = parse_help(call(arguments).out);
  CAPTURE(command);
  CHECK_FALSE(help.options.empty());
  for (const HelpLine& option : help.options) {
    CAPTURE(option.names);
    ++options;
    CHECK(option.description.size() > 5);
    for (const char* raw : {"TEXT", "INT", "UINT", "FLOAT"}) CHECK(option.type != raw);
    if (option.names == "-h,--help" || option.names == "--version") continue;
    // an option without type is a flag: an option after it does not mean a missing value
    arguments.back() = long_name(option);
    arguments.push_back("--no-such-option");
    const std::string told = call(arguments).err;
    CAPTURE(told);
    CHECK(contains(told, option.type.empty() ? "there is no option --no-such-option"
                                             : "needs a value (" + option.type + "), but --no-such-option"));
    arguments.pop_back();
  }
  for (const std::string& sub : help.commands)
    check_help(command.empty() ? sub : command + " " + sub, options);
}

}  // namespace

TEST_CASE("usage mistakes are named in the order of the arguments, with the nearest word that is known") {
  const struct {
    const char* line;
    const char* complaint;
  } cases[] = {
      {"run p.ngc -m router.toml --resume 1820", "kadr run: there is no option --resume\n"},
      {"plot p.lcmlog --from-line 18", "kadr plot: there is no option --from-line; did you mean --from?\n"},
      {"report p.lcmlog --out x", "kadr report: there is no option --out; did you mean --output?\n"},
      {"wind helix --diameter-mm 120 x", "kadr wind helix: there is no option --diameter-mm\n"},
      {"check p.ngc --frm-line 10", "kadr check: there is no option --frm-line; did you mean --from-line?\n"},
      {"run p.ngc --machin x --bogus", "kadr run: there is no option --machin; did you mean --machine?\n"},
      {"export p.lcmlog --cvs", "did you mean --csv?\n"},
      {"run -xq p.ngc", "kadr run: there is no option -xq\n"},
      {"--json run p.ngc", "kadr: there is no option --json; options follow the command\n"},
      {"chek p.ngc", "kadr: there is no command 'chek'; did you mean check? Commands: run, "},
      {"teach tabel", "kadr teach: there is no command 'tabel'; did you mean table? Commands: "},
      {"machine nwe", "kadr machine: there is no command 'nwe'; did you mean new? Commands: show, "},
      {"run p.ngc -m", "kadr run: -m needs a value (FILE|NAME)\n"},
      {"run p.ngc --until --json", "kadr run: --until needs a value (S), but --json follows\n"},
      {"run p.ngc -m a --machine=b", "kadr run: --machine is given twice: 'a' and 'b'; it takes one value\n"},
      {"run p.ngc --json --json", "kadr run: --json is given twice; once is enough\n"},
      {"run p.ngc --no-log=3", "kadr run: --no-log takes no value; got '3'\n"},
      {"run p.ngc q.ngc", "kadr run: takes one PROG; 'q.ngc' is one too many\n"},
      {"diff a b c", "kadr diff: takes A and B; 'c' is one too many\n"},
      {"compare a", "kadr compare: takes at least 2 LOG; got 1\n"},
      {"check p.ngc -machine mill3", "kadr check: there is no option -machine; did you mean --machine?\n"},
      {"check p.ngc -set=a=1", "kadr check: there is no option -set; did you mean --set?\n"},
      {"run p.ngc --machine=", "kadr run: --machine needs a value (FILE|NAME); got an empty one\n"},
      {"run p.ngc -- -m mill3", "kadr run: takes one PROG; '-m' is one too many\n"},
      {"export l.lcmlog", "kadr export: needs one of --csv, --excel, --json, --vcd, --svg, --list\n"},
      {"export l.lcmlog --csv --svg", "--svg, --list; got --csv, --svg\n"},
      {"completion tcsh", "kadr completion: SHELL: one of bash, zsh, fish; got 'tcsh'\n"},
      {"run p.ngc --threads 3", "kadr run: --threads takes 1 or 2; got '3'\n"},
      {"run p.ngc --no-log -o x.lcmlog",
       "kadr run: --no-log writes no log, --log writes 'x.lcmlog': give only one of them\n"},
      {"help chek", "kadr: there is no command 'chek'; did you mean check? Commands: run, "},
      {"help run p.ngc", "kadr run: has no commands; got 'p.ngc'\n"},
      {"version x", "kadr version: takes no argument; got 'x'\n"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.line);
    const Finished run = call(words(c.line));
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CAPTURE(run.err);
    CHECK(contains(run.err, c.complaint));
    CHECK(contains(run.err, "\nsee kadr"));
    CHECK(run.err.ends_with(" --help\n"));
  }
}

TEST_CASE("what looks like a mistake and is none") {
  // numbers and - are no options, values may be attached, -- ends the options, help comes in spite of a mistake
  CHECK(contains(call({"law", "--xi", "-0.3"}).err, "xi is -0.3"));
  CHECK(call({"canon", "-"}, ".", "M2\n").code == 0);
  CHECK(call({"canon", "--lines=1-2", "--", "-"}, ".", "M2\n").code == 0);
  CHECK(call({"machine", "show", "--set", "feed.max_mm_s=80", "--set", "feed.max_mm_s=90"}).code == 0);
  CHECK(call({"run", "--bogus", "--help"}).code == 0);
  CHECK(contains(call({"check", "./--bogus"}).err, "No such file"));
}

TEST_CASE("kadr help prints what --help prints") {
  CHECK(call({"help"}).out == call({"--help"}).out);
  CHECK(call({"help", "machine", "new"}).out == call({"machine", "new", "--help"}).out);
  const Finished run = call({"help", "run"});
  CHECK(run.code == 0);
  CHECK(contains(run.out, "--no-log"));
}

TEST_CASE("a scenario that is not there: what was looked for, and where scenarios are") {
  const kadr::test::Scratch scratch;
  for (const char* command : {"run", "list", "check"}) {
    const Finished none = call({"scenario", command}, scratch.path());
    CHECK(none.code == 2);
    CHECK(none.err ==
          "kadr: there is no scenario file scenarios, scenarios/scenario.toml or scenarios/*/scenario.toml; "
          "give a scenario file or a folder; installed scenarios are in PREFIX/share/kadr/scenarios\n");
    CHECK(contains(call({"scenario", command, "02_poket"}, scratch.path()).err,
                   "kadr: there is no scenario file 02_poket, "));
  }
}

TEST_CASE("an empty argument is named") {
  const Finished file = call({"check", ""});
  CHECK(file.code == 2);
  CHECK(contains(file.err, "kadr check: PROG is empty: ''\n"));
  const Finished value = call({"check", "p.ngc", "-m", ""});
  CHECK(value.code == 2);
  CHECK(contains(value.err, "kadr check: --machine needs a value (FILE|NAME); got an empty one\n"));
}

TEST_CASE("every option of every command has a description, and a type name if it takes a value") {
  int options = 0;
  check_help("", options);
  CHECK(options > 150);
}
