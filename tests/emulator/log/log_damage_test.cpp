#include <doctest/doctest.h>

#include <lcm/lcm-cpp.hpp>

#include "emulator/log/log_info.h"
#include "log_support.h"
#include "machine/machine.h"

using namespace kadr;
using namespace kadr::log;
using test::TestFolder;

namespace {

struct ReadResult {
  bool opened = false;
  LogReadFault fault{};
  std::string reason;
  LogEnd end;
  std::int64_t messages = 0;
};

ReadResult read_all(const std::string& path) {
  ReadResult o;
  auto reader = LogReader::inspect(path);
  if (!reader) {
    o.fault = reader.error().fault;
    o.reason = reader.error().reason;
    return o;
  }
  o.opened = true;
  for (LogMessage m; reader->next(m);) ++o.messages;
  o.end = reader->end();
  return o;
}

/// Begin and end of every event of a whole log.
std::vector<std::int64_t> event_ends(const std::string& path) {
  auto reader = LogReader::open(path);
  REQUIRE(reader.has_value());
  std::vector<std::int64_t> ends{0};
  for (LogMessage m; reader->next(m);) ends.push_back(ends.back() + reader->event().bytes());
  return ends;
}

}  // namespace

TEST_CASE("a log cut at any byte is read up to its last whole event and says that it was cut") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(2), 70, {.peak_steps_per_s = 3000});
  const auto bytes = test::read_bytes(folder / "a");
  const auto ends = event_ends(folder / "a");
  REQUIRE(ends.back() == static_cast<std::int64_t>(bytes.size()));
  REQUIRE(ends.size() > 10);
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    test::write_bytes(folder / "cut", {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut)});
    const ReadResult o = read_all(folder / "cut");
    CAPTURE(cut);
    const auto at = static_cast<std::int64_t>(cut);
    const auto whole = std::upper_bound(ends.begin(), ends.end(), at) - ends.begin() - 1;
    if (whole == 0) {
      REQUIRE_FALSE(o.opened);
      REQUIRE((o.fault == LogReadFault::not_a_log || o.fault == LogReadFault::cut_in_header));
      REQUIRE_FALSE(o.reason.empty());
      continue;
    }
    REQUIRE(o.opened);
    REQUIRE(o.messages == whole);
    REQUIRE(o.end.state == LogState::cut_off);
    REQUIRE(o.end.valid_bytes == ends[static_cast<std::size_t>(whole)]);
    REQUIRE(o.end.file_bytes == at);
    REQUIRE(o.end.detail.substr(0, 8) == "cut off:");
    // exact data: 70 ticks are blocks of 32, 32 and 6
    REQUIRE((o.end.valid_until.value == 0 || o.end.valid_until.value == 320'000 ||
             o.end.valid_until.value == 640'000 || o.end.valid_until.value == 700'000));
  }
}

TEST_CASE("a flipped bit never goes unseen in a complete log, and never harms the reader") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(3), 200, {.peak_steps_per_s = 8000});
  const auto bytes = test::read_bytes(folder / "a");
  test::Random random(test::from_environment("KADR_SEED", 3));
  const auto count = test::from_environment("KADR_COUNT", 1500);
  std::uint64_t damaged = 0, refused = 0, found_by_hash = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    auto flipped = bytes;
    const auto at = static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(bytes.size()) - 1));
    flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1u << random.between(0, 7)));
    test::write_bytes(folder / "b", flipped);
    const auto info = log_info(folder / "b");
    CAPTURE(at);
    if (!info) {
      REQUIRE_FALSE(info.error().reason.empty());
      ++refused;
    } else {
      REQUIRE_FALSE(is_sound(info->end.state));
      REQUIRE_FALSE(info->end.detail.empty());
      ++(info->end.state == LogState::altered ? found_by_hash : damaged);
    }
    if (info) REQUIRE_FALSE(render_log_info(*info).empty());
  }
  CHECK(damaged + refused + found_by_hash == count);
  if (count < 500) return;  // too few to meet every kind
  CHECK(damaged > 0);
  CHECK(refused > 0);
  CHECK(found_by_hash > 0);
}

