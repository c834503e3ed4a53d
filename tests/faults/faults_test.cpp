#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"

/// Faults of the world, one at a time: for each command that writes, the first, second, ... call of a kind fails, until the
/// command makes no more of them.
namespace test = kadr::test;
using test::Finished;
using test::Launch;
using test::Scratch;

namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

// KADR_FAULTS names others, with commas
const std::string kKinds =
    "write,short_write,open,rename,fsync,ftruncate,flock,unlink,fchmod,fchown,close,mmap,malloc,";
constexpr int kMostCalls = 200;
// of allocations, of which there are thousands, so many fail, evenly spread; half of them among those that a command
// makes beyond what reading the command line takes
constexpr int kAllocations = 40;
const std::string kMark = "fault.mark";

const std::string kProgram = "G21 G90 G94\nG1 X5 F1200\nY2\nM2\n";
const std::string kProblem =
    "format = 1\n[path]\nlength_mm = 10\nnodes = 21\nmax_mm_s = 50\nmax_acceleration_mm_s2 = 500\n"
    "[[axis]]\nname = \"X\"\nunit = \"mm\"\nmax_mm_s = 40\nmax_acceleration_mm_s2 = 100\nslope_mm = 10\n";
const std::string kScenario =
    "format = 1\nname = \"s\"\nsummary = \"a line\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n\n[expect]\n"
    "time_s = 1.0\nwithin_s = 0.001\nsteps_hash = \"0000000000000000\"\n";
const std::string kTrueScenario =
    "format = 1\nname = \"s\"\nsummary = \"a line\"\nprogram = \"p.ngc\"\nmachine = \"mill3\"\n\n[expect]\n"
    "time_s = 0.433\nwithin_s = 0.001\n";

/// A command, the files that it reads and those that it makes or rewrites.
struct Writer {
  std::vector<std::string> arguments;
  std::vector<std::string> outputs;
  Files inputs = {{"p.ngc", kProgram}};
  bool keeps_part = false;      ///< what a run wrote before a fault can be read
  std::string report_end = {};  ///< end of an output that tells of the fault itself, and is whole then
};

class FaultRun {
 public:
  explicit FaultRun(const Writer& writer) : writer_(writer), inputs_(writer.inputs) {
    for (const std::string& name : writer.arguments) needs_log_ = needs_log_ || name == "l.lcmlog";
    if (needs_log_) {
      scratch_.write("p.ngc", kProgram);
      REQUIRE(test::call({"run", "p.ngc", "-q", "--no-plant", "-o", "l.lcmlog"}, scratch_.path()).code == 0);
      inputs_["l.lcmlog"] = scratch_.read("l.lcmlog");
    }
    whole_run_ = run("", 0);
    CAPTURE(whole_run_.err);
    REQUIRE(whole_run_.code == 0);
    whole_ = outputs();
    REQUIRE(whole_.size() == writer.outputs.size());
  }

  /// Calls that the command makes.
  long count_calls(const std::string& kind) {
    run(kind, 0, "KADR_FAULT_COUNT=" + scratch_.file("count"));
    return std::atol(scratch_.read("count").c_str());
  }

  int kill_at(int places) {
    const long calls = count_calls("any");
    REQUIRE(calls > 0);
    int killed = 0;
    for (int i = 0; i < places; ++i) {
      // from the first to the last, each a place of its own as long as there are enough
      const long n = 1 + (calls - 1) * i / std::max(places - 1, 1);
      const Finished done = run("any", n, "KADR_FAULT_KILL=1");
      CAPTURE(n);
      CHECK(done.signal == SIGKILL);
      killed += done.signal == SIGKILL ? 1 : 0;
      check_killed();
    }
    return killed;
  }

  /// Lets allocations fail, evenly spread. @return how many there are in a run
  int try_allocations(long command_line) {
    const long calls = count_calls("malloc");
    const long begin = std::min(command_line, calls);
    for (int i = 0; i < kAllocations; ++i) {
      const long half = kAllocations / 2;
      const long n = i < half ? 1 + begin * i / half : begin + (calls - begin) * (i - half + 1) / half;
      check(run("malloc", n), "malloc", static_cast<int>(n));
    }
    return static_cast<int>(calls);
  }

  /// Lets the calls of a kind fail one after the other. @return how many there were
  int try_all(const std::string& kind) {
    for (int n = 1; n <= kMostCalls; ++n) {
      const Finished done = run(kind, n);
      check(done, kind, n);
      if (!scratch_.has(kMark)) return n - 1;
    }
    FAIL("there is no end of calls: ", kind);
    return kMostCalls;
  }

