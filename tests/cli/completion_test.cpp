#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

/// What `kadr --help` and the help of every command name is in the manual page and in the completions. The
/// help texts are read as text, so that a command which the tree of completions forgets is seen.
namespace test = kadr::test;
using test::call;
using test::contains;
using test::Finished;
using test::has_program;
using test::Scratch;
using test::shell;

namespace {

struct HelpedCommand {
  std::string path;                  ///< "", " run", " machine show"
  std::vector<std::string> options;  ///< "-m", "--machine"
  std::vector<std::string> worded;   ///< of these, those that take a WORD
  std::string example;               ///< a command line; empty: none
};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// "-m,--machine FILE|NAME" -> -m, --machine
void read_names(const std::string& line, HelpedCommand& command) {
  const std::vector<std::string> words = words_of(line);
  if (words.empty() || words.front().front() != '-') return;
  std::istringstream list(words.front());
  for (std::string name; std::getline(list, name, ',');) {
    command.options.push_back(name);
    if (words.size() > 1 && words[1] == "WORD") command.worded.push_back(name);
  }
}

void read_help(const std::string& path, std::vector<HelpedCommand>& commands) {
  std::vector<std::string> arguments = words_of(path);
  arguments.push_back("--help");
  const Finished help = call(arguments);
  REQUIRE(help.code == 0);
  HelpedCommand command;
  command.path = path;
  std::vector<std::string> below;
  std::istringstream lines(help.out);
  bool in_commands = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Example: ")) {
      command.example = line.substr(9);
    } else if (!line.starts_with("  ")) {
      in_commands = line == "Subcommands:";
    } else if (in_commands) {
      // a name is at the margin, its text is indented deeper
      if (line[2] != ' ') below.push_back(path + ' ' + words_of(line).front());
    } else {
      read_names(line, command);
    }
  }
  commands.push_back(std::move(command));
  for (const std::string& sub : below) read_help(sub, commands);
}

const std::vector<HelpedCommand>& all_commands() {
  static const std::vector<HelpedCommand> commands = [] {
    std::vector<HelpedCommand> list;
    read_help("", list);
    return list;
  }();
  return commands;
}

/// From a mark to the next line that begins with `end`.
std::string part_of(const std::string& text, const std::string& mark, const std::string& end) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return {};
  return text.substr(at, text.find(end, at + mark.size()) - at);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// What bash offers for the last of these words, sorted, with blanks between.
std::string offered(const std::string& words, const std::string& folder = ".") {
  const Finished done = shell("source <(kadr completion bash); COMP_WORDS=(" + words +
                                  "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _kadr; printf '%s\\n' "
                                  "\"${COMPREPLY[@]}\" | LC_ALL=C sort",
                              folder);
  CHECK(done.code == 0);
  CHECK(done.err.empty());
  std::string out;
  std::istringstream lines(done.out);
  for (std::string line; std::getline(lines, line);) out += (out.empty() ? "" : " ") + line;
  return out;
}

}  // namespace

TEST_CASE("the help has commands and options to compare with") {
  std::set<std::string> paths;
  std::size_t options = 0;
  for (const HelpedCommand& c : all_commands()) {
    paths.insert(c.path);
    options += c.options.size();
  }
  for (const char* path : {"", " run", " machine", " machine show", " wind hoop", " teach table", " export"})
    CHECK(paths.contains(path));
  CHECK(options > 250);
}

TEST_CASE("the manual page has every command and every option of the help") {
  const std::string page = call({"man"}).out;
  for (const HelpedCommand& c : all_commands()) {
    CAPTURE(c.path);
    const std::string title = c.path.empty() ? ".SH OPTIONS\n" : ".SS \\fBkadr" + c.path + "\\fR";
    const std::string part = part_of(page, title, c.path.empty() ? "\n.SH" : "\n.S");
    CHECK(!part.empty());
    for (const std::string& option : c.options) {
      // said once for all commands
      if (!c.path.empty() && (option == "--help" || option == "-h")) continue;
      CAPTURE(option);
      CHECK(contains(part, "\\fB" + replaced(option, "-", "\\-") + "\\fR"));
    }
  }
}

