#include <doctest/doctest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "machine/base/hash.h"
#include "machine/base/utf8.h"
#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"
#include "tests/emulator/log/log_events.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Launch;
using kadr::test::run_kadr;
using kadr::test::Scratch;
namespace test = kadr::test;

/// Every place where a text of a stranger can reach a terminal.
namespace {

// ESC and BEL (a title), DEL, CSI as a C1 character, marks, overrides and isolates of direction, a zero-width space
const std::string kForeign =
    "a\x1b]0;x\x07\x1b[31m\x7F\xC2\x9B"
    "2J\xD8\x9C\xE2\x80\x8F\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8B";
// the same with CSI as a byte that is not UTF-8, and a second line that looks like ours
const std::string kName = kForeign + "\x9B\nforged";

/// What of a text may not reach a terminal, by name; empty if nothing. Stated without the product's rule.
std::string raw(const std::string& text) {
  for (const char c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == '\x7F')
      return "control character " + std::to_string(static_cast<unsigned char>(c));
  for (const char* mark :
       {"\xC2\x9B", "\xD8\x9C", "\xE2\x80\x8F", "\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x80\x8B"})
    if (contains(text, mark)) return "code point " + std::to_string(kadr::decode_utf8(mark, 0).value);
  if (!kadr::is_utf8(text)) return "bytes that are not UTF-8";
  if (contains(text, "\nforged")) return "a line of its own";
  return "";
}

bool has_mark(const std::string& text) {
  return contains(text, "\xEF\xBF\xBD") || contains(text, "\\u001b") || contains(text, "\\u202e") ||
         contains(text, "%1B");
}

/// Calls kadr and demands that nothing raw goes out, and that the foreign text was there.
Finished check_clean(const std::vector<std::string>& arguments, const std::string& folder) {
  const Finished done = call(arguments, folder);
  std::string command;
  for (const std::string& word : arguments) command += word.substr(0, word.find('\x1b')) + ' ';
  CAPTURE(command);
  CAPTURE(done.out);
  CAPTURE(done.err);
  CHECK(raw(done.out) == "");
  CHECK(raw(done.err) == "");
  CHECK(has_mark(done.out + done.err));
  CHECK(done.signal == 0);
  CHECK(done.code != 70);
  return done;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// As TOML spells it.
std::string toml_escaped(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const kadr::CodePoint c = kadr::decode_utf8(text, at);
    char digits[16];
    std::snprintf(digits, sizeof digits, "\\U%08X", static_cast<unsigned>(c.value));
    out += c.value >= 0x20 && c.value < 0x7F ? std::string(1, static_cast<char>(c.value)) : digits;
    at += c.bytes;
  }
  return out;
}

/// A copy of mill3 with another name.
std::string machine_named(const std::string& name, const std::string& folder) {
  const std::string mill3 = call({"machine", "show", "mill3"}, folder).out;
  return replaced(mill3, "name = \"mill3\"", "name = \"" + toml_escaped(name) + "\"");
}

}  // namespace

TEST_CASE("names of files are shown as text on one line, in every message") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  const std::string program = kName + ".ngc", log = kName + ".lcmlog", other = kName + "2.lcmlog",
                    machine = kName + ".toml";
  scratch.write(program, test::kSquare);
  scratch.write(kName + "bad.ngc", test::kSixMistakes);
  scratch.write(kName + "untidy.ngc", "g1   x1 f600\nm2\n");
  scratch.write(machine, machine_named("m", folder));
  scratch.write("program.ngc", test::kSquare);
  using Words = std::vector<std::string>;
  for (const Words& arguments :
       std::vector<Words>{{"check", kName},
                          {"check", program},
                          {"check", program, "--json"},
                          {"check", program, "-m", machine},
                          {"check", program, "-m", kName},
                          {"check", kName + "bad.ngc"},
                          {"check", kName + "bad.ngc", "--color", "always", "-q", "--format", "gcc"},
                          {"check", kName + "bad.ngc", "--format", "json"},
                          {"check", kName + "bad.ngc", "--format", "sarif"},
                          {"check", "program.ngc", "--tools", kName},
                          {"check", "program.ngc", "--set", kName},
                          {"check", "program.ngc", "--set", kName + "=1"},
                          {"check", "program.ngc", "--limit", kName},
                          {"check", "program.ngc", "--dialect", kName},
                          {"check", "program.ngc", "--" + kName},
                          {"check", "program.ngc", "-" + kName},
                          {"check", "program.ngc", "--max-errors", kName},
                          {kName},
                          {"help", kName},
                          {"plan", kName},
                          {"plan", "program.ngc", kName},
                          {"canon", kName},
                          {"canon", kName + "bad.ngc"},
                          {"fmt", kName},
                          {"fmt", "--check", kName + "untidy.ngc"},
                          {"fmt", "--in-place", kName + "bad.ngc"},
                          {"run", program, "-o", log},
                          {"run", program, "-o", log, "--json"},
                          {"run", program, "-o", kName + "/none.lcmlog"},
                          {"run", program, "--no-log"},
                          {"run", "program.ngc", "--no-log", "--publish", kName},
                          {"run", "program.ngc", "--no-log", "--publish", "udpm://" + kName},
                          {"info", log},
                          {"info", log, "--json"},
                          {"info", program},
                          {"info", kName},
                          {"run", program, "-o", other, "--until", "0.5"},
                          {"diff", log, other},
                          {"diff", log, kName},
                          {"compare", log, log},
                          {"compare", log, kName},
                          {"compare", log, log, "-o", kName + ".html"},
                          {"export", log, "--csv", "-o", kName + ".csv"},
                          {"export", kName, "--csv"},
                          {"export", log, "--csv", "--signals", kName},
                          {"plot", kName},
                          {"report", log, "-o", kName + ".html"},
                          {"report", log, "--plain", "-o", kName + "/none.html"},
                          {"machine", "check", machine},
                          {"machine", "check", kName},
                          {"machine", "show", kName},
                          {"machine", "new", kName},
                          {"scenario", "run", kName},
                          {"scenario", "check", machine},
                          {"scenario", "list", machine},
                          {"tube", kName},
                          {"tube", machine},
                          {"law", kName},
                          {"teach", "table", kName},
                          {"teach", "bezier", kName},
                          {"teach", "table", "line", "3,2", "--method", kName},
                          {"wind", kName},
                          {"explain", kName},
                          {"completion", kName}})
    check_clean(arguments, folder);
}