 private:
  void check_killed() const {
    for (const auto& file : outputs()) {
      const auto before = inputs_.find(file.first);
      CHECK((file.second == whole_.at(file.first) ||
             (before != inputs_.end() && file.second == before->second)));
    }
    for (const auto& file : inputs_)
      CHECK((scratch_.read(file.first) == file.second ||
             (whole_.contains(file.first) && scratch_.read(file.first) == whole_.at(file.first))));
    for (const std::string& name : writer_.outputs) {
      if (!writer_.keeps_part || !scratch_.has(name + ".part")) continue;
      const Finished read = test::call({"info", name + ".part"}, scratch_.path());
      CAPTURE(read.out);
      CAPTURE(read.err);
      // whole, but for its name; cut off; or cut off in its header
      const bool whole = scratch_.read(name + ".part") == whole_.at(name);
      CHECK(read.signal == 0);
      if (whole)
        CHECK(read.code == 0);
      else if (read.code == 1)
        CHECK(test::contains(read.out, "cut off"));
      else
        CHECK(read.code == 2);
    }
  }

  Finished run(const std::string& kind, long n, const std::string& more = "KADR_FAULT=") {
    for (const std::string& name : writer_.outputs)
      for (const std::string& file : {name, name + ".part"}) scratch_.remove(file);
    scratch_.remove(kMark);
    for (const auto& [name, text] : inputs_) scratch_.write(name, text);
    Launch launch;
    launch.arguments = writer_.arguments;
    launch.folder = scratch_.path();
    launch.environment = {"LANG=C.UTF-8"};
    if (!kind.empty())
      launch.environment = {"LD_PRELOAD=" KADR_FAILING_CALLS, "KADR_FAULT_CALL=" + kind,
                            fmt::format("KADR_FAULT_AT={}", n), "KADR_FAULT_MARK=" + scratch_.file(kMark),
                            more};
    return test::run_kadr(launch);
  }

  /// The outputs that are there under their names.
  Files outputs() const {
    Files found;
    for (const std::string& name : writer_.outputs)
      if (scratch_.has(name)) found[name] = scratch_.read(name);
    return found;
  }

  void check(const Finished& done, const std::string& kind, int n) const {
    CAPTURE(kind);
    CAPTURE(n);
    CAPTURE(done.err);
    CHECK(done.signal == 0);
    CHECK((done.code == 0 || done.code == 1 || done.code == 2));
    if (kind == "malloc") CHECK((done.code == 0 || (done.code == 2 && !done.err.empty())));
    const Files found = outputs();
    if (done.code == 0) {
      CHECK(found == whole_);
      CHECK(done.out == whole_run_.out);
    }
    for (const auto& file : found) {
      const auto& name = file.first;
      const auto& text = file.second;
      CAPTURE(name);
      // whole, or as it was before
      const auto before = inputs_.find(name);
      const bool reports = !writer_.report_end.empty() && text.ends_with(writer_.report_end);
      CHECK((text == whole_.at(name) || (before != inputs_.end() && text == before->second) || reports));
    }
    for (const auto& file : inputs_) {
      const auto& name = file.first;
      const auto& text = file.second;
      CAPTURE(name);
      if (whole_.contains(name))
        CHECK(scratch_.has(name));
      else
        CHECK(scratch_.read(name) == text);
    }
    if (writer_.keeps_part || kind == "unlink") return;
    for (const std::string& name : writer_.outputs) CHECK_FALSE(scratch_.has(name + ".part"));
  }

  const Writer& writer_;
  Files inputs_;
  bool needs_log_ = false;
  Scratch scratch_;
  Finished whole_run_;
  Files whole_;
};

/// Kills a command with SIGKILL in each of many calls of the C library, allocations included, evenly spread over all that
/// it makes: what has its name is whole or as before, inputs are as before, a log's .part reads as cut off.
/// @param spread  so many places
/// @return how often it was killed
int try_kills(const Writer& writer, int spread);

/// Allocations that every command makes before it begins.
long command_line_allocations() {
  static const Writer version{.arguments = {"version", "-q"}, .outputs = {}, .inputs = {}};
  static const long allocations = FaultRun(version).count_calls("malloc");
  return allocations;
}

/// All kinds of calls. Every command that writes a file opens, writes, syncs and renames it.
void try_faults(const Writer& writer) {
  FaultRun faults(writer);
  const char* chosen = std::getenv("KADR_FAULTS");
  std::string kinds = chosen ? std::string(chosen) + ',' : kKinds;
  std::map<std::string, int> calls;
  while (!kinds.empty()) {
    const auto comma = kinds.find(',');
    const std::string kind = kinds.substr(0, comma);
    kinds.erase(0, comma + 1);
    calls[kind] =
        kind == "malloc" ? faults.try_allocations(command_line_allocations()) : faults.try_all(kind);
  }
  if (chosen) return;
  CHECK(calls["write"] > 0);
  if (writer.outputs.empty()) return;
  CHECK(calls["open"] >= 2);
  CHECK(calls["short_write"] > 0);
  CHECK(calls["fsync"] >= 2);
  CHECK(calls["rename"] > 0);
  CHECK(calls["flock"] > 0);
}

