#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <kadr/axis_t.hpp>
#include <kadr/block_end_t.hpp>
#include <kadr/block_t.hpp>
#include <kadr/diag_t.hpp>
#include <kadr/event_t.hpp>
#include <kadr/feed_t.hpp>
#include <kadr/run_t.hpp>
#include <kadr/steps_t.hpp>
#include <kadr/summary_t.hpp>
#include <kadr/ticks_t.hpp>
#include <map>
#include <sstream>

#include "emulator/log/describe.h"
#include "emulator/log/pulse_code.h"
#include "log_support.h"

/// The log as docs/log_format.md describes it.
using namespace kadr;
using namespace kadr::log;

namespace {

std::string document() {
  std::ifstream in(KADR_SOURCE_DIR "/docs/log_format.md");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The part of a file from `begin` up to `end` (empty: the file's begin, its end) is `text`. KADR_REGENERATE
/// writes it.
void check_file(const std::string& path, const std::string& begin, const std::string& end,
                const std::string& text) {
  std::ifstream in(path);
  std::stringstream stream;
  stream << in.rdbuf();
  std::string file = stream.str();
  const std::size_t from = begin.empty() ? 0 : file.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t to = end.empty() ? file.size() : file.find(end, from);
  REQUIRE(to != std::string::npos);
  if (std::getenv("KADR_REGENERATE") != nullptr) {
    file.replace(from, to - from, text);
    std::ofstream(path) << file;
    return;
  }
  CAPTURE(path);
  CHECK(file.substr(from, to - from) == text);
}

/// Output of a shell command, with its exit status.
std::pair<int, std::string> run(const std::string& command) {
  std::string out;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return {-1, out};
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    out.append(buffer.data(), n);
  return {::pclose(pipe), out};
}

}  // namespace

TEST_CASE("emulator/log/kadr.lcm is what the channels' tables say") {
  check_file(KADR_SOURCE_DIR "/emulator/log/kadr.lcm", "", "", lcm_definition());
}

TEST_CASE("docs/log_format.md has every channel with its fingerprint, and every field with its unit") {
  const std::string path = KADR_SOURCE_DIR "/docs/log_format.md";
  check_file(path, "| channel | type |", "\nExact channels and viewer", channel_table());
  check_file(path, "### KADR_RUN (run_t)", "", field_tables());
}

TEST_CASE("every table in emulator/log/channels is in the list of channels") {
  std::vector<std::string> listed;
  for (const ChannelDescription& channel : describe_channels()) listed.emplace_back(channel.title.name);
  std::size_t tables = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KADR_SOURCE_DIR "/emulator/log/channels")) {
    if (entry.path().extension() != ".h") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const std::size_t title = text.find("ChannelTitle info{");
    CAPTURE(entry.path());
    REQUIRE(title != std::string::npos);
    const std::size_t name = text.find('"', title) + 1;
    CHECK(std::count(listed.begin(), listed.end(), text.substr(name, text.find('"', name) - name)) == 1);
    ++tables;
  }
  CHECK(tables == listed.size());
}

TEST_CASE("the tables' fingerprints are those of lcm-gen's classes") {
  const std::map<std::string, std::int64_t> made{{"run_t", run_t::getHash()},
                                                 {"block_t", block_t::getHash()},
                                                 {"block_end_t", block_end_t::getHash()},
                                                 {"ticks_t", ticks_t::getHash()},
                                                 {"steps_t", steps_t::getHash()},
                                                 {"feed_t", feed_t::getHash()},
                                                 {"axis_t", axis_t::getHash()},
                                                 {"event_t", event_t::getHash()},
                                                 {"diag_t", diag_t::getHash()},
                                                 {"summary_t", summary_t::getHash()}};
  for (const ChannelDescription& channel : describe_channels()) {
    CAPTURE(channel.title.type);
    const auto it = made.find(std::string(channel.title.type));
    if (it == made.end()) continue;  // its kadr.lcm is compared word by word above
    CHECK(channel.fingerprint == it->second);
  }
}

TEST_CASE("the pulse code example of docs/log_format.md is what the encoder writes") {
  PulseEncoder encoder;
  encoder.begin_block();
  AxisPulses p;
  p.offset_ticks = {0, 1, 2};
  p.first_sign = -1;
  encoder.add(p, 0);
  p.first_sign = 1;
  p.reversals = {2};
  encoder.add(p, 6);
  std::vector<std::uint8_t> code;
  encoder.finish_block(code);
  std::string line = "    code    ";
  for (std::size_t i = 0; i < code.size(); ++i)
    line += fmt::format("{}{:02x}",
                        i < 6    ? "  " + std::string(i == 0 ? 1 : 0, ' ')
                        : i == 6 ? "         "
                                 : " ",
                        code[i]);
  CAPTURE(line);
  CHECK(document().find(line) != std::string::npos);
}

TEST_CASE("the Python decoder of docs/log_format.md finds every pulse of a log") {
  const std::string text = document();
  const std::size_t begin = text.find("```python\n"), end = text.find("```", begin + 3);
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  const test::TestFolder folder;
  std::ofstream(folder / "decode.py") << text.substr(begin + 10, end - begin - 10);
  const auto machine = test::log_machine(3);
  test::write_log(folder / "a.lcmlog", machine, 2500);

  test::FakeRun fake(machine);
  std::array<std::int64_t, 3> count{}, net{}, last{};
  for (std::int64_t k = 0; k < 2500; ++k) {
    fake.advance();
    for (std::size_t a = 0; a < 3; ++a) {
      const AxisPulses& p = fake.batch().axis[a];
      count[a] += static_cast<std::int64_t>(p.count());
      net[a] += p.net_steps().value;
      if (p.count() > 0) last[a] = k * 10'000 + p.offset_ticks.back();
    }
  }
  std::string expected;
  for (std::size_t a = 0; a < 3; ++a) expected += fmt::format("{} {} {} {}\n", a, count[a], net[a], last[a]);

  if (run("python3 --version 2>/dev/null").first != 0) {
    MESSAGE("not tested: this host has no python3");
    return;
  }
  const auto [status, out] = run(fmt::format("python3 '{}' '{}'", folder / "decode.py", folder / "a.lcmlog"));
  CHECK(status == 0);
  CHECK(out == expected);
}
