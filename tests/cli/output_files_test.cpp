#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

namespace test = kadr::test;
using test::call;
using test::contains;
using test::Finished;
using test::Launch;
using test::Scratch;
using test::shell;

namespace {

const std::string kProblemFile =
    "format = 1\n[path]\nlength_mm = 10\nnodes = 21\nmax_mm_s = 50\nmax_acceleration_mm_s2 = 500\n"
    "[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = 40\nmax_acceleration_mm_s2 = 100\nslope_mm = 10\n";

/// A program, a file that it calls, a tool table, a machine, a problem, a scenario and a log.
void write_inputs(const Scratch& scratch) {
  scratch.write("p.ngc", test::kSquare);
  scratch.write("main.ngc", "G21 G90 F600\no<lib> call\nM2\n");
  scratch.write("lib.ngc", "o<lib> sub\nG1 X1\no<lib> endsub\n");
  scratch.write("tools.tbl", "T1 P1 Z10\n");
  scratch.write("t.toml", kProblemFile);
  scratch.write(
      "s.toml",
      "format = 1\nname = \"s\"\nsummary = \"a square\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n");
  REQUIRE(call({"machine", "new", "m"}, scratch.path()).code == 0);
  REQUIRE(call({"run", "p.ngc", "-q", "-o", "l.lcmlog"}, scratch.path()).code == 0);
  std::filesystem::create_symlink("l.lcmlog", scratch.file("link"));
}

}  // namespace

TEST_CASE("no command writes over a file that it has read, by whatever name") {
  const Scratch scratch;
  write_inputs(scratch);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"run p.ngc -o p.ngc", "p.ngc"},
      {"run - -o p.ngc <p.ngc", "p.ngc"},
      {"run main.ngc -o lib.ngc", "lib.ngc"},
      {"run p.ngc -m m.toml -o m.toml", "m.toml"},
      {"run p.ngc --tools tools.tbl -o ./tools.tbl", "tools.tbl"},
      {"run -s s.toml -o s.toml", "s.toml"},
      {"run -s s.toml -o p.ngc", "p.ngc"},
      {"report l.lcmlog -o l.lcmlog", "l.lcmlog"},
      {"report link -o l.lcmlog", "l.lcmlog"},
      {"report l.lcmlog -o link", "l.lcmlog"},
      {"compare p.lcmlog l.lcmlog -o l.lcmlog", "l.lcmlog"},
      {"export l.lcmlog --csv -o ../$(basename $PWD)/l.lcmlog", "l.lcmlog"},
      {"tube t.toml --csv t.toml", "t.toml"},
      {"tube t.toml --page t.toml", "t.toml"},
      {"machine new m --from m.toml --force", "m.toml"},
      {"scenario run s.toml --junit s.toml", "s.toml"},
      {"scenario run s.toml --junit p.ngc", "p.ngc"},
  };
  REQUIRE(shell("cp l.lcmlog p.lcmlog", scratch.path()).code == 0);
  for (const auto& [arguments, input] : cases) {
    const auto& tried = arguments;
    CAPTURE(tried);
    const std::string before = scratch.read(input);
    const Finished done = shell("kadr " + arguments, scratch.path());
    CAPTURE(done.err);
    CHECK(done.code == 2);
    CHECK(contains(done.err, "this output would overwrite an input"));
    CHECK(scratch.read(input) == before);
    CHECK_FALSE(scratch.has(input + ".part"));
  }
  CHECK(std::filesystem::is_symlink(scratch.file("link")));
}

TEST_CASE("a second output of one command does not replace its first, nor a scenario that it has updated") {
  const Scratch scratch;
  write_inputs(scratch);
  for (const char* command : {"law --zeta 0.005", "tube t.toml"}) {
    CAPTURE(command);
    REQUIRE(shell(std::string("kadr ") + command + " --csv alone", scratch.path()).code == 0);
    const Finished done = shell(std::string("kadr ") + command + " --csv both --page both", scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "both: this output would overwrite another one of this command"));
    CHECK(scratch.read("both") == scratch.read("alone"));
    scratch.remove("both");
  }
  scratch.write("u.toml",
                "format = 1\nname = \"u\"\nsummary = \"a square\"\nprogram = \"p.ngc\"\nmachine = "
                "\"mill3\"\n[expect]\ntime_s = 1000.0\nwithin_s = 0.001\n");
  const Finished done = shell("kadr scenario run --update --junit u.toml u.toml", scratch.path());
  CHECK(done.code == 2);
  CHECK(contains(done.err, "u.toml: this output would overwrite another one of this command"));
  CHECK(scratch.read("u.toml").starts_with("format = 1\n"));
}