TEST_CASE("many flipped bytes and random rubbish behind a good beginning are survived") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(2), 100);
  const auto bytes = test::read_bytes(folder / "a");
  test::Random random(test::from_environment("KADR_SEED", 4));
  const auto count = test::from_environment("KADR_COUNT", 400);
  std::uint64_t good = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    auto harmed = bytes;
    const std::int64_t last = static_cast<std::int64_t>(bytes.size()) - 1;
    if (run % 2 == 0)
      for (std::int64_t n = random.between(1, 200); n > 0; --n)
        harmed[static_cast<std::size_t>(random.between(0, last))] = static_cast<std::uint8_t>(random.bits());
    else
      for (std::int64_t i = random.between(0, last); i <= last; ++i)
        harmed[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(random.bits());
    test::write_bytes(folder / "b", harmed);
    const auto info = log_info(folder / "b");
    if (info && info->end.state == LogState::complete) ++good;
  }
  CHECK(good < count / 10);
}

TEST_CASE("lengths of two gigabytes in a small file are not believed") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(1), 40);
  const auto bytes = test::read_bytes(folder / "a");
  const auto ends = event_ends(folder / "a");
  // in turn: data length of the first event, of the third; count of axes and of control ticks in a KADR_TICKS
  for (const std::size_t at : {std::size_t{24}, static_cast<std::size_t>(ends[2]) + 24}) {
    auto harmed = bytes;
    for (std::size_t i = 0; i < 4; ++i) harmed[at + i] = i == 0 ? 0x7f : 0xff;
    test::write_bytes(folder / "b", harmed);
    const ReadResult o = read_all(folder / "b");
    CHECK((!o.opened || o.end.state == LogState::cut_off));
  }
  for (std::size_t e = 1; e + 1 < ends.size(); ++e)
    for (std::int64_t at = ends[e] + 28 + 20; at + 4 <= std::min(ends[e] + 120, ends[e + 1]); at += 4) {
      auto harmed = bytes;
      for (std::size_t i = 0; i < 4; ++i) harmed[static_cast<std::size_t>(at) + i] = i == 0 ? 0x7f : 0xff;
      test::write_bytes(folder / "b", harmed);
      const auto info = log_info(folder / "b");
      REQUIRE((!info || !is_sound(info->end.state)));
    }
}

TEST_CASE("what is no kadr log is told from what can't be read") {
  const TestFolder folder;
  CHECK(read_all(folder / "missing").fault == LogReadFault::cannot_open);
  CHECK(read_all(folder / "missing").reason == "No such file or directory");
  CHECK(read_all(folder.path()).fault == LogReadFault::cannot_open);
  CHECK(read_all(folder.path()).reason == "not a regular file");

  test::write_bytes(folder / "empty", {});
  CHECK(read_all(folder / "empty").fault == LogReadFault::not_a_log);
  CHECK(read_all(folder / "empty").reason == "the file is empty");

  test::write_bytes(folder / "text", std::vector<std::uint8_t>(100, 'G'));
  CHECK(read_all(folder / "text").fault == LogReadFault::not_a_log);
  CHECK(read_all(folder / "text").reason == "not an LCM event log: no event begins at byte 0");

  {
    lcm::LogFile other(folder / "other", "w");
    lcm::LogEvent e{};
    char data[] = "12345678";
    e.channel = "POSE";
    e.datalen = 8;
    e.data = data;
    REQUIRE(other.writeEvent(&e) == 0);
  }
  CHECK(read_all(folder / "other").fault == LogReadFault::other_log);
  CHECK(read_all(folder / "other").reason == "an LCM log, but not of kadr: its first channel is POSE");

  // the format number follows fingerprint and tick: byte 28 + 8 ("KADR_RUN") + 8 + 8 + 3
  test::write_log(folder / "a", test::log_machine(1), 1);
  auto bytes = test::read_bytes(folder / "a");
  REQUIRE(bytes[55] == 2);
  bytes[55] = 3;
  test::write_bytes(folder / "newer", bytes);
  CHECK(read_all(folder / "newer").fault == LogReadFault::other_format);
}

TEST_CASE("bytes behind the summary make a log damaged, not complete") {
  const TestFolder folder;
  test::write_log(folder / "a", test::log_machine(1), 33);
  auto bytes = test::read_bytes(folder / "a");
  bytes.push_back(0);
  test::write_bytes(folder / "b", bytes);
  const ReadResult o = read_all(folder / "b");
  CHECK(o.end.state == LogState::damaged);
  CHECK(o.end.valid_until.value == 330'000);
  CHECK(o.end.valid_bytes == static_cast<std::int64_t>(bytes.size()) - 1);
}
