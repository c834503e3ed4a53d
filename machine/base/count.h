#pragma once
#include <compare>
#include <cstdint>

namespace kadr {

/// An integer count that refuses to mix with other counts: Ticks + Steps does not compile.
template <class Tag>
struct Count {
  std::int64_t value = 0;
  constexpr auto operator<=>(const Count&) const = default;
  friend constexpr Count operator+(Count a, Count b) { return {a.value + b.value}; }
  friend constexpr Count operator-(Count a, Count b) { return {a.value - b.value}; }
  constexpr Count& operator+=(Count b) {
    value += b.value;
    return *this;
  }
  constexpr Count& operator-=(Count b) {
    value -= b.value;
    return *this;
  }
  constexpr Count& operator++() {
    ++value;
    return *this;
  }
};

/// How many there are, whatever the sign.
template <class Tag>
constexpr std::int64_t magnitude(Count<Tag> count) {
  return count.value < 0 ? -count.value : count.value;
}

using Ticks = Count<struct TicksTag>;                ///< base-clock ticks since program start
using ControlTicks = Count<struct ControlTicksTag>;  ///< control ticks (tau) since program start
using Steps = Count<struct StepsTag>;                ///< motor steps, signed

}  // namespace kadr
