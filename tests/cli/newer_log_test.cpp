#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/cli/run_kadr.h"
#include "tests/emulator/log/log_events.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::Scratch;

namespace {

/// The log of format 2 in tests/emulator/log/data, one of its channels with a name that no kadr knows.
std::string newer_log() {
  std::ifstream in(KADR_SOURCE_DIR "/tests/emulator/log/data/format2.lcm", std::ios::binary);
  auto events = kadr::test::events_of({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
  for (auto& event : events)
    if (event.channel == "KADR_BLOCK_END") event.channel = "KADR_SOMETHING";
  kadr::test::seal(events);
  const auto bytes = kadr::test::log_of(events);
  return {bytes.begin(), bytes.end()};
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE(
    "report, compare, export, plot, diff and info say once that they pass over a channel of a newer kadr") {
  const Scratch scratch;
  scratch.write("a.lcmlog", newer_log());
  const std::string note = "channel KADR_SOMETHING is not known: it is passed over";
  for (const std::vector<std::string>& command : {std::vector<std::string>{"report", "a.lcmlog", "--plain"},
                                                  {"export", "a.lcmlog", "--csv", "-o", "a.csv"},
                                                  {"plot", "a.lcmlog"}}) {
    const Finished done = call(command, scratch.path());
    CAPTURE(command.front());
    CHECK(done.code == 0);
    CHECK(count(done.err, "kadr: a.lcmlog: " + note + "\n") == 1);
  }
  scratch.write("b.lcmlog", newer_log());
  for (const char* command : {"diff", "compare"}) {
    const Finished both = call({command, "a.lcmlog", "b.lcmlog"}, scratch.path());
    CAPTURE(command);
    CHECK(both.code == 0);
    CHECK(count(both.err, "kadr: a.lcmlog: " + note + "\n") == 1);
    CHECK(count(both.err, "kadr: b.lcmlog: " + note + "\n") == 1);
  }
  CHECK(contains(call({"info", "a.lcmlog"}, scratch.path()).out, note));
}
