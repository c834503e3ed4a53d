#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/cli/run_kadr.h"
#include "tests/emulator/log/log_events.h"

using kadr::test::call;
using kadr::test::contains;
using kadr::test::Finished;
using kadr::test::LogEvent;
using kadr::test::Scratch;

// Logs that were damaged on the way, and logs that a stranger made, in front of every command that reads one.

namespace {

using Bytes = std::vector<std::uint8_t>;
using Events = std::vector<LogEvent>;

/// A true log, and logs made of it.
struct Logs {
  Scratch scratch;
  Bytes bytes;
  Logs() {
    scratch.write("p.ngc", "G21 G90 G94\nG1 X5 F1500\nG1 Y3\nM2\n");
    REQUIRE(call({"run", "p.ngc", "-o", "a.lcmlog", "-q", "--set", "log.viewer_rate_hz=0"}, scratch.path())
                .code == 0);
    const std::string log = scratch.read("a.lcmlog");
    bytes.assign(log.begin(), log.end());
  }
  void save(const std::string& name, const Bytes& log) const {
    scratch.write(name, {log.begin(), log.end()});
  }
  /// The log with changed events, whose hashes fit.
  void save_sealed(const std::string& name, const std::function<void(Events&)>& change) const {
    Events events = kadr::test::events_of(bytes);
    change(events);
    kadr::test::seal(events);
    save(name, kadr::test::log_of(events));
  }
  Finished kadr(const std::vector<std::string>& arguments) const { return call(arguments, scratch.path()); }
};

/// Every command that reads a log, on b.lcmlog; what it writes is `out`.
const std::vector<std::vector<std::string>> kReaders{
    {"report", "b.lcmlog", "-o", "out"},
    {"report", "b.lcmlog", "--plain", "-o", "out"},
    {"export", "b.lcmlog", "--csv", "-o", "out"},
    {"export", "b.lcmlog", "--csv", "--to", "0.01"},
    {"export", "b.lcmlog", "--excel"},
    {"export", "b.lcmlog", "--json"},
    {"export", "b.lcmlog", "--vcd", "-o", "out"},
    {"export", "b.lcmlog", "--svg", "-o", "out"},
    {"export", "b.lcmlog", "--list"},
    {"plot", "b.lcmlog"},
    {"plot", "b.lcmlog", "--path"},
    {"compare", "a.lcmlog", "b.lcmlog", "-o", "out"},
    {"diff", "a.lcmlog", "b.lcmlog"},
    {"diff", "b.lcmlog", "b.lcmlog"},
    {"diff", "a.lcmlog", "b.lcmlog", "--align", "path"},
};

std::string text_of(const std::string& text) {
  const auto size = static_cast<char>(text.size() + 1);
  return std::string("\0\0\0", 3) + size + text + '\0';
}

/// Puts another text in place of one, wherever a message holds it.
void replace_text(Bytes& data, const std::string& from, const std::string& to) {
  std::string all(data.begin(), data.end());
  const std::string old = text_of(from), fresh = text_of(to);
  for (auto at = all.find(old); at != std::string::npos; at = all.find(old, at + fresh.size()))
    all.replace(at, old.size(), fresh);
  data.assign(all.begin(), all.end());
}

LogEvent& nth(Events& events, const std::string& channel, std::size_t n) {
  for (LogEvent& e : events)
    if (e.channel == channel && n-- == 0) return e;
  FAIL("no " << channel);
  return events.front();
}

}  // namespace

TEST_CASE("a log that is broken behind what is read of it is not read without a word") {
  const Logs logs;
  Bytes broken = logs.bytes;
  broken[broken.size() * 4 / 5] ^= 0xFF;
  // the mark with which an event begins
  const std::string log(broken.begin(), broken.end());
  const std::size_t mark = log.find("\xED\xA1\xDA\x01", broken.size() * 4 / 5);
  REQUIRE(mark != std::string::npos);
  broken[mark] ^= 1;
  Bytes cut = logs.bytes;
  cut.resize(cut.size() * 4 / 5);
  logs.save("broken.lcmlog", broken);
  logs.save("cut.lcmlog", cut);
  logs.save("true.lcmlog", logs.bytes);
  for (const std::vector<std::string>& part :
       std::vector<std::vector<std::string>>{{"export", "--csv", "--to", "0.01"},
                                             {"export", "--excel", "--to", "0.01"},
                                             {"export", "--vcd", "--to", "0.01"},
                                             {"export", "--svg", "--to", "0.01"},
                                             {"export", "--list"},
                                             {"plot", "--to", "0.01"},
                                             {"plot", "--path", "--to", "0.01"}}) {
    CAPTURE(part);
    const auto on = [&](const std::string& name) {
      std::vector<std::string> arguments = part;
      arguments.insert(arguments.begin() + 1, name);
      return logs.kadr(arguments);
    };
    CHECK(on("true.lcmlog").code == 0);
    CHECK(on("true.lcmlog").err.empty());
    CHECK(on("broken.lcmlog").code == 1);
    CHECK(contains(on("broken.lcmlog").err, "kadr: broken.lcmlog: damaged: "));
    CHECK(on("cut.lcmlog").code == 1);
    CHECK(contains(on("cut.lcmlog").err, "kadr: cut.lcmlog: cut off: "));
  }
}

