#pragma once
#include <optional>
#include <tuple>

#include "emulator/log/log_messages.h"

namespace kadr::emulator {

namespace detail {
template <class List>
struct OptionalsOf;
template <class... R>
struct OptionalsOf<Records<R...>> {
  using Type = std::tuple<std::optional<R>...>;
};
}  // namespace detail
/// A message of each channel of exact data, as far as it was read.
using TickMessages = detail::OptionalsOf<TickChannels>::Type;

/// A block of control ticks with all their exact data: that of KADR_TICKS, and what other channels have of
/// the same control ticks.
struct ExactTicks : TickBlock {
  TickMessages others;  ///< except KADR_TICKS

  /// Null: the log does not have that channel.
  template <class R>
  const R* of() const {
    if constexpr (std::same_as<R, TickBlock>)
      return this;
    else
      return std::get<std::optional<R>>(others) ? &*std::get<std::optional<R>>(others) : nullptr;
  }
};

}  // namespace kadr::emulator
