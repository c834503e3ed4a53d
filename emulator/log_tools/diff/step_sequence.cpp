#include "emulator/log_tools/diff/step_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "machine/base/parse_number.h"

namespace kadr::log_tools {
namespace {

/// A block's stamp and a pulse's are both rounded down: they may be one base tick apart at the same position.
constexpr std::int64_t kStampSlack_ticks = 1;

bool all_at_most(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& base_a,
                 const std::vector<std::int64_t>& b, const std::vector<std::int64_t>& base_b) {
  for (std::size_t n = 0; n < a.size(); ++n)
    if (std::max<std::int64_t>(a[n] - base_a[n], 0) > std::max<std::int64_t>(b[n] - base_b[n], 0))
      return false;
  return true;
}

std::string geometry_difference(const log::BlockRecord& a, const log::BlockRecord& b) {
  if (a.block != b.block) return fmt::format("running numbers {} | {}", a.block, b.block);
  if (a.motion != b.motion) return fmt::format("{} | {}", a.motion, b.motion);
  if (a.length_u != b.length_u)
    return fmt::format("length {} | {}", number_text(a.length_u), number_text(b.length_u));
  return "";
}

}  // namespace

StepSequence::StepSequence(const std::vector<AxisPair>& axes, std::int64_t control_tick_ticks_a,
                           std::int64_t control_tick_ticks_b)
    : axes_(axes) {
  side_[0].control_tick_ticks = control_tick_ticks_a;
  side_[1].control_tick_ticks = control_tick_ticks_b;
  for (Side& side : side_) {
    side.total.resize(axes.size());
    side.base.resize(axes.size());
    side.matched.resize(axes.size());
    side.signs.resize(axes.size());
  }
}

void StepSequence::add(int number, const LogFrame& frame) {
  if (given_up_) return;
  Side& side = side_[static_cast<std::size_t>(number)];
  add_marks(side, frame);
  add_pulses(side, number, frame);
  settle_marks(side, Ticks{(frame.control_tick + 1) * side.control_tick_ticks});
  match();
  while (end_block()) match();
  for (const Side& s : side_) {
    std::size_t ahead = s.groups.size();
    for (const auto& signs : s.signs) ahead = std::max(ahead, signs.size());
    given_up_ = given_up_ || ahead > kMostAhead || s.marks.size() > kMostAhead;
  }
}

void StepSequence::add_marks(Side& side, const LogFrame& frame) {
  for (const LogItem& item : frame.items)
    if (const auto* block = std::get_if<log::BlockRecord>(&item))
      side.marks.push_back({*block, sane_tick(block->tick), {}, {}});
}

void StepSequence::add_pulses(Side& side, int number, const LogFrame& frame) {
  const StepBatch* batch = frame.batch();
  if (batch == nullptr) return;
  struct Pulse {
    std::int64_t stamp;
    std::size_t axis;
  };
  std::vector<Pulse> pulses;
  const std::int64_t begin = frame.control_tick * side.control_tick_ticks;
  for (std::size_t n = 0; n < axes_.size(); ++n) {
    const std::size_t axis = number == 0 ? axes_[n].a : axes_[n].b;
    batch->axis[axis].for_each([&](std::uint16_t offset, int sign) {
      pulses.push_back({begin + offset, n});
      side.signs[n].push_back(static_cast<std::int8_t>(sign));
    });
  }
  std::stable_sort(pulses.begin(), pulses.end(),
                   [](const Pulse& p, const Pulse& q) { return p.stamp < q.stamp; });
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    // a block with the same stamp counts before this pulse
    settle_marks(side, Ticks{pulses[i].stamp});
    ++side.total[pulses[i].axis];
    if (i + 1 < pulses.size() && pulses[i + 1].stamp == pulses[i].stamp) continue;
    side.groups.push_back({Ticks{pulses[i].stamp}, side.total});
  }
}

/// Every pulse before base tick `until` has been counted: updates the bounds of the blocks' beginnings.
void StepSequence::settle_marks(Side& side, Ticks until) {
  // marks ascend: each is touched twice, however many there are at one stamp
  const auto at = [&](std::size_t n) { return side.marks[n].stamp.value; };
  for (; side.reached < side.marks.size() && until.value >= at(side.reached) - kStampSlack_ticks;
       ++side.reached)
    side.marks[side.reached].low = side.total;
  for (; side.known < side.reached && until.value > at(side.known) + kStampSlack_ticks; ++side.known)
    side.marks[side.known].high = side.total;
}

void StepSequence::match() {
  match_signs();
  if (!order_parted_) match_order();
}

void StepSequence::match_order() {
  auto &a = side_[0], &b = side_[1];
  // pulses at and after the next block's beginning wait until both logs have it
  const auto waits = [](const Side& side) {
    return side.groups.empty() ||
           (!side.marks.empty() &&
            side.groups.front().stamp.value >= side.marks.front().stamp.value - kStampSlack_ticks);
  };
  while (!waits(a) && !waits(b)) {
    const Counts &u = a.groups.front().after, &v = b.groups.front().after;
    const bool u_first = all_at_most(u, a.base, v, b.base), v_first = all_at_most(v, b.base, u, a.base);
    if (u_first || v_first) {
      // both stay valid until both have been compared
      if (u_first) a.groups.pop_front();
      if (v_first) b.groups.pop_front();
      continue;
    }
    order_parted_ = true;
    if (under_way_.order.empty()) under_way_.order = order_text(u, v);
    return;
  }
}