TEST_CASE("bash offers every command and every option of the help") {
  // one bash for all: each line that it prints is a word that it does not offer
  std::string script =
      "source <(kadr completion bash)\n"
      "offers() { local word=$1; shift; COMP_WORDS=(kadr \"$@\" \"$word\"); COMP_CWORD=$(($# + 1)); _kadr\n"
      "  for w in \"${COMPREPLY[@]}\"; do [[ $w == \"$word\" ]] && return; done; echo \"kadr $* $word\"; }\n";
  for (const HelpedCommand& c : all_commands()) {
    if (!c.path.empty()) {
      const auto blank = c.path.rfind(' ');
      script += "offers " + c.path.substr(blank + 1) + c.path.substr(0, blank) + '\n';
    }
    for (const std::string& option : c.options) script += "offers " + option + c.path + '\n';
  }
  const Finished done = shell(script);
  CHECK(done.code == 0);
  CHECK(done.out == "");
  CHECK(done.err == "");
}

TEST_CASE("zsh's and fish's scripts have every command and every option of the help") {
  const std::string zsh = call({"completion", "zsh"}).out, fish = call({"completion", "fish"}).out;
  for (const HelpedCommand& c : all_commands()) {
    CAPTURE(c.path);
    const std::string function = "\n_kadr" + replaced(c.path, " ", "_") + "() {\n";
    const std::string part = part_of(zsh, function, "\n}\n");
    CHECK(!part.empty());
    for (const std::string& option : c.options) {
      CAPTURE(option);
      CHECK((contains(part, "'" + option + "'[") || contains(part, "'" + option + "='[")));
      const std::string flag =
          option.starts_with("--") ? " -l " + option.substr(2) : " -s " + option.substr(1);
      const std::string at = "\"__kadr_at '" + c.path + "'\"";
      std::istringstream lines(fish);
      bool found = false;
      for (std::string line; std::getline(lines, line);)
        found = found || (contains(line, at) && contains(line + ' ', flag + ' '));
      CHECK(found);
    }
  }
}

TEST_CASE("bash completes commands, values of vocabularies, and files of the right kind") {
  const Scratch scratch;
  for (const char* name : {"a.lcmlog", "b.ngc", "two words.ngc", "m.toml"}) scratch.write(name, "");
  REQUIRE(shell("mkdir folder", scratch.path()).code == 0);
  const auto at = [&](const std::string& words) { return offered(words, scratch.path()); };
  CHECK(at("kadr mach") == "machine");
  CHECK(at("kadr machine ''") == "check keys list new show");
  CHECK(at("kadr completion ''") == "bash fish zsh");
  CHECK(at("kadr run b.ngc -m ''") == "folder m.toml mill3 rig1 robot7 winder4");
  CHECK(at("kadr run --machine = mi") == "mill3");
  CHECK(at("kadr run --color ''") == "always auto never");
  CHECK(at("kadr check --format = s") == "sarif");
  CHECK(at("kadr canon --dialect ''") == "auto fanuc grbl haas linuxcnc mach3 marlin reprap");
  CHECK(at("kadr run --limit ''") ==
        "blocks= call_depth= file_bytes= line_bytes= lines= log_bytes= loop_passes= messages= nurbs_order=");
  CHECK(at("kadr run --limit blocks = ''") == "");
  CHECK(at("kadr run --threads ''") == "1 2");
  CHECK(at("kadr diff --tolerance l") == "link= link_rate= load=");
  CHECK(at("kadr explain K2107") == "K2107");
  CHECK(at("kadr teach table ell") == "ellipse");
  CHECK(at("kadr info ''") == "a.lcmlog folder");
  CHECK(at("kadr run ''") == "a.lcmlog b.ngc folder m.toml two words.ngc");
  CHECK(at("kadr run --subs ''") == "folder");
  CHECK(at("kadr tube --allow ''") == "folder");
  CHECK(at("kadr scenario run ''") == "folder m.toml");
  // a number of seconds can't be guessed
  CHECK(at("kadr run --until ''") == "");
  CHECK(at("kadr wind hoop --le") == "--length-mm");
}