TEST_CASE("a program's text is shown as text: in diagnostics, plan and canon") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  scratch.write("message.ngc", "(MSG," + kForeign + "\x9B)\nF600 G1 X1 (" + kForeign + ")\nM2\n");
  scratch.write("word.ngc", "G1 Q1 (" + kForeign + "\x9B)\nG1 X1 " + kForeign + "\nM2\n");
  scratch.write("called.ngc", "O<" + kForeign + "> call\nM2\n");
  scratch.write("parameter.ngc", "G1 X#<" + kForeign + "> F600\nM2\n");
  using Words = std::vector<std::string>;
  // a name has any characters but control characters
  const std::string marks = "m \xD8\x9C\xE2\x80\x8F\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8B";
  scratch.write("called_marks.ngc", "O<" + marks + "> call\nM2\n");
  scratch.write("parameter_marks.ngc", "G1 X#<" + marks + "> F600\nM2\n");
  check_clean({"check", "called.ngc"}, folder);
  check_clean({"check", "parameter.ngc"}, folder);
  for (const char* program : {"called_marks.ngc", "parameter_marks.ngc"})
    for (const Words& format : std::vector<Words>{
             {}, {"--format", "gcc"}, {"--format", "json"}, {"--format", "sarif"}, {"--json"}}) {
      Words arguments = {"check", program};
      arguments.insert(arguments.end(), format.begin(), format.end());
      check_clean(arguments, folder);
    }
  check_clean({"check", "word.ngc"}, folder);
  check_clean({"check", "word.ngc", "--format", "sarif"}, folder);
  check_clean({"canon", "message.ngc"}, folder);
  check_clean({"canon", "message.ngc", "--json"}, folder);
  check_clean({"canon", "parameter.ngc"}, folder);
  check_clean({"plan", "message.ngc"}, folder);
  check_clean({"plan", "message.ngc", "--json"}, folder);
  check_clean({"fmt", "message.ngc", "--json"}, folder);

  // JSON keeps every character, each as an escape
  const auto calls = nlohmann::json::parse(call({"canon", "message.ngc", "--json"}, folder).out);
  CHECK(contains(calls["calls"][0]["arguments"][0].get<std::string>(), kForeign));
  // colours are those of kadr alone
  const Finished coloured = call({"check", "word.ngc", "--color", "always"}, folder);
  CHECK(contains(coloured.out, "\x1b[1;31merror"));
  CHECK_FALSE(contains(coloured.out, "\x1b[31m"));
  CHECK_FALSE(contains(coloured.out, "\x1b]"));
}

