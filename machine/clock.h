#pragma once
#include <cstdint>

#include "machine/base/count.h"

namespace kadr::machine {

struct ClockModel {
  std::int64_t base_hz = 10'000'000;  ///< a multiple of 1 MHz
  Ticks control_tick{10'000};         ///< tau in base ticks, <= 65536
  double tau_s() const { return static_cast<double>(control_tick.value) / static_cast<double>(base_hz); }
  bool operator==(const ClockModel&) const = default;
};

}  // namespace kadr::machine