TEST_CASE("an option that takes a WORD offers its words, and each of them is taken") {
  std::size_t options = 0;
  for (const HelpedCommand& c : all_commands())
    for (const std::string& option : c.worded) {
      CAPTURE(c.path);
      CAPTURE(option);
      const std::vector<std::string> words = words_of(offered("kadr" + c.path + ' ' + option + " ''"));
      CHECK(words.size() >= 2);
      ++options;
      // the help after a bad word: the words are good if it is not about this option
      for (const std::string& word : words) {
        std::vector<std::string> arguments = words_of(c.path);
        for (const char* more : {option.c_str(), word.c_str(), "--no-such-option"})
          arguments.emplace_back(more);
        CHECK_FALSE(contains(call(arguments).err, option + " knows"));
      }
    }
  CHECK(options > 30);
}

TEST_CASE("the examples in help texts and manual page are command lines that kadr understands") {
  const Scratch scratch;
  std::size_t examples = 0;
  for (const HelpedCommand& c : all_commands()) {
    if (c.example.empty()) continue;
    ++examples;
    CAPTURE(c.example);
    CHECK(c.example.find("kadr" + c.path) != std::string::npos);
    // the files that they name are not there; how the words are read is the question
    const Finished done = shell(c.example, scratch.path());
    CHECK_FALSE(contains(done.err, "\nsee kadr"));
    CHECK(done.code != 70);
  }
  CHECK(examples > 15);
}

TEST_CASE("bash's script reads without a warning, and an unknown shell is refused with the known ones") {
  CHECK(shell("kadr completion bash | bash -n").err.empty());
  const Finished other = call({"completion", "tcsh"});
  CHECK(other.code == 2);
  CHECK(contains(other.err, "bash, zsh, fish; got 'tcsh'"));
  CHECK(call({"completion"}).code == 2);
}

TEST_CASE("zsh reads its script") {
  if (!has_program("zsh")) return;
  const Finished done = shell("kadr completion zsh >_kadr && zsh -n _kadr", Scratch().path());
  CHECK(done.code == 0);
  CHECK(done.err == "");
}

TEST_CASE("fish completes commands, options and values by its script") {
  if (!has_program("fish")) return;
  const Scratch scratch;
  const auto at = [&](const std::string& line) {
    const Finished done =
        shell("fish --private -c \"kadr completion fish | source; complete -C '" + line + "'\" | cut -f 1",
              scratch.path());
    CHECK(done.err == "");
    return done.out;
  };
  CHECK(at("kadr mach") == "machine\n");
  CHECK(at("kadr machine sh") == "show\n");
  CHECK(at("kadr run --color a") == "always\nauto\n");
  CHECK(at("kadr run -m mi") == "mill3\n");
  CHECK(at("kadr run --prog") == "--progress\n");
  CHECK(at("kadr completion ") == "bash\nzsh\nfish\n");
}

TEST_CASE("man formats the manual page without a warning") {
  if (!has_program("man")) return;
  const Scratch scratch;
  const Finished page = shell("kadr man >kadr.1 && MANWIDTH=100 man --warnings=w -l kadr.1", scratch.path());
  CHECK(page.code == 0);
  CHECK(page.err == "");
  for (const char* title :
       {"NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "EXIT STATUS", "FILES", "EXAMPLES"})
    CHECK(contains(page.out, fmt::format("\n{}\n", title)));
  CHECK(contains(page.out, "kadr - deterministic emulator of CNC machines"));
}

TEST_CASE(
    "what the help of kadr says for all commands stands in the manual page once, in sections of their own") {
  const std::string page = call({"man"}).out;
  CHECK_FALSE(contains(page, "shows details"));
  CHECK(page.find("stopped by a signal") == page.rfind("stopped by a signal"));
  // the text below a command's options is there
  CHECK(contains(part_of(page, ".SS \\fBkadr wind\\fR", "\n.S"), "carriage"));
}

TEST_CASE("the manual page is the same text at every call and carries no date") {
  const std::string page = call({"man"}).out;
  CHECK(page == call({"man"}).out);
  CHECK(contains(page, ".TH KADR 1 \"\" \"kadr "));
}