/// Where the order parts: A is ahead with one axis, B with another one.
std::string StepSequence::order_text(const Counts& u, const Counts& v) const {
  const Counts &base_a = side_[0].base, &base_b = side_[1].base;
  std::size_t more_a = 0, more_b = 0;
  for (std::size_t n = 0; n < axes_.size(); ++n) {
    if (u[n] - base_a[n] > v[n] - base_b[n]) more_a = n;
    if (u[n] - base_a[n] < v[n] - base_b[n]) more_b = n;
  }
  return fmt::format("pulse {} of {} and pulse {} of {} come in the other order: {} first | {} first",
                     v[more_a] - base_b[more_a] + 1, axes_[more_a].name, u[more_b] - base_a[more_b] + 1,
                     axes_[more_b].name, axes_[more_a].name, axes_[more_b].name);
}

void StepSequence::match_signs() {
  auto &a = side_[0], &b = side_[1];
  const auto limit = [](const Side& side, std::size_t axis) {
    return side.marks.empty() || side.marks.front().low.empty()
               ? std::numeric_limits<std::int64_t>::max()
               : side.marks.front().low[axis] - side.base[axis];
  };
  for (std::size_t n = 0; n < axes_.size(); ++n) {
    const std::int64_t most = std::min(limit(a, n), limit(b, n));
    while (!a.signs[n].empty() && !b.signs[n].empty() && a.matched[n] < most && b.matched[n] < most) {
      ++a.matched[n];
      ++b.matched[n];
      const int p = a.signs[n].front(), q = b.signs[n].front();
      a.signs[n].pop_front();
      b.signs[n].pop_front();
      if (p == q || !under_way_.order.empty()) continue;
      under_way_.order = fmt::format("pulse {} of {} has the other direction: {:+d} | {:+d}", a.matched[n],
                                     axes_[n].name, p, q);
    }
  }
}

/// Goes on to the next block if both logs have its beginning.
bool StepSequence::end_block() {
  auto &a = side_[0], &b = side_[1];
  if (a.marks.empty() || b.marks.empty()) return false;
  const Mark &x = a.marks.front(), &y = b.marks.front();
  if (a.known == 0 || b.known == 0) return false;
  close_block(&x.low, &x.high, &y.low, &y.high);
  begin_block();
  return true;
}

/// Counts the block under way: its pulses lie between what is surely before its end and what surely is not
/// behind it; the logs agree if both ranges have a count in common.
void StepSequence::close_block(const Counts* low_a, const Counts* high_a, const Counts* low_b,
                               const Counts* high_b) {
  auto &a = side_[0], &b = side_[1];
  Counts end_a = *low_a, end_b = *low_b;
  for (std::size_t n = 0; n < axes_.size(); ++n) {
    const std::int64_t low = std::max((*low_a)[n] - a.base[n], (*low_b)[n] - b.base[n]);
    const std::int64_t high = std::min((*high_a)[n] - a.base[n], (*high_b)[n] - b.base[n]);
    if (low <= high) {
      end_a[n] = a.base[n] + low;
      end_b[n] = b.base[n] + low;
    } else {
      under_way_.counts.push_back({axes_[n].name, (*low_a)[n] - a.base[n], (*low_b)[n] - b.base[n]});
    }
  }
  const bool counts_agree = under_way_.counts.empty();
  if (a.begun) {
    ++blocks_;
    under_way_.a = a.block;
    under_way_.b = b.block;
    under_way_.geometry = geometry_difference(a.block, b.block);
    if (!counts_agree || !under_way_.order.empty() || !under_way_.geometry.empty()) {
      ++differing_;
      found_.push_back(std::move(under_way_));
    }
  }
  under_way_ = {};
  for (Side* side : {&a, &b}) {
    const Counts& end = side == &a ? end_a : end_b;
    // where the blocks part, what is left of each is dropped, so that the next ones are compared by themselves
    if ((!counts_agree || order_parted_) && !side->marks.empty()) {
      const std::int64_t stamp = side->marks.front().stamp.value - kStampSlack_ticks;
      while (!side->groups.empty() && side->groups.front().stamp.value < stamp) side->groups.pop_front();
    }
    for (std::size_t n = 0; n < axes_.size(); ++n) {
      side->matched[n] -= end[n] - side->base[n];
      for (; !counts_agree && side->matched[n] < 0 && !side->signs[n].empty(); ++side->matched[n])
        side->signs[n].pop_front();
      if (!counts_agree) side->matched[n] = 0;
    }
    side->base = end;
  }
  order_parted_ = false;
}

void StepSequence::begin_block() {
  for (Side& side : side_) {
    side.block = std::move(side.marks.front().block);
    side.begun = true;
    side.marks.pop_front();
    --side.reached;
    --side.known;
  }
}

void StepSequence::finish(bool whole) {
  if (given_up_) return;
  for (Side& side : side_) settle_marks(side, Ticks{std::numeric_limits<std::int64_t>::max()});
  match();
  while (end_block()) match();
  auto &a = side_[0], &b = side_[1];
  if (!a.begun || !b.begun) return;
  const bool blocks_left = !a.marks.empty() || !b.marks.empty();
  if (whole && !blocks_left) close_block(&a.total, &a.total, &b.total, &b.total);
}

std::vector<BlockDifference> StepSequence::take() {
  std::vector<BlockDifference> list;
  list.swap(found_);
  return list;
}

}  // namespace kadr::log_tools
