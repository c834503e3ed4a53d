#pragma once
#include <optional>
#include <tuple>

#include "emulator/log/log_messages.h"

namespace kadr::log_tools {

namespace detail {
template <class List>
struct OptionalsOf;
template <class... R>
struct OptionalsOf<log::Records<R...>> {
  using Type = std::tuple<std::optional<R>...>;
};
}  // namespace detail
/// A message of each channel of exact data, as far as it was read.
using TickMessages = detail::OptionalsOf<log::TickChannels>::Type;

/// A block of control ticks with all their exact data: that of KADR_TICKS, and what other channels have of
/// the same control ticks.
struct ExactTicks : log::TickBlock {
  TickMessages others;  ///< except KADR_TICKS

  /// Null: the log does not have that channel.
  template <class R>
  const R* of() const {
    if constexpr (std::same_as<R, log::TickBlock>)
      return this;
    else
      return std::get<std::optional<R>>(others) ? &*std::get<std::optional<R>>(others) : nullptr;
  }
};

}  // namespace kadr::log_tools