TEST_CASE("names of machines and scenarios are shown as text") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  const std::string name = kForeign + "\nforged";
  scratch.write("program.ngc", test::kSquare);
  // a machine's name has no control characters (K3008)
  const std::string marks = "m \xD8\x9C\xE2\x80\x8F\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8B";
  scratch.write("machine.toml", machine_named(marks, folder));
  scratch.write("scenario.toml", "format = 1\nname = \"" + toml_escaped(name) + "\"\nsummary = \"" +
                                     toml_escaped(name) +
                                     "\"\nprogram = \"program.ngc\"\nmachine = \"mill3\"\n"
                                     "[[expect.signal]]\nname = \"axis." +
                                     toml_escaped(name) + "\"\nleast = 0\nmost = 1\n");
  scratch.write("unknown.toml", "format = 1\n\"" + toml_escaped(name) + "\" = 1\n");
  using Words = std::vector<std::string>;
  for (const Words& arguments :
       std::vector<Words>{{"scenario", "run", "scenario.toml"},
                          {"scenario", "run", "scenario.toml", "--json"},
                          {"scenario", "run", "scenario.toml", "--junit", "-"},
                          {"scenario", "check", "scenario.toml"},
                          {"scenario", "check", "unknown.toml"},
                          {"scenario", "list", "scenario.toml"},
                          {"scenario", "list", "scenario.toml", "--json"},
                          {"run", "--scenario", "scenario.toml", "--no-log"},
                          {"run", "--scenario", "scenario.toml", "--no-log", "--json"},
                          {"machine", "check", "machine.toml"},
                          {"machine", "check", "unknown.toml"},
                          {"machine", "check", "machine.toml", "--json"},
                          {"machine", "show", "machine.toml", "--json"},
                          {"check", "program.ngc", "-m", "machine.toml"},
                          {"run", "program.ngc", "-m", "machine.toml", "--no-log"}})
    check_clean(arguments, folder);

  // a machine that is shown can be read again, and has its name
  const Finished shown = call({"machine", "show", "machine.toml"}, folder);
  CHECK(raw(shown.out) == "");
  scratch.write("again.toml", shown.out);
  const auto again = nlohmann::json::parse(call({"machine", "check", "again.toml", "--json"}, folder).out);
  CHECK(again[0]["name"] == marks);
}

TEST_CASE("a stranger's log is shown as text: names, messages and channels") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  // texts of the length of the foreign one, so that it fits into their places
  const std::string stand_in(kForeign.size(), 'q');
  scratch.write(stand_in + ".ngc", "(MSG," + stand_in + ")\n" + test::kSquare);
  scratch.write("machine.toml", machine_named(stand_in, folder));
  REQUIRE(call({"run", stand_in + ".ngc", "-m", "machine.toml", "-q", "-o", "true.lcmlog"}, folder).code ==
          0);
  const std::string channel = "\x1b]0;wxyz\x07\xE2\x80\xAE\xC2\x9B";
  REQUIRE(channel.size() == std::string("KADR_BLOCK_END").size());
  // its hashes fit, so that what it says is believed
  const auto hash_bytes = [](const std::string& text) {
    kadr::Hash64 hash;
    hash.bytes(text.data(), text.size());
    std::string bytes;
    for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(hash.digest() >> shift & 0xFF);
    return bytes;
  };
  const auto sealed = [](const std::string& log) {
    auto events = test::events_of({log.begin(), log.end()});
    test::seal(events);
    const auto bytes = test::log_of(events);
    return std::string(bytes.begin(), bytes.end());
  };
  const std::string program = scratch.read(stand_in + ".ngc");
  const std::string with_texts =
      replaced(replaced(scratch.read("true.lcmlog"), stand_in, kForeign), hash_bytes(program),
               hash_bytes(replaced(program, stand_in, kForeign)));
  scratch.write("texts.lcmlog", sealed(with_texts));
  scratch.write("channel.lcmlog", sealed(replaced(with_texts, "KADR_BLOCK_END", channel)));
  using Words = std::vector<std::string>;
  for (const std::string log : {"texts.lcmlog", "channel.lcmlog"})
    for (const Words& arguments : std::vector<Words>{{"info", log},
                                                     {"info", log, "--json"},
                                                     {"diff", "true.lcmlog", log},
                                                     {"diff", "true.lcmlog", log, "--json"},
                                                     {"diff", "true.lcmlog", log, "--align", "path"},
                                                     {"compare", "true.lcmlog", log},
                                                     {"compare", "true.lcmlog", log, "--json"},
                                                     {"export", log, "--json"},
                                                     {"report", log, "--plain", "-o", "-"}})
      check_clean(arguments, folder);
}

TEST_CASE(
    "what is written for a file keeps its bytes in files and pipes, and is shown as text on a terminal") {
  const Scratch scratch;
  const std::string& folder = scratch.path();
  const std::string text = "(" + kForeign + "\x9B)\nG1 X1 F600\nM2\n";
  scratch.write("program.ngc", text);
  CHECK(contains(call({"fmt", "program.ngc"}, folder).out, kForeign + "\x9B"));
  CHECK(contains(call({"plan", "program.ngc", "--csv"}, folder).out, "text"));
  if (test::lacks_terminals()) return;
  Launch launch;
  launch.folder = folder;
  launch.terminal = true;
  using Words = std::vector<std::string>;
  for (const Words& arguments : std::vector<Words>{{"fmt", "program.ngc"},
                                                   {"canon", "program.ngc"},
                                                   {"run", "program.ngc", "-q", "-o", "/dev/stdout"}}) {
    launch.arguments = arguments;
    Finished done = run_kadr(launch);
    CAPTURE(arguments.front());
    CHECK(done.code == 0);
    // a terminal turns "\n" into "\r\n"
    CHECK(raw(replaced(done.out, "\r\n", "\n")) == "");
    CHECK(has_mark(done.out));
  }
}
