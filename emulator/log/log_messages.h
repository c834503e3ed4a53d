#pragma once
#include <type_traits>
#include <variant>

#include "emulator/log/channels/axis.h"
#include "emulator/log/channels/block.h"
#include "emulator/log/channels/block_end.h"
#include "emulator/log/channels/diag.h"
#include "emulator/log/channels/event.h"
#include "emulator/log/channels/feed.h"
#include "emulator/log/channels/run.h"
#include "emulator/log/channels/steps.h"
#include "emulator/log/channels/summary.h"
#include "emulator/log/channels/ticks.h"

/// The channels of a log.
namespace kadr::log {

template <class... R>
struct Records {};

/// Every channel, in the order of kadr.lcm. A channel with append_tick() holds exact data, a value a control
/// tick; KADR_TICKS is the last of those: a reader that has it has all of them.
using Channels = Records<LogHeader, BlockRecord, BlockEndRecord, TickBlock, PulseBlock, FeedSample,
                         AxisSample, EventRecord, LogDiagnostic, LogSummary>;

/// A channel that this version does not know; its bytes are in LogReader::event().
struct UnknownMessage {};

namespace detail {

template <class R>
concept TickChannel = requires(R& block, const TickSource& tick) {
  append_tick(block, tick);
};

/// What a reader is given of a channel: its record; pulses decoded.
template <class R>
struct MessageOf {
  using Type = R;
};
template <>
struct MessageOf<PulseBlock> {
  using Type = StepBlock;
};
template <class List>
struct MessagesOf;
template <class... R>
struct MessagesOf<Records<R...>> {
  using Type = std::variant<typename MessageOf<R>::Type..., UnknownMessage>;
};

template <class Left, class Found = Records<>>
struct TickChannelsOf {
  using Type = Found;
};
template <class R, class... Left, class... Found>
struct TickChannelsOf<Records<R, Left...>, Records<Found...>> {
  using More = std::conditional_t<TickChannel<R>, Records<Found..., R>, Records<Found...>>;
  using Type = TickChannelsOf<Records<Left...>, More>::Type;
};

template <class List>
inline constexpr bool kEndsWithTicks = false;
template <class R, class... Left>
inline constexpr bool kEndsWithTicks<Records<R, Left...>> = kEndsWithTicks<Records<Left...>>;
template <>
inline constexpr bool kEndsWithTicks<Records<TickBlock>> = true;

}  // namespace detail

using LogMessage = detail::MessagesOf<Channels>::Type;
using TickChannels = detail::TickChannelsOf<Channels>::Type;
static_assert(detail::kEndsWithTicks<TickChannels>, "a channel of exact data stands before KADR_TICKS");

/// Calls f.template operator()<R>() for each record R of a list, in its order.
template <class... R, class F>
void for_each_channel(Records<R...>, F&& f) {
  (f.template operator()<R>(), ...);
}

}  // namespace kadr::log