TEST_CASE("--publish writes no file: that is what -o is for") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  for (const char* url : {"file://p.ngc?mode=w", "file://new.lcmlog?mode=w", "file:p.ngc"}) {
    CAPTURE(url);
    const Finished done = call({"run", "p.ngc", "-q", "--no-log", "--publish", url}, scratch.path());
    CHECK(done.code == 2);
    CHECK(contains(done.err, "a live channel is not a file"));
  }
  CHECK(scratch.read("p.ngc") == test::kSquare);
  CHECK_FALSE(scratch.has("new.lcmlog"));
}

TEST_CASE("every output goes into a FIFO as it is, and the FIFO stays") {
  const Scratch scratch;
  write_inputs(scratch);
  REQUIRE(::mkfifo(scratch.file("fifo").c_str(), 0600) == 0);
  for (const std::string arguments :
       {"run p.ngc -q -o fifo", "export l.lcmlog --csv -o fifo", "report l.lcmlog --plain -o fifo",
        "law --zeta 0.005 --page fifo", "wind hoop -o fifo", "tube t.toml -q --csv fifo",
        "teach table line 5 2 -q --vcd fifo", "scenario run s.toml -q --junit fifo"}) {
    CAPTURE(arguments);
    std::string to_file = arguments;
    to_file.replace(to_file.find("fifo"), 4, "file");
    const Finished done =
        shell("rm -f file; timeout 30 cat fifo >got & kadr " + arguments + " || exit; wait; kadr " + to_file +
                  " || exit; test -p fifo && cmp got file",
              scratch.path());
    CAPTURE(done.err);
    CHECK(done.code == 0);
  }
}

