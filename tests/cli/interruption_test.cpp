#include <doctest/doctest.h>
#include <sys/stat.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tests/cli/programs.h"
#include "tests/cli/run_kadr.h"

using kadr::test::call;
using kadr::test::Finished;
using kadr::test::Launch;
using kadr::test::run_kadr;
using kadr::test::Scratch;
namespace test = kadr::test;
using Json = nlohmann::json;

namespace {

std::int64_t file_bytes(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_size : -1;
}

/// Sends a signal once the log under way has reached a size.
std::function<void(pid_t)> at_size(const std::string& path, std::int64_t bytes, int signal) {
  return [path, bytes, signal, sent = false](pid_t child) mutable {
    if (sent || file_bytes(path) < bytes) return;
    sent = true;
    ::kill(child, signal);
  };
}

Json info(const Scratch& scratch, const std::string& file) {
  const Finished told = call({"info", file, "--json"}, scratch.path());
  CAPTURE(told.err);
  REQUIRE(told.code <= 1);
  Json j = Json::parse(told.out)[0];
  j["exit_code"] = told.code;
  return j;
}

/// An hour of machine time: never done before a signal comes.
const std::string kLong = test::back_and_forth(3500);

}  // namespace

TEST_CASE("Ctrl-C during a run closes the log as interrupted: X.part is readable, exit 130") {
  const Scratch scratch;
  scratch.write("long.ngc", kLong);
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    const int sent = signal;
    CAPTURE(sent);
    // the log of the run before would be taken for this one's
    scratch.remove("long.lcmlog.part");
    Launch launch;
    launch.arguments = {"run", "long.ngc"};
    launch.folder = scratch.path();
    launch.watch = at_size(scratch.file("long.lcmlog.part"), 300'000, signal);
    const Finished run = run_kadr(launch);
    CHECK(run.code == code);
    CHECK(run.out.find("interrupted") != std::string::npos);
    CHECK(run.err.find("long.lcmlog.part") != std::string::npos);
    CHECK(!scratch.has("long.lcmlog"));
    const Json j = info(scratch, "long.lcmlog.part");
    CHECK(j["state"] == "interrupted");
    CHECK(j["outcome"] == "interrupted");
    CHECK(j["exit_code"] == 0);
    CHECK(j["steps_hash_agrees"] == true);
    CHECK(j["content_hash_agrees"] == true);
    CHECK(j["span_s"] > 0.1);
  }
}

TEST_CASE("a second Ctrl-C ends the run at once") {
  const Scratch scratch;
  scratch.write("long.ngc", kLong);
  Launch launch;
  launch.arguments = {"run", "long.ngc"};
  launch.folder = scratch.path();
  launch.watch = [path = scratch.file("long.lcmlog.part"), sent = false](pid_t child) mutable {
    if (sent || file_bytes(path) < 100'000) return;
    sent = true;
    ::kill(child, SIGINT);
    ::kill(child, SIGINT);
  };
  // two signals may arrive as one before the handler has run: then it is a plain interruption
  CHECK(run_kadr(launch).code == 130);
}

TEST_CASE(
    "kill -9 at random moments leaves a log that is readable up to its last whole event and says it was "
    "cut") {
  const Scratch scratch;
  scratch.write("long.ngc", kLong);
  const std::uint64_t seed = test::seed_or(1);
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < test::count_or(30); ++i) {
    // from the first bytes (the header is written before) to some blocks of ticks
    const auto bytes = static_cast<std::int64_t>(20'000 + random() % 1'500'000);
    CAPTURE(i);
    CAPTURE(bytes);
    scratch.remove("long.lcmlog.part");
    Launch launch;
    launch.arguments = {"run", "long.ngc", "--threads", i % 2 == 0 ? "1" : "2"};
    launch.folder = scratch.path();
    launch.watch = at_size(scratch.file("long.lcmlog.part"), bytes, SIGKILL);
    const Finished run = run_kadr(launch);
    CHECK(run.signal == SIGKILL);
    CHECK(!scratch.has("long.lcmlog"));
    const Json j = info(scratch, "long.lcmlog.part");
    CHECK(j["state"] == "cut off");
    CHECK(j["exit_code"] == 1);
    CHECK(j["valid_bytes"] > 0);
    CHECK(j["valid_bytes"] <= j["file_bytes"]);
    CHECK(j["steps_hash_agrees"].is_null());
  }
}

TEST_CASE(
    "a full disk at random moments: exit 2 with path, reason and valid tick; the log says that it was cut") {
  const Scratch scratch;
  scratch.write("long.ngc", kLong);
  const std::uint64_t seed = test::seed_or(2);
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < test::count_or(30); ++i) {
    const auto limit = static_cast<std::int64_t>(90'000 + random() % 1'500'000);
    CAPTURE(i);
    CAPTURE(limit);
    scratch.remove("long.lcmlog.part");
    Launch launch;
    launch.arguments = {"run", "long.ngc", "--threads", i % 2 == 0 ? "1" : "2"};
    launch.folder = scratch.path();
    launch.file_size_limit = limit;
    const Finished run = run_kadr(launch);
    CHECK(run.code == 2);
    CHECK(run.out.empty());
    CHECK(run.err.find("long.lcmlog.part: File too large; the log is valid up to tick ") !=
          std::string::npos);
    CHECK(!scratch.has("long.lcmlog"));
    const Json j = info(scratch, "long.lcmlog.part");
    CHECK(j["state"] == "cut off");
    CHECK(j["file_bytes"] <= limit);
    CHECK(j["valid_bytes"] > 0);
    // the files that the message names are there
    const auto at = run.err.find("up to tick ") + 11;
    CHECK(j["valid_until_tick"].get<std::int64_t>() >= std::stoll(run.err.substr(at)));
  }
}

TEST_CASE("a disk too full for the header: exit 2, and kadr info says the log was cut in its header") {
  const Scratch scratch;
  scratch.write("long.ngc", kLong);
  Launch launch;
  launch.arguments = {"run", "long.ngc"};
  launch.folder = scratch.path();
  launch.file_size_limit = 1000;
  CHECK(run_kadr(launch).code == 2);
  const Finished told = call({"info", "long.lcmlog.part"}, scratch.path());
  CHECK(told.code == 2);
  CHECK(told.err.find("long.lcmlog.part") != std::string::npos);
}

TEST_CASE("standard output that can't be written is an error, not a silent loss") {
  const Scratch scratch;
  scratch.write("square.ngc", test::kSquare);
  Launch launch;
  launch.arguments = {"canon", "square.ngc"};
  launch.folder = scratch.path();
  launch.stdout_path = "/dev/full";
  const Finished run = run_kadr(launch);
  CHECK(run.code == 2);
  CHECK(run.err == "kadr: standard output: No space left on device\n");
}
