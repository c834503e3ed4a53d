#include <doctest/doctest.h>

#include <map>

#include "emulator/log/describe.h"
#include "emulator/log/log.h"
#include "emulator/log/log_decode.h"
#include "emulator/log/log_messages.h"
#include "log_events.h"
#include "log_support.h"
#include "machine/machine.h"

/// How logs of older and newer kadrs are read (docs/log_format.md, "Older and newer logs").
using namespace kadr;
using namespace kadr::log;
using test::TestFolder;

namespace {

/// Log of kadr 0.1.0, format 2: lines, an arc, a dwell, an output, override steps, alarms, energies, a
/// warning.
const std::string kFormat2 = KADR_SOURCE_DIR "/tests/emulator/log/data/format2.lcm";

using Event = test::LogEvent;

std::vector<Event> events_of(const std::string& path) { return test::events_of(test::read_bytes(path)); }

/// Writes events as an LCM log whose hashes fit.
void write_events(const std::string& path, std::vector<Event> events) {
  test::seal(events);
  test::write_bytes(path, test::log_of(events));
}

/// The messages of a newer kadr: another fingerprint, and a field behind ours.
void append_field(Event& e, std::vector<std::uint8_t> field = {0, 0, 0, 1}) {
  e.data[3] ^= 0x55;
  e.data.insert(e.data.end(), field.begin(), field.end());
}

struct Read {
  LogEnd end;
  std::int64_t messages = 0, unknown = 0;
  std::vector<double> path_u;
};
Read read(const std::string& path) {
  auto reader = LogReader::open(path);
  REQUIRE_MESSAGE(reader.has_value(), (reader ? "" : reader.error().reason));
  Read out;
  for (LogMessage m; reader->next(m); ++out.messages) {
    if (std::holds_alternative<UnknownMessage>(m)) ++out.unknown;
    if (const auto* t = std::get_if<TickBlock>(&m))
      out.path_u.insert(out.path_u.end(), t->path_u.begin(), t->path_u.end());
  }
  out.end = reader->end();
  return out;
}

/// A record as it was two fields ago: the table of today, and one that knows less.
struct Sample {
  std::int64_t number = 0;
  std::vector<double> values;
  double level = 0.5;
  std::vector<double> more;
};

}  // namespace

namespace kadr::log {
template <std::same_as<Sample> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_SAMPLE", "sample_t", "a channel of this test"};
  static constexpr std::size_t first_fields = 3;
  static constexpr std::array fields{
      field::i64<&R::number>("number", ""),
      field::count<R, field::length<&R::values>>("n", CountRule::block_ticks),
      field::real<&R::values>("values", FieldUnit::none, "").by("n"),
      field::real<&R::level>("level", FieldUnit::none, "appended"),
      field::real<&R::more>("more", FieldUnit::none, "appended later").by("n"),
  };
};
}  // namespace kadr::log

namespace {

/// The message as a kadr wrote it that knew only the first fields of Sample.
std::vector<std::uint8_t> message_of(const Sample& sample, std::size_t known) {
  std::vector<std::uint8_t> bytes;
  WireWriter out(bytes);
  out.i64(fingerprint<Sample>(known));
  for (std::size_t i = 0; i < known; ++i) Channel<Sample>::fields[i].put(out, sample, LogHeader{});
  return bytes;
}

template <class R>
bool encodes_to_the_same(const Event& e, const LogHeader& header) {
  auto decoded = decode<R>(e.data, e.channel, header);
  if (!decoded) return false;
  // fields of before one was appended keep their bytes; behind the fingerprint
  constexpr std::size_t kFingerprint = 8;
  std::vector<std::uint8_t> again;
  encode(decoded->record, header, again);
  if (again.size() < e.data.size()) return false;
  return std::equal(e.data.begin() + kFingerprint, e.data.end(), again.begin() + kFingerprint);
}

}  // namespace

TEST_CASE("a log of format 2 is read to its last bit, and its messages are encoded to the same bytes again") {
  auto reader = LogReader::open(kFormat2);
  REQUIRE(reader.has_value());
  const LogHeader header = reader->header();
  CHECK(header.log_format == 2);
  CHECK(header.program_name == "format2.ngc");
  const auto events = events_of(kFormat2);
  std::size_t compared = 0;
  for (const Event& e : events) {
    CAPTURE(e.channel);
    bool same = false, known = false;
    for_each_channel(Channels{}, [&]<class R>() {
      const ChannelTitle title = Channel<R>::info;
      if (!(title.each_axis ? e.channel.starts_with(title.name) : e.channel == title.name)) return;
      known = true;
      same = encodes_to_the_same<R>(e, header);
    });
    REQUIRE(known);
    REQUIRE(same);
    ++compared;
  }
  CHECK(compared == 177);
  const auto info = log_info(kFormat2);
  REQUIRE(info);
  CHECK(info->end.state == LogState::complete);
  CHECK(info->end.passed_over.empty());
  CHECK(info->content_hash_agrees() == true);
  CHECK(info->steps_hash_agrees() == true);
  CHECK(info->summary->run.steps_hash == 0x03b6b8ba1e19ce76u);
  CHECK(info->alarms == 9);
  CHECK(info->diagnostics == 1);
}

