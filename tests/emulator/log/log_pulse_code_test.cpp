#include <doctest/doctest.h>

#include "emulator/log/pulse_code.h"
#include "log_support.h"

using namespace kadr;
using log::PulseCounts;
using log::PulseEncoder;
using test::Random;

namespace {

using Bytes = std::vector<std::uint8_t>;

AxisPulses pulses(std::vector<std::uint16_t> offsets, std::int8_t first_sign = 1,
                  std::vector<std::uint16_t> reversals = {}) {
  AxisPulses p;
  p.offset_ticks = std::move(offsets);
  p.first_sign = first_sign;
  p.reversals = std::move(reversals);
  return p;
}

struct Coded {
  Bytes code;
  PulseCounts counts;
};

Coded encode(const std::vector<AxisPulses>& ticks, std::int32_t tau) {
  PulseEncoder encoder;
  encoder.begin_block();
  std::int32_t begin = 0;
  for (const AxisPulses& p : ticks) {
    encoder.add(p, begin);
    begin += tau;
  }
  Coded coded;
  encoder.finish_block(coded.code);
  coded.counts = {encoder.pulses(), encoder.reversals(), static_cast<std::int32_t>(ticks.size()), tau};
  return coded;
}

std::vector<StepBatch> batches(const PulseCounts& counts) {
  std::vector<StepBatch> list(static_cast<std::size_t>(counts.ticks));
  for (StepBatch& b : list) b.axis.resize(1);
  return list;
}

/// A tick of random pulses: none, few, many, or one in every base tick; a reversal now and then.
AxisPulses random_pulses(Random& random, std::int32_t tau) {
  AxisPulses p;
  const std::int64_t kind = random.between(0, 5);
  const std::int64_t gap = kind == 5 ? 1 : kind == 0 ? tau : random.between(1, tau);
  std::int64_t at = kind == 5 ? 0 : random.between(0, gap);
  while (at < tau) {
    p.offset_ticks.push_back(static_cast<std::uint16_t>(at));
    at += kind == 5 ? 1 : random.between(kind == 4 ? 0 : gap / 2, gap);
    if (p.count() == 60'000) break;
  }
  if (p.count() == 0) return p;
  p.first_sign = random.between(0, 1) ? 1 : -1;
  for (std::size_t i = 1; i < p.count(); ++i)
    if (random.between(0, 40) == 0) p.reversals.push_back(static_cast<std::uint16_t>(i));
  return p;
}

bool equal(const AxisPulses& a, const AxisPulses& b) {
  return a.offset_ticks == b.offset_ticks && a.reversals == b.reversals &&
         (a.count() == 0 || a.first_sign == b.first_sign);
}

}  // namespace

TEST_CASE("pulses at 100, 300, 500, 710 base ticks are the bytes C8 01 C8 01 00 14") {
  // intervals 100 200 200 210 (the first from 0), their differences +100 +100 0 +10 (the first from 0),
  // zigzag 200 200 0 20; 200 = 0b1'1001000: C8 01
  CHECK(encode({pulses({100, 300, 500, 710})}, 10'000).code == Bytes{0xC8, 0x01, 0xC8, 0x01, 0x00, 0x14});
}

TEST_CASE(
    "time goes on over the control ticks of a block: 9950 and then 50 of the next are 100 base ticks apart") {
  // tau 10000: intervals 9950, 100; differences +9950, -9850; zigzag 19900 = 0x4DBC: BC 9B 01, 19699 =
  // 0x4CF3: F3 99 01
  const Coded coded = encode({pulses({9950}), pulses({50})}, 10'000);
  CHECK(coded.code == Bytes{0xBC, 0x9B, 0x01, 0xF3, 0x99, 0x01});
  auto out = batches(coded.counts);
  REQUIRE(log::decode_pulses(coded.code, coded.counts, out, 0));
  CHECK(out[0].axis[0].offset_ticks == std::vector<std::uint16_t>{9950});
  CHECK(out[1].axis[0].offset_ticks == std::vector<std::uint16_t>{50});
}

TEST_CASE("three pulses back, two forth, one back reverse at pulses 0, 3 and 5") {
  // intervals 0 1 1 1 1 1, differences 0 +1 0 0 0 0; reversal gaps 0 3 2
  const Coded coded = encode({pulses({0, 1, 2}, -1), pulses({}), pulses({0, 1, 2}, 1, {2})}, 3);
  CHECK(coded.counts.reversals == 3);
  // the empty tick in the middle: interval 4 from 2 to 6, so +1 0 | +3 -3 0
  CHECK(coded.code == Bytes{0, 2, 0, 6, 5, 0, 0, 3, 2});
  auto out = batches(coded.counts);
  REQUIRE(log::decode_pulses(coded.code, coded.counts, out, 0));
  CHECK(out[0].axis[0].first_sign == -1);
  CHECK(out[1].axis[0].count() == 0);
  CHECK(out[2].axis[0].first_sign == 1);
  CHECK(out[2].axis[0].reversals == std::vector<std::uint16_t>{2});
  CHECK(out[0].axis[0].net_steps().value + out[2].axis[0].net_steps().value == -2);
}

TEST_CASE("an even pace costs one byte a pulse") {
  // 50 kHz at 10 MHz: every 200 base ticks, 50 in a tick, 32 ticks; the first two pulses cost one byte more
  std::vector<std::uint16_t> offsets;
  for (int i = 0; i < 50; ++i) offsets.push_back(static_cast<std::uint16_t>(100 + 200 * i));
  const Coded coded = encode(std::vector<AxisPulses>(32, pulses(offsets)), 10'000);
  CHECK(coded.counts.pulses == 1600);
  CHECK(coded.code.size() == 1602);
}

TEST_CASE("any pulses come back as they went in") {
  Random random(test::from_environment("KADR_SEED", 1));
  const auto count = test::from_environment("KADR_COUNT", 300);
  for (std::uint64_t run = 0; run < count; ++run) {
    const auto tau = static_cast<std::int32_t>(run % 50 == 0 ? 65'536 : random.between(1, 12'000));
    std::vector<AxisPulses> ticks;
    const std::int64_t n = random.between(1, tau > 20'000 ? 4 : log::kMaxBlockTicks);
    for (std::int64_t i = 0; i < n; ++i) ticks.push_back(random_pulses(random, tau));
    const Coded coded = encode(ticks, tau);
    auto out = batches(coded.counts);
    const auto decoded = log::decode_pulses(coded.code, coded.counts, out, 0);
    CAPTURE(run);
    REQUIRE_MESSAGE(decoded.has_value(), (decoded ? "" : decoded.error()));
    for (std::size_t i = 0; i < ticks.size(); ++i) REQUIRE(equal(out[i].axis[0], ticks[i]));
  }
}

TEST_CASE("bytes that are no pulse code are refused with a reason, or are the code of what they decode to") {
  Random random(test::from_environment("KADR_SEED", 2));
  const auto count = test::from_environment("KADR_COUNT", 20'000);
  std::uint64_t refused = 0;
  for (std::uint64_t run = 0; run < count; ++run) {
    Bytes code(static_cast<std::size_t>(random.between(0, 40)));
    for (std::uint8_t& byte : code)
      byte = static_cast<std::uint8_t>(random.between(0, 9) == 0 ? random.between(0, 255)
                                                                 : random.between(0, 30));
    const PulseCounts counts{static_cast<std::int32_t>(random.between(-1, 30)),
                             static_cast<std::int32_t>(random.between(-1, 5)),
                             static_cast<std::int32_t>(random.between(1, 64)), 1000};
    auto out = batches(counts);
    const auto decoded = log::decode_pulses(code, counts, out, 0);
    if (!decoded) {
      REQUIRE(!decoded.error().empty());
      ++refused;
      continue;
    }
    std::vector<AxisPulses> ticks;
    for (const StepBatch& b : out) ticks.push_back(b.axis[0]);
    const Coded again = encode(ticks, 1000);
    auto out2 = batches(counts);
    REQUIRE(log::decode_pulses(again.code, again.counts, out2, 0));
    for (std::size_t i = 0; i < ticks.size(); ++i) REQUIRE(equal(out2[i].axis[0], ticks[i]));
  }
  CHECK(refused > 0);
  if (count >= 500) CHECK(refused < count);  // few random bytes are a code
}