TEST_CASE("what -q leaves of an answer of info and diff says why it is no") {
  const Logs logs;
  Bytes cut = logs.bytes;
  cut.resize(cut.size() * 4 / 5);
  logs.save("cut.lcmlog", cut);
  logs.save("true.lcmlog", logs.bytes);
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info", "-q", "cut.lcmlog"},
           {"diff", "-q", "true.lcmlog", "cut.lcmlog"},
           {"diff", "-q", "true.lcmlog", "cut.lcmlog", "--align", "path"}}) {
    CAPTURE(command);
    const Finished done = logs.kadr(command);
    CHECK(done.code == 1);
    CHECK(done.out.empty());
    CHECK(contains(done.err, "kadr: cut.lcmlog: "));
    CHECK(contains(done.err, "cut off"));
  }
}

TEST_CASE("no command says yes to a log with a flipped bit, and none leaves an output") {
  const Logs logs;
  // in a number of each channel, and at the end of the summary
  for (const std::string channel : {"KADR_RUN", "KADR_BLOCK", "KADR_TICKS", "KADR_STEPS", "KADR_SUMMARY"}) {
    Events events = kadr::test::events_of(logs.bytes);
    LogEvent& e = nth(events, channel, 0);
    e.data[channel == "KADR_SUMMARY" ? e.data.size() - 20 : e.data.size() / 2] ^= 1;
    logs.save("b.lcmlog", kadr::test::log_of(events));
    for (const auto& command : kReaders) {
      CAPTURE(channel);
      CAPTURE(command);
      const Finished run = logs.kadr(command);
      CHECK(run.code == 1);
      CHECK(contains(run.err, "kadr: b.lcmlog: its numbers are not those that were written: "));
      CHECK(run.out.empty());
      CHECK_FALSE(logs.scratch.has("out"));
    }
    const Finished info = logs.kadr({"info", "b.lcmlog"});
    CHECK(info.code == 1);
    // a message that is impossible in itself ends it before the hash is asked
    CHECK((contains(info.out, "b.lcmlog: altered: its numbers are not those that were written: ") ||
           contains(info.out, "b.lcmlog: damaged: event ")));
  }
}

TEST_CASE("messages that contradict each other are told by every command, whatever the hashes say") {
  const Logs logs;
  logs.save_sealed("b.lcmlog", [](Events& events) {
    // the control ticks of the third block come once more, with the stamps of the fourth
    nth(events, "KADR_TICKS", 3).data = nth(events, "KADR_TICKS", 2).data;
  });
  for (const auto& command : kReaders) {
    if (command.back() == "--list" || command.back() == "0.01") continue;  // read no further than they need
    CAPTURE(command);
    const Finished run = logs.kadr(command);
    CHECK(run.code == 1);
    CHECK(contains(run.err + run.out, "damaged: event "));
  }
  CHECK(contains(logs.kadr({"info", "b.lcmlog"}).out, "(KADR_TICKS) at byte "));
}

TEST_CASE("names of axes of a foreign log are quoted in CSV, and end no name in a dump") {
  const Logs logs;
  logs.save_sealed("b.lcmlog", [](Events& events) {
    replace_text(events.front().data, "X", "a,\"b\";*");
    replace_text(events.front().data, "Y", "c d$end");
  });
  const Finished csv = logs.kadr({"export", "b.lcmlog", "--csv"});
  CHECK(csv.code == 0);
  CHECK(contains(csv.out, ",\"axis.a,\"\"b\"\";*.steps\","));
  CHECK(contains(csv.out, ",axis.c d$end.steps,"));
  CHECK(contains(logs.kadr({"export", "b.lcmlog", "--excel"}).out, ";\"axis.a,\"\"b\"\";*.steps\";"));
  const Finished vcd = logs.kadr({"export", "b.lcmlog", "--vcd"});
  CHECK(vcd.code == 0);
  CHECK(contains(vcd.out, " c_d_end_step $end\n"));
  // the page and the plot choose their signals by name: a comma or a star in it is no pattern
  CHECK(logs.kadr({"report", "b.lcmlog", "-o", "b.html"}).code == 0);
  CHECK(logs.kadr({"plot", "b.lcmlog"}).code == 0);
}

TEST_CASE("finite values beyond any picture are drawn within it") {
  const Logs logs;
  logs.save_sealed("b.lcmlog", [](Events& events) {
    // -1e308 and 1e308 in turn, in the first column (the feed) of each block
    const std::string high{"\x7f\xe1\xcc\xf3\x85\xeb\xc8\xa0", 8}, low{"\xff\xe1\xcc\xf3\x85\xeb\xc8\xa0", 8};
    bool up = false;
    for (LogEvent& e : events) {
      if (e.channel != "KADR_TICKS") continue;
      const std::size_t n = e.data[27];
      for (std::size_t i = 0; i < n; ++i)
        std::copy_n((up ? high : low).begin(), 8, e.data.begin() + 40 + 8 * static_cast<std::ptrdiff_t>(i));
      up = !up;
    }
  });
  const Finished plot = logs.kadr({"plot", "b.lcmlog", "--signals", "feed.commanded*", "--ascii"});
  CHECK(plot.code == 0);
  CHECK(contains(plot.out, "feed.commanded_mm_s   -1.000e+308 .. 1.000e+308 mm/s\n"));
  CHECK(contains(plot.out, "\n1.000e+308 "));
  CHECK(std::count(plot.out.begin(), plot.out.end(), '#') > 100);
  for (const std::string form : {"--svg", "--json", "--csv", "--vcd"})
    CHECK(logs.kadr({"export", "b.lcmlog", form}).code == 0);
  CHECK_FALSE(contains(logs.kadr({"export", "b.lcmlog", "--svg"}).out, "nan"));
}