TEST_CASE("a link to /dev/stdout is standard output: a pipe, a file at its place; a device stays a device") {
  const Scratch scratch;
  write_inputs(scratch);
  const std::string& folder = scratch.path();
  // as /dev/stdout is, but not one that a fault would take from this machine
  REQUIRE(shell("ln -s /proc/self/fd/1 stdout", folder).code == 0);
  CHECK(shell("kadr run p.ngc -q -o stdout | cmp - l.lcmlog", folder).code == 0);
  CHECK(shell("kadr run p.ngc -q -o stdout >x && cmp x l.lcmlog", folder).code == 0);
  CHECK(shell("(echo head; kadr export l.lcmlog --csv -o stdout) >x; kadr export l.lcmlog --csv >y; "
              "tail -n +2 x | cmp - y && head -1 x | grep -qx head",
              folder)
            .code == 0);
  CHECK(std::filesystem::is_symlink(scratch.file("stdout")));
  // summary and log are not mixed
  const Finished apart = shell("kadr run p.ngc -o stdout | cmp - l.lcmlog", folder);
  CHECK(apart.code == 0);
  CHECK(contains(apart.err, "complete"));
  CHECK(shell("kadr run p.ngc -o m.lcmlog 2>m.lcmlog", folder).code == 2);
  CHECK(contains(scratch.read("m.lcmlog"), "m.lcmlog: messages go there, too; -q leaves them out"));
  if (::mknod(scratch.file("null").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) {
    MESSAGE("not tested: this user can't make a device node");
    return;
  }
  CHECK(shell("kadr run p.ngc -o null >x && test -c null && grep -q '^log  *null$' x", folder).code == 0);
  CHECK(shell("kadr run p.ngc -o null >null && test -c null", folder).code == 0);
}

TEST_CASE("a result that is standard output is there alone: - and /dev/stdout, in every command") {
  const Scratch scratch;
  write_inputs(scratch);
  const std::string& folder = scratch.path();
  REQUIRE(shell("ln -s /proc/self/fd/1 stdout", folder).code == 0);
  // what people read stands on standard error
  for (const auto& one :
       std::vector<std::pair<std::string, std::string>>{{"run p.ngc -o @", "complete"},
                                                        {"law --zeta 0.005 --csv @", "energy"},
                                                        {"law --zeta 0.005 --page @", "energy"},
                                                        {"tube t.toml --csv @", "law"},
                                                        {"tube t.toml --page @", "law"},
                                                        {"tube t.toml --sweep-levels 5..6 --csv @", "levels"},
                                                        {"compare l.lcmlog l.lcmlog -o @", "time"},
                                                        {"teach table line 5 2 --vcd @", "half_step"},
                                                        {"teach table line 5 2 --csv --vcd @", ""},
                                                        {"scenario run s.toml --junit @", "1 passed"},
                                                        {"export l.lcmlog --csv -o @", ""},
                                                        {"report l.lcmlog --plain -o @", ""},
                                                        {"wind hoop -o @", ""}}) {
    const std::string& arguments = one.first;
    const std::string& summary = one.second;
    CAPTURE(arguments);
    const auto to = [&arguments](const std::string& name) {
      std::string text = arguments;
      return text.replace(text.find('@'), 1, name);
    };
    REQUIRE(shell("rm -f file; kadr " + to("file") + " >said 2>told", folder).code == 0);
    for (const char* name : {"-", "stdout"}) {
      CAPTURE(name);
      const Finished done = shell("kadr " + to(name) + " | cmp - file", folder);
      CAPTURE(done.err);
      CHECK(done.code == 0);
      CHECK(done.out.empty());
      CHECK(contains(done.err, summary));
      CHECK_FALSE(scratch.has("-"));
    }
    if (!summary.empty()) {
      const Finished quiet = shell("kadr " + to("-") + " -q | cmp - file", folder);
      CHECK(quiet.code == 0);
      CHECK(quiet.err.empty());
      CHECK(contains(shell("kadr " + to("-") + " 2>&1 | cat", folder).out, "messages go there, too"));
      if (!contains(arguments, "--csv --vcd")) {
        const Finished both = shell("kadr " + to("-") + " --json | cat", folder);
        CHECK(both.out.empty());
        CHECK(contains(both.err, "standard output: the JSON document goes there, too"));
      }
    }
  }
  const Finished two = shell("kadr law --zeta 0.005 --csv - --page stdout | cat", folder);
  CHECK(two.out.empty());
  CHECK(contains(two.err, "stdout: another result goes there, too"));
}

TEST_CASE("-o through a link writes what the link names, and a folder or a socket is refused") {
  const Scratch scratch;
  write_inputs(scratch);
  const std::string& folder = scratch.path();
  CHECK(shell("echo old >there; ln -s there here; kadr run p.ngc -q -o here && test -L here && cmp there "
              "l.lcmlog",
              folder)
            .code == 0);
  CHECK(shell("echo precious >victim; ln -s victim o.lcmlog.part; kadr run p.ngc -q -o o.lcmlog", folder)
            .code == 2);
  CHECK(scratch.read("victim") == "precious\n");
  for (const char* arguments : {"report l.lcmlog", "export l.lcmlog --csv", "wind hoop"})
    CHECK(contains(shell(std::string("kadr ") + arguments + " -o .", folder).err, ".: is a folder"));
}

TEST_CASE("two runs with one -o: the second is refused, and the log is the first one's") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  scratch.write("long.ngc", test::back_and_forth(200));
  const std::string& folder = scratch.path();
  REQUIRE(call({"run", "long.ngc", "-q", "--no-plant", "-o", "alone.lcmlog"}, folder).code == 0);
  const Finished both = shell(
      "kadr run long.ngc -q --no-plant -o t.lcmlog & first=$!\n"
      "while ! test -s t.lcmlog.part; do kill -0 $first || exit 90; done\n"
      "kill -STOP $first; kadr run p.ngc -q --no-plant -o t.lcmlog; second=$?; kill -CONT $first\n"
      "wait $first || exit 91; test $second -eq 2 || exit 92; cmp t.lcmlog alone.lcmlog",
      folder);
  CAPTURE(both.err);
  CHECK(both.code == 0);
  CHECK(contains(both.err, "t.lcmlog: another kadr is writing it: t.lcmlog.part is locked"));
}

TEST_CASE("what kill -9 left behind refuses nobody") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  scratch.write("long.ngc", test::back_and_forth(3500));
  const Finished done = shell(
      "kadr run long.ngc -q -o t.lcmlog & first=$!\n"
      // more than the first piece that the kernel gets: a kill can cut that within the first message
      "while test $(stat -c %s t.lcmlog.part 2>/dev/null || echo 0) -lt 300000; do kill -0 $first || exit "
      "90; done\n"
      "kill -9 $first; wait $first; kadr info t.lcmlog.part; test $? -eq 1 || exit 91\n"
      "kadr run p.ngc -q -o t.lcmlog && kadr info t.lcmlog && test ! -e t.lcmlog.part",
      scratch.path());
  CAPTURE(done.err);
  CHECK(done.code == 0);
}

