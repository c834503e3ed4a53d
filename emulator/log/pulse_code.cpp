#include "emulator/log/pulse_code.h"

#include <optional>

#include "machine/base/require.h"

namespace kadr::log {
namespace {

constexpr std::size_t kMaxVarintBytes = 5;  // 32 bits, 7 in a byte

tl::unexpected<std::string> broken(const char* why) { return tl::unexpected<std::string>(why); }

std::uint8_t* put_varint(std::uint8_t* out, std::uint32_t value) {
  while (value >= 0x80) {
    *out++ = static_cast<std::uint8_t>(value | 0x80);
    value >>= 7;
  }
  *out++ = static_cast<std::uint8_t>(value);
  return out;
}

std::uint32_t zigzag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ (value < 0 ? ~0u : 0u);
}

std::int32_t unzigzag(std::uint32_t value) {
  return static_cast<std::int32_t>((value >> 1) ^ (~(value & 1) + 1));
}

/// Reads varints of at most 32 bits; a cut or overlong one gives nothing.
class VarintReader {
 public:
  explicit VarintReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ == bytes_.size(); }
  std::optional<std::uint32_t> next() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 7 * kMaxVarintBytes && at_ < bytes_.size(); shift += 7) {
      const std::uint8_t byte = bytes_[at_++];
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) {
        if (value > 0xffffffffu) return std::nullopt;
        return static_cast<std::uint32_t>(value);
      }
    }
    return std::nullopt;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Puts offsets into the batch of their control tick.
tl::expected<void, std::string> decode_times(VarintReader& in, const PulseCounts& counts,
                                             std::span<StepBatch> batches, std::size_t axis) {
  const std::int64_t block_ticks = std::int64_t{counts.ticks} * counts.control_tick_ticks;
  std::int64_t time = 0, interval = 0, begin = 0;
  std::size_t tick = 0;
  for (std::int32_t i = 0; i < counts.pulses; ++i) {
    const auto coded = in.next();
    if (!coded) return broken("a pulse is cut off");
    interval += unzigzag(*coded);
    time += interval;
    if (interval < 0) return broken("pulse times run back");
    if (time >= block_ticks) return broken("a pulse lies beyond its block of control ticks");
    while (time >= begin + counts.control_tick_ticks) {
      begin += counts.control_tick_ticks;
      ++tick;
    }
    batches[tick].axis[axis].offset_ticks.push_back(static_cast<std::uint16_t>(time - begin));
  }
  return {};
}

/// Reads the next reversal's pulse index, `pulses` when there is none left.
tl::expected<std::int64_t, std::string> next_reversal(VarintReader& in, std::int32_t& left, std::int64_t last,
                                                      bool first, std::int64_t pulses) {
  if (left == 0) return pulses;
  --left;
  const auto gap = in.next();
  if (!gap) return broken("a reversal is cut off");
  if (*gap == 0 && !first) return broken("two reversals at one pulse");
  const std::int64_t at = last + *gap;
  if (at >= pulses) return broken("a reversal beyond the last pulse");
  return at;
}

tl::expected<void, std::string> decode_signs(VarintReader& in, const PulseCounts& counts,
                                             std::span<StepBatch> batches, std::size_t axis) {
  std::int32_t left = counts.reversals;
  std::int64_t done = 0;
  std::int8_t sign = 1;
  auto at = next_reversal(in, left, 0, true, counts.pulses);
  for (StepBatch& batch : batches) {
    AxisPulses& pulses = batch.axis[axis];
    const auto count = static_cast<std::int64_t>(pulses.count());
    if (count == 0) continue;
    // a flip at the tick's first pulse is its first sign, not a reversal within the tick
    if (at && *at == done) {
      sign = static_cast<std::int8_t>(-sign);
      at = next_reversal(in, left, done, false, counts.pulses);
    }
    pulses.first_sign = sign;
    while (at && *at < done + count) {
      pulses.reversals.push_back(static_cast<std::uint16_t>(*at - done));
      sign = static_cast<std::int8_t>(-sign);
      at = next_reversal(in, left, *at, false, counts.pulses);
    }
    if (!at) return tl::unexpected(at.error());
    done += count;
  }
  return {};
}

}  // namespace

void PulseEncoder::begin_block() {
  size_ = 0;
  reversal_at_.clear();
  pulses_ = 0;
  time_ticks_ = 0;
  interval_ticks_ = 0;
  sign_ = 1;
}

void PulseEncoder::add(const AxisPulses& pulses, std::int32_t begin_ticks) {
  const std::size_t count = pulses.count();
  if (count == 0) return;
  const std::size_t need = size_ + kMaxVarintBytes * count;
  if (code_.size() < need) code_.resize(2 * need);

  // nearly every second difference fits one byte: store it first, ask afterwards
  std::uint8_t* out = code_.data() + size_;
  std::int32_t time = time_ticks_, interval = interval_ticks_;
  for (const std::uint16_t offset : pulses.offset_ticks) {
    const std::int32_t now = begin_ticks + offset;
    const std::int32_t step = now - time;
    const std::uint32_t coded = zigzag(step - interval);
    time = now;
    interval = step;
    *out = static_cast<std::uint8_t>(coded);
    if (coded < 0x80) [[likely]]
      ++out;
    else
      out = put_varint(out, coded);
  }
  size_ = static_cast<std::size_t>(out - code_.data());
  time_ticks_ = time;
  interval_ticks_ = interval;

  note_reversals(pulses);
  pulses_ += static_cast<std::int32_t>(count);
}

void PulseEncoder::note_reversals(const AxisPulses& pulses) {
  if (pulses.first_sign == sign_ && pulses.reversals.empty()) return;
  std::int32_t index = pulses_;
  pulses.for_each([&](std::uint16_t, int sign) {
    if (sign != sign_) reversal_at_.push_back(index);
    sign_ = sign;
    ++index;
  });
}

std::int32_t PulseEncoder::finish_block(std::vector<std::uint8_t>& code) const {
  const std::size_t begin = code.size();
  code.insert(code.end(), code_.begin(), code_.begin() + static_cast<std::ptrdiff_t>(size_));
  std::int32_t last = 0;
  for (const std::int32_t at : reversal_at_) {
    std::uint8_t bytes[kMaxVarintBytes];
    std::uint8_t* const end = put_varint(bytes, static_cast<std::uint32_t>(at - last));
    code.insert(code.end(), bytes, end);
    last = at;
  }
  return static_cast<std::int32_t>(code.size() - begin);
}

tl::expected<void, std::string> decode_pulses(std::span<const std::uint8_t> code, const PulseCounts& counts,
                                              std::span<StepBatch> batches, std::size_t axis) {
  require(counts.ticks > 0 && batches.size() == static_cast<std::size_t>(counts.ticks),
          "one batch for each control tick of the block");
  for (StepBatch& batch : batches) batch.axis.at(axis).clear();
  if (counts.pulses < 0 || counts.reversals < 0 || counts.reversals > counts.pulses)
    return broken("impossible pulse counts");
  VarintReader in(code);
  if (auto times = decode_times(in, counts, batches, axis); !times) return times;
  if (auto signs = decode_signs(in, counts, batches, axis); !signs) return signs;
  if (!in.at_end()) return broken("bytes left over after the last pulse");
  return {};
}

}  // namespace kadr::log