TEST_CASE("every channel's type still begins with the fields that logs of format 2 have") {
  // the first fields of each table, as the logs that are out there have them: these numbers never change
  const std::map<std::string, std::uint64_t> written{
      {"KADR_RUN", 0x29c5b14c76ef03ad},       {"KADR_BLOCK", 0x8dc9f6fe9d7788a2},
      {"KADR_BLOCK_END", 0xfd5e3206c61bb2c0}, {"KADR_TICKS", 0x2cf08f86d2a045e8},
      {"KADR_STEPS", 0xd19d26201ebe2be5},     {"KADR_FEED", 0x3b701fb342f0c642},
      {"KADR_AXIS_", 0xfdf35f34cf9a510a},     {"KADR_EVENT", 0xf8545232105264a0},
      {"KADR_DIAG", 0xb58e0e0344604dc6},      {"KADR_SUMMARY", 0xc7bdcec3d24407fa},
  };
  std::size_t found = 0;
  for_each_channel(Channels{}, [&]<class R>() {
    const auto it = written.find(std::string(Channel<R>::info.name));
    if (it == written.end()) return;
    ++found;
    CAPTURE(it->first);
    CHECK(static_cast<std::uint64_t>(kFingerprints<R>.front()) == it->second);
  });
  CHECK(found == written.size());
}

TEST_CASE(
    "an appended field does not stop a reader: of an older log it has its default, of a newer one it is "
    "passed over") {
  const LogHeader header;
  Sample sample{7, {1, 2, 3}, 0.25, {4, 5, 6}};
  const auto older = decode<Sample>(message_of(sample, 3), "KADR_SAMPLE", header);
  REQUIRE(older.has_value());
  CHECK_FALSE(older->newer);
  CHECK(older->record.values == sample.values);
  CHECK(older->record.level == 0.5);
  CHECK(older->record.more ==
        std::vector<double>(3, 0.0));  // as long as its count, so that it can be indexed

  const auto between = decode<Sample>(message_of(sample, 4), "KADR_SAMPLE", header);
  REQUIRE(between.has_value());
  CHECK(between->record.level == 0.25);

  Event newer{"KADR_SAMPLE", 0, message_of(sample, 5)};
  append_field(newer);
  const auto read = decode<Sample>(newer.data, "KADR_SAMPLE", header);
  REQUIRE(read.has_value());
  CHECK(read->newer);
  CHECK(read->record.more == sample.more);
}

TEST_CASE(
    "a wrong fingerprint is damage unless more fields follow, and known fields must end with the message") {
  const LogHeader header;
  const Sample sample{7, {1, 2}, 0.25, {4, 5}};
  auto bytes = message_of(sample, 5);
  bytes[0] ^= 1;
  auto damaged = decode<Sample>(bytes, "KADR_SAMPLE", header);
  REQUIRE_FALSE(damaged.has_value());
  CHECK(damaged.error() == "its fingerprint is not that of its type");
  bytes = message_of(sample, 3);
  bytes.push_back(0);
  damaged = decode<Sample>(bytes, "KADR_SAMPLE", header);
  REQUIRE_FALSE(damaged.has_value());
  CHECK(damaged.error() == "bytes are left over after its fields");
  bytes = message_of(sample, 4);
  bytes.pop_back();
  CHECK_FALSE(decode<Sample>(bytes, "KADR_SAMPLE", header).has_value());
}

TEST_CASE(
    "a log of a newer kadr is read: fields and channels that are not known are passed over and said once") {
  const TestFolder folder;
  auto events = events_of(kFormat2);
  const Read before = read(kFormat2);
  std::vector<Event> newer;
  for (Event& e : events) {
    const bool summary = e.channel == "KADR_SUMMARY";
    if (e.channel == "KADR_TICKS" || e.channel == "KADR_RUN") append_field(e);
    if (!summary) newer.push_back(e);
    if (e.channel == "KADR_TICKS") newer.push_back({"KADR_LOAD", e.time_us, {1, 2, 3}});
    if (summary) newer.push_back(e);
  }
  write_events(folder / "newer", newer);
  const Read after = read(folder / "newer");
  CHECK(after.end.state == LogState::complete);
  CHECK(after.path_u == before.path_u);
  CHECK(after.unknown == 6);
  CHECK(
      after.end.passed_over ==
      std::vector<std::string>{"KADR_RUN has fields that this version does not know: they are passed over",
                               "KADR_TICKS has fields that this version does not know: they are passed over",
                               "channel KADR_LOAD is not known: it is passed over"});
}

TEST_CASE("a log of a higher format is refused, with both numbers") {
  const TestFolder folder;
  auto events = events_of(kFormat2);
  REQUIRE(events[0].data[8 + 8 + 3] == 2);
  events[0].data[8 + 8 + 3] = 9;
  write_events(folder / "higher", events);
  const auto reader = LogReader::open(folder / "higher");
  REQUIRE_FALSE(reader.has_value());
  CHECK(reader.error().fault == LogReadFault::other_format);
  CHECK(reader.error().reason == "written by another version of kadr: log format 9, this one reads 2");
}

TEST_CASE("many unknown channels in a hostile log are said at most eight times") {
  const TestFolder folder;
  auto events = events_of(kFormat2);
  const Event last = events.back();
  events.pop_back();
  for (int i = 0; i < 100; ++i) events.push_back({"OTHER_" + std::to_string(i), last.time_us, {}});
  events.push_back(last);
  write_events(folder / "many", events);
  const Read many = read(folder / "many");
  CHECK(many.unknown == 100);
  CHECK(many.end.passed_over.size() == kMostNotes);
}