TEST_CASE("a write that fails leaves nothing under the name, whatever the command") {
  const Scratch scratch;
  write_inputs(scratch);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"wind", "dome", "-o", "out"},
                                                    {"export", "l.lcmlog", "--csv", "-o", "out"},
                                                    {"report", "l.lcmlog", "-o", "out"},
                                                    {"law", "--page", "out"},
                                                    {"tube", "t.toml", "--page", "out"},
                                                    {"machine", "new", "out"},
                                                    {"run", "p.ngc", "-q", "-o", "out"}}) {
    CAPTURE(arguments.front());
    Launch launch;
    launch.arguments = arguments;
    launch.folder = scratch.path();
    launch.file_size_limit = 1000;
    const Finished done = test::run_kadr(launch);
    CHECK(done.code == 2);
    CHECK(contains(done.err, "File too large"));
    CHECK_FALSE(scratch.has("out"));
    CHECK_FALSE(scratch.has("out.toml"));
    if (arguments.front() != "run") CHECK_FALSE(scratch.has("out.part"));
  }
}

TEST_CASE("a standard descriptor that the parent closed is no file of ours") {
  const Scratch scratch;
  write_inputs(scratch);
  scratch.write("long.ngc", test::back_and_forth(30));
  const std::string& folder = scratch.path();
  for (const char* closed : {"2>&-", ">&- 2>&-", "<&- >&- 2>&-", "<&- >&-", ">&-", "<&-"}) {
    CAPTURE(closed);
    // whatever it says, the log is whole
    shell(std::string("kadr run p.ngc --progress plain -o x.lcmlog ") + closed, folder);
    CHECK(shell("cmp x.lcmlog l.lcmlog; status=$?; rm -f x.lcmlog; exit $status", folder).code == 0);
    const Finished check = shell(std::string("kadr check p.ngc ") + closed, folder);
    CHECK(check.signal == 0);
    CHECK(check.code <= 2);
  }
  CHECK(shell("kadr check p.ngc 2>&-", folder).code == 0);
  CHECK(shell("kadr run p.ngc -q -o x.lcmlog <&- >&- 2>&-", folder).code == 0);
}

TEST_CASE("standard error that can't be written costs its messages and nothing else") {
  const Scratch scratch;
  write_inputs(scratch);
  scratch.write("bad.ngc", test::kSixMistakes);
  const std::string& folder = scratch.path();
  for (const std::string err : {"2>/dev/full", "2>&-"}) {
    CAPTURE(err);
    CHECK(shell("kadr run p.ngc -o x.lcmlog >out " + err + " && cmp x.lcmlog l.lcmlog && test -s out", folder)
              .code == 0);
    CHECK(shell("kadr check missing.ngc " + err, folder).code == 2);
    CHECK(shell("kadr run bad.ngc " + err, folder).code == 1);
    CHECK(shell("kadr no-such-command " + err, folder).code == 2);
    CHECK(shell("kadr run p.ngc --until soon " + err, folder).code == 2);
  }
}

TEST_CASE("results that can't be written to standard output: exit 2, with the reason") {
  const Scratch scratch;
  write_inputs(scratch);
  for (const std::string arguments :
       {"--help", "--version", "run --help", "help check", "version", "check p.ngc", "canon p.ngc",
        "completion bash", "man", "info l.lcmlog", "machine list", "export l.lcmlog --csv", "wind hoop",
        "law", "explain K1041"}) {
    CAPTURE(arguments);
    const Finished full = shell("kadr " + arguments + " >/dev/full", scratch.path());
    CHECK(full.code == 2);
    CHECK(contains(full.err, "kadr: standard output: No space left on device\n"));
    const Finished closed = shell("kadr " + arguments + " >&-", scratch.path());
    CHECK(closed.code == 2);
    CHECK(contains(closed.err, "kadr: standard output: Bad file descriptor\n"));
  }
}

TEST_CASE("a FIFO, a folder or a device in place of a log is refused at once") {
  const Scratch scratch;
  write_inputs(scratch);
  REQUIRE(::mkfifo(scratch.file("fifo").c_str(), 0600) == 0);
  for (const std::string name : {"fifo", ".", "/dev/null"})
    for (const std::string arguments :
         {"info", "report", "export --csv", "plot", "diff l.lcmlog", "compare l.lcmlog"}) {
      CAPTURE(name);
      CAPTURE(arguments);
      const Finished done = shell("timeout 20 kadr " + arguments + ' ' + name, scratch.path());
      CHECK(done.code == 2);
      CHECK(contains(done.err, name + ": not a regular file"));
    }
}