int try_kills(const Writer& writer, int spread) { return FaultRun(writer).kill_at(spread); }

}  // namespace

TEST_CASE("kill -9 in any call leaves no half a file under a name, and a log's .part that reads as cut off") {
  // KADR_KILLS: so many in all
  const char* chosen = std::getenv("KADR_KILLS");
  const int kills = chosen ? std::atoi(chosen) : 40;
  int killed = try_kills({.arguments = {"run", "p.ngc", "-o", "out.lcmlog", "-q", "--no-plant"},
                          .outputs = {"out.lcmlog"},
                          .keeps_part = true},
                         kills / 2);
  killed += try_kills({.arguments = {"run", "p.ngc", "-o", "out.lcmlog", "-q", "--threads", "2"},
                       .outputs = {"out.lcmlog"},
                       .keeps_part = true},
                      kills / 4);
  killed += try_kills(
      {.arguments = {"report", "l.lcmlog", "--plain", "-o", "out.html"}, .outputs = {"out.html"}}, kills / 8);
  killed += try_kills({.arguments = {"fmt", "--in-place", "p.ngc"},
                       .outputs = {"p.ngc"},
                       .inputs = {{"p.ngc", "g21 g90\n  g1   x5 f1200\nm2\n"}}},
                      kills / 8);
  MESSAGE(killed, " kills");
}

TEST_CASE("one failing call: kadr run") {
  try_faults({.arguments = {"run", "p.ngc", "-o", "out.lcmlog", "-q"},
              .outputs = {"out.lcmlog"},
              .keeps_part = true});
}

TEST_CASE("one failing call: kadr run with the log written by a thread of its own") {
  try_faults({.arguments = {"run", "p.ngc", "-o", "out.lcmlog", "-q", "--threads", "2", "--no-plant"},
              .outputs = {"out.lcmlog"},
              .keeps_part = true});
}

TEST_CASE("one failing call: kadr report") {
  try_faults({.arguments = {"report", "l.lcmlog", "--plain", "-o", "out.html"}, .outputs = {"out.html"}});
}

TEST_CASE("one failing call: kadr compare") {
  try_faults({.arguments = {"compare", "l.lcmlog", "l.lcmlog", "-o", "out.html"}, .outputs = {"out.html"}});
}

TEST_CASE("one failing call: kadr export, to a file and to standard output") {
  try_faults({.arguments = {"export", "l.lcmlog", "--csv", "-o", "out.csv"}, .outputs = {"out.csv"}});
  try_faults({.arguments = {"export", "l.lcmlog", "--vcd"}, .outputs = {}});
}

TEST_CASE("one failing call: kadr teach table --vcd") {
  try_faults({.arguments = {"teach", "table", "line", "5", "2", "--vcd", "out.vcd"},
              .outputs = {"out.vcd"},
              .inputs = {}});
}

TEST_CASE("one failing call: kadr law") {
  try_faults({.arguments = {"law", "--zeta", "0.005", "--csv", "out.csv", "--page", "out.html"},
              .outputs = {"out.csv", "out.html"},
              .inputs = {}});
}

TEST_CASE("one failing call: kadr tube") {
  try_faults({.arguments = {"tube", "t.toml", "--csv", "out.csv", "--page", "out.html"},
              .outputs = {"out.csv", "out.html"},
              .inputs = {{"t.toml", kProblem}}});
}

TEST_CASE("one failing call: kadr wind") {
  try_faults({.arguments = {"wind", "hoop", "-o", "out.ngc"}, .outputs = {"out.ngc"}, .inputs = {}});
}

TEST_CASE("one failing call: kadr machine new") {
  try_faults({.arguments = {"machine", "new", "out"}, .outputs = {"out.toml"}, .inputs = {}});
}

TEST_CASE("one failing call: kadr fmt --in-place") {
  try_faults({.arguments = {"fmt", "--in-place", "p.ngc"},
              .outputs = {"p.ngc"},
              .inputs = {{"p.ngc", "g21 g90\n  g1   x5 f1200\nm2\n"}}});
}

TEST_CASE("one failing call: kadr scenario run --update and --junit") {
  try_faults({.arguments = {"scenario", "run", "--update", "scenario.toml"},
              .outputs = {"scenario.toml"},
              .inputs = {{"p.ngc", kProgram}, {"scenario.toml", kScenario}}});
  try_faults({.arguments = {"scenario", "run", "--update", "--junit", "out.xml", "scenario.toml"},
              .outputs = {"out.xml"},
              .inputs = {{"p.ngc", kProgram}, {"scenario.toml", kTrueScenario}},
              .report_end = "</testsuite>\n"});
}

TEST_CASE("one failing call: results on standard output") {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", "p.ngc"}, {"canon", "p.ngc"}, {"--help"}, {"completion", "bash"}}) {
    CAPTURE(arguments.front());
    try_faults({.arguments = arguments, .outputs = {}});
  }
}
