#include "gcode/flow/sequence_numbers.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadr::gcode {
namespace {

bool before(const NumberedLine& a, const NumberedLine& b) {
  return std::pair(a.program, a.number) < std::pair(b.program, b.number);
}

}  // namespace

std::optional<std::int32_t> sequence_number(const Line& line) {
  constexpr double kLargest = 99'999'999;
  for (const Item& item : line.items) {
    if (item.kind == ItemKind::block_delete || item.kind == ItemKind::byte_order_mark ||
        item.kind == ItemKind::comment)
      continue;
    const bool whole = item.kind == ItemKind::word && item.letter == 'N' && item.value < 0 &&
                       item.number == std::floor(item.number) && item.number >= 0 && item.number <= kLargest;
    return whole ? std::optional(static_cast<std::int32_t>(item.number)) : std::nullopt;
  }
  return std::nullopt;
}

void SequenceNumbers::add(std::int32_t number, Program::Position at, int loop) {
  lines_.push_back({static_cast<std::uint32_t>(programs_.size()), number, at, loop});
}

void SequenceNumbers::finish() { std::stable_sort(lines_.begin(), lines_.end(), before); }

const NumberedLine* SequenceNumbers::find(std::int32_t number, std::uint32_t line) const {
  const auto next = std::upper_bound(programs_.begin(), programs_.end(), line);
  const NumberedLine wanted{static_cast<std::uint32_t>(next - programs_.begin()), number, {}, -1};
  const auto it = std::lower_bound(lines_.begin(), lines_.end(), wanted, before);
  return it != lines_.end() && !before(wanted, *it) ? &*it : nullptr;
}

const NumberedLine* SequenceNumbers::again(const NumberedLine& first) const {
  const NumberedLine* next = &first + 1;
  return next != lines_.data() + lines_.size() && !before(first, *next) ? next : nullptr;
}

}  // namespace kadr::gcode
