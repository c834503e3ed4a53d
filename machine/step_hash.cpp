#include "machine/step_hash.h"

#include <bit>
#include <span>
#include <vector>

#include "machine/base/hash.h"

namespace kadr {

/// Canonical form, little-endian: for each control tick with pulses its number and count of axes that pulse;
/// for each of these: axis, direction of the first pulse, counts of pulses and reversals, then the offsets
/// and the reversals.
struct StepHash::Impl {
  Hash64 hash;
  std::vector<std::uint16_t> swapped;

  void words(std::span<const std::uint16_t> values) {
    if constexpr (std::endian::native == std::endian::little) {
      hash.bytes(values.data(), values.size_bytes());
    } else {
      swapped.clear();
      for (const std::uint16_t v : values) swapped.push_back(static_cast<std::uint16_t>(v << 8 | v >> 8));
      hash.bytes(swapped.data(), 2 * swapped.size());
    }
  }
};

StepHash::StepHash() : impl_(std::make_unique<Impl>()) {}
StepHash::~StepHash() = default;

void StepHash::add(const StepBatch& batch) {
  std::int64_t stepping = 0;
  for (const AxisPulses& pulses : batch.axis) stepping += pulses.count() > 0 ? 1 : 0;
  if (stepping == 0) return;
  impl_->hash.integer(batch.tick.value);
  impl_->hash.integer(stepping);
  for (std::size_t axis = 0; axis < batch.axis.size(); ++axis) {
    const AxisPulses& pulses = batch.axis[axis];
    if (pulses.count() == 0) continue;
    // one word: reversals (32 bits), count (24), direction (1), axis (7); counts stay far below
    const std::uint64_t head = static_cast<std::uint64_t>(pulses.reversals.size()) << 32 |
                               static_cast<std::uint64_t>(pulses.count()) << 8 |
                               (pulses.first_sign > 0 ? 0x80u : 0u) | static_cast<std::uint64_t>(axis);
    impl_->hash.integer(static_cast<std::int64_t>(head));
    impl_->words(pulses.offset_ticks);
    impl_->words(pulses.reversals);
  }
}

std::uint64_t StepHash::digest() const { return impl_->hash.digest(); }

}  // namespace kadr
