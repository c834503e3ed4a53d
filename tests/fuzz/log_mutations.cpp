#include "log_mutations.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "emulator/log/log_messages.h"
#include "tests/emulator/log/log_events.h"

namespace kadr::fuzz {
namespace {

using test::LogEvent;
using Events = std::vector<LogEvent>;

constexpr std::size_t kFieldsAt = 8;  // behind the fingerprint

std::uint64_t number_at(const Bytes& data, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value = value << 8 | data[at + i];
  return value;
}
void put_number(Bytes& data, std::size_t at, std::size_t width, std::uint64_t value) {
  for (std::size_t i = 0; i < width; ++i)
    data[at + i] = static_cast<std::uint8_t>(value >> (8 * (width - 1 - i)));
}

std::uint64_t odd_number(Chance& chance, std::size_t width) {
  static constexpr std::array<std::uint64_t, 8> kWhole{
      0,   1, 63, 65, std::uint64_t{1} << 62, std::numeric_limits<std::int64_t>::max(), ~std::uint64_t{0},
      1000};
  static constexpr std::array<double, 7> kReal{0.0,
                                               -1.0,
                                               1e308,
                                               -1e308,
                                               1e-308,
                                               std::numeric_limits<double>::infinity(),
                                               std::numeric_limits<double>::quiet_NaN()};
  if (width == 8 && chance.one_in(2)) return std::bit_cast<std::uint64_t>(kReal[chance.below(kReal.size())]);
  if (width == 4 && chance.one_in(3)) return 0x7fffffff;
  return kWhole[chance.below(kWhole.size())];
}

LogEvent& any(Events& events, Chance& chance) { return events[chance.below(events.size())]; }

bool is_exact(const LogEvent& e) { return e.channel == "KADR_TICKS" || e.channel == "KADR_STEPS"; }

void swap_two(Events& events, Chance& chance) {
  std::swap(events[chance.below(events.size())], events[chance.below(events.size())]);
}
void drop_one(Events& events, Chance& chance) {
  if (events.size() > 1)
    events.erase(events.begin() + static_cast<std::ptrdiff_t>(chance.below(events.size())));
}
void double_one(Events& events, Chance& chance) {
  const LogEvent copy = any(events, chance);
  events.insert(events.begin() + static_cast<std::ptrdiff_t>(chance.below(events.size() + 1)), copy);
}
void move_one(Events& events, Chance& chance) {
  const std::size_t from = chance.below(events.size());
  LogEvent moved = std::move(events[from]);
  events.erase(events.begin() + static_cast<std::ptrdiff_t>(from));
  events.insert(events.begin() + static_cast<std::ptrdiff_t>(chance.below(events.size() + 1)),
                std::move(moved));
}
/// Messages of one channel change their places, stamps stay.
void swap_messages(Events& events, Chance& chance) {
  LogEvent &a = any(events, chance), &b = any(events, chance);
  if (a.channel == b.channel) std::swap(a.data, b.data);
}
void flip_bit(Events& events, Chance& chance) {
  Bytes& data = any(events, chance).data;
  if (!data.empty()) data[chance.below(data.size())] ^= static_cast<std::uint8_t>(1u << chance.below(8));
}
void odd_value(Events& events, Chance& chance) {
  Bytes& data = any(events, chance).data;
  const std::size_t width = chance.one_in(2) ? 8 : 4;
  if (data.size() < kFieldsAt + width) return;
  const std::size_t places = (data.size() - kFieldsAt - width) / 4 + 1;
  put_number(data, kFieldsAt + 4 * chance.below(places), width, odd_number(chance, width));
}
void shift_stamp(Events& events, Chance& chance) {
  any(events, chance).time_us += static_cast<std::int64_t>(chance.below(4001)) - 2000;
}
/// Tick, control tick and stamp of a block of exact data, together.
void shift_block(Events& events, Chance& chance) {
  constexpr std::uint64_t kTau = 10'000;
  const std::int64_t by =
      chance.one_in(8) ? std::int64_t{1} << chance.below(40) : static_cast<std::int64_t>(chance.below(9)) - 4;
  const bool all = chance.one_in(2);
  const std::size_t from = chance.below(events.size());
  for (std::size_t i = from; i < events.size(); ++i) {
    LogEvent& e = events[i];
    if (!is_exact(e) || e.data.size() < 24) continue;
    const auto shift = static_cast<std::uint64_t>(by);
    put_number(e.data, 8, 8, number_at(e.data, 8, 8) + shift * kTau);
    put_number(e.data, 16, 8, number_at(e.data, 16, 8) + shift);
    e.time_us += by * 1000;
    if (!all) return;
  }
}
/// The five columns of the plant, or those of the override, are gone from a KADR_TICKS.
void drop_columns(Events& events, Chance& chance) {
  for (std::size_t tries = 0; tries < 8; ++tries) {
    Bytes& data = any(events, chance).data;
    if (data.size() < 64 ||
        number_at(data, 0, 8) != static_cast<std::uint64_t>(log::kFingerprints<log::TickBlock>.back()))
      continue;
    const std::size_t n = number_at(data, 24, 4), axes = number_at(data, 28, 4),
                      plant = number_at(data, 32, 4), override = number_at(data, 36, 4);
    const std::size_t head = 40 + 4 * 8 * n + 2 * n + 4 * n + 8 * axes + 4 * n * axes + 8 * n * axes;
    const std::size_t states = 5 * 8 * n * plant;
    if (n > 64 || axes > 64 || plant > 64 || override > 64 || head + states > data.size()) continue;
    const bool of_plant = chance.one_in(2);
    put_number(data, of_plant ? 32 : 36, 4, 0);
    const auto at = data.begin() + static_cast<std::ptrdiff_t>(of_plant ? head : head + states);
    data.erase(at, of_plant ? at + static_cast<std::ptrdiff_t>(states) : data.end());
    return;
  }
}
void cut_message(Events& events, Chance& chance) {
  Bytes& data = any(events, chance).data;
  if (chance.one_in(2))
    data.resize(chance.below(data.size() + 1));
  else
    data.insert(data.end(), 1 + chance.below(16), static_cast<std::uint8_t>(chance.bits()));
}
void rename_channel(Events& events, Chance& chance) {
  static constexpr std::array kNames{"KADR_TICKS", "KADR_STEPS", "KADR_AXIS_X",
                                     "KADR_OTHER", "\x1b[31m",   "KADR_SUMMARY"};
  any(events, chance).channel = kNames[chance.below(kNames.size())];
}
void add_unknown(Events& events, Chance& chance) {
  const std::size_t at = chance.below(events.size());
  events.insert(events.begin() + static_cast<std::ptrdiff_t>(at),
                {"OTHER", events[at].time_us, Bytes(chance.below(9), 7)});
}
/// Another text, in one of the places where the header, a block or an event has one.
void odd_text(Events& events, Chance& chance) {
  static constexpr std::array kTexts{"<script>", "a,b\"c\n", "***********.*", "$end", "\x1b]0;x\x07",
                                     "\xff\xfe", ""};
  Bytes& data = any(events, chance).data;
  std::vector<std::size_t> texts;
  for (std::size_t at = kFieldsAt; at + 5 <= data.size(); ++at) {
    const std::size_t size = number_at(data, at, 4);
    if (size >= 1 && size < 100 && at + 4 + size <= data.size() && data[at + 4 + size - 1] == 0)
      texts.push_back(at);
  }
  if (texts.empty()) return;
  const std::size_t at = texts[chance.below(texts.size())], size = number_at(data, at, 4);
  const char* text = kTexts[chance.below(kTexts.size())];
  const std::size_t length = std::strlen(text) + 1;
  put_number(data, at, 4, length);
  const auto begin = data.begin() + static_cast<std::ptrdiff_t>(at + 4);
  data.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
  data.insert(data.begin() + static_cast<std::ptrdiff_t>(at + 4), text, text + length);
}

using Change = void (*)(Events&, Chance&);
constexpr std::array<Change, 14> kChanges{
    swap_two,    drop_one,    double_one,   move_one,    swap_messages,  flip_bit,    odd_value,
    shift_stamp, shift_block, drop_columns, cut_message, rename_channel, add_unknown, odd_text};

}  // namespace

std::uint64_t Chance::bits() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

Mutation mutated(const Bytes& log, Chance& chance) {
  Events events = test::events_of(log);
  if (events.empty()) return {log, true};
  for (std::size_t n = 1 + chance.below(4); n > 0; --n)
    kChanges[chance.below(kChanges.size())](events, chance);
  Mutation out;
  out.sealed = !chance.one_in(4);
  if (out.sealed) test::seal(events);
  out.log = test::log_of(events);
  // the frame of the events itself: rarely, it hides everything else
  if (!out.sealed && chance.one_in(4) && !out.log.empty())
    out.log[chance.below(out.log.size())] ^= static_cast<std::uint8_t>(1u << chance.below(8));
  return out;
}

}  // namespace kadr::fuzz