TEST_CASE("a name of 250 bytes and more is an output like others, and a longer one is refused") {
  const Scratch scratch;
  write_inputs(scratch);
  for (const std::size_t bytes : {250U, 251U, 255U}) {
    CAPTURE(bytes);
    const std::string name = std::string(bytes - 7, 'n') + ".lcmlog";
    const Finished done = call({"run", "p.ngc", "-q", "-o", name}, scratch.path());
    CAPTURE(done.err);
    CHECK(done.code == 0);
    CHECK(scratch.read(name) == scratch.read("l.lcmlog"));
    const Finished refused =
        call({"run", "p.ngc", "-q", "-o", name, "--limit", "log_bytes=100"}, scratch.path());
    CHECK(refused.code == 2);
  }
  // two long names that differ at their end are two files
  const std::string begin(250, 'n');
  const Finished both = call(
      {"law", "--zeta", "0.005", "-q", "--csv", begin + "1.csv", "--page", begin + "2.htm"}, scratch.path());
  CHECK(both.code == 0);
  const Finished long_name = call({"law", "--csv", std::string(256, 'n')}, scratch.path());
  CHECK(long_name.code == 2);
  CHECK(contains(long_name.err, "File name too long"));
}

TEST_CASE("Ctrl-C ends a run that waits for the reader of its FIFO") {
  const Scratch scratch;
  write_inputs(scratch);
  REQUIRE(::mkfifo(scratch.file("fifo").c_str(), 0600) == 0);
  for (const auto& one : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    const char* signal = one.first;
    const int code = one.second;
    CAPTURE(signal);
    // it says what log it writes before it opens that
    const Finished done = shell(
        fmt::format("(exec env --default-signal=INT kadr run p.ngc -o fifo) 2>told & kadr=$!; "
                    "for i in $(seq 600); do grep -q 'log fifo' told && break; sleep 0.1; done; sleep 0.5; "
                    "kill -{} $kadr; wait $kadr; echo $?",
                    signal),
        scratch.path());
    CHECK(done.out == fmt::format("{}\n", code));
  }
}

TEST_CASE("a log is bounded: one that would be too long does not begin, one that becomes too long ends") {
  const Scratch scratch;
  scratch.write("p.ngc", test::kSquare);
  scratch.write("endless.toml",
                "format = 1\nname = \"e\"\nsummary = \"a hundred times as long as planned\"\nprogram = "
                "\"p.ngc\"\nmachine = "
                "\"mill3\"\n"
                "[[step]]\nat_s = 0.01\noverride_pct = 1\n");
  const std::string& folder = scratch.path();
  const Finished expected = call({"run", "p.ngc", "--limit", "log_bytes=10_000"}, folder);
  CHECK(expected.code == 2);
  CHECK(contains(expected.err, "p.lcmlog: the log would be about "));
  CHECK(contains(expected.err, "more than log_bytes allows (10.0 kB); --limit log_bytes=N allows more"));
  CHECK_FALSE(scratch.has("p.lcmlog.part"));
  const Finished endless =
      call({"run", "-s", "endless.toml", "--limit", "log_bytes=5_000_000", "-o", "e.lcmlog"}, folder);
  CHECK(endless.code == 2);
  CHECK(contains(endless.err,
                 "e.lcmlog.part: the log is longer than 5000000 bytes; --limit log_bytes=N allows more"));
  CHECK_FALSE(scratch.has("e.lcmlog"));
  CHECK(call({"info", "e.lcmlog.part"}, folder).code == 1);
  CHECK(call({"run", "p.ngc", "-q", "--limit", "log_bytes=0"}, folder).code == 0);
  // a command that writes no log has no such bound
  CHECK(contains(call({"check", "p.ngc", "--limit", "log_bytes=5"}, folder).err,
                 "--limit takes NAME=N with NAME one of"));
}

TEST_CASE("updating the expectations of a scenario that did not run is no success") {
  const Scratch scratch;
  scratch.write(
      "s.toml",
      "format = 1\nname = \"s\"\nsummary = \"lost\"\nprogram = \"missing.ngc\"\nmachine = \"mill3\"\n"
      "[expect]\ntime_s = 1.0\nwithin_s = 0.001\n");
  const std::string before = scratch.read("s.toml");
  const Finished done = call({"scenario", "run", "--update", "s.toml"}, scratch.path());
  CHECK(done.code == 1);
  CHECK(contains(done.out, "there is no file missing.ngc"));
  CHECK(scratch.read("s.toml") == before);
}
