#pragma once
#include <cstdint>
#include <memory>

#include "machine/step_batch.h"

namespace kadr {

/// Running hash over the step stream: per tick and axis the offsets and signs (integers only). Ticks without
/// pulses add nothing, every other tick adds its number, so equal digests mean equal pulses at equal times.
class StepHash {
 public:
  StepHash();
  ~StepHash();
  void add(const StepBatch& batch);
  std::uint64_t digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kadr
