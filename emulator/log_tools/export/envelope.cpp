#include "emulator/log_tools/export/envelope.h"

#include <algorithm>
#include <cmath>

namespace kadr::log_tools {

Envelope::Envelope(double first_s, double piece_s, std::size_t most)
    : first_s_(first_s), piece_s_(piece_s), most_(most) {
  ranges_.reserve(most);
}

void Envelope::Range::take(const Range& other) {
  if (other.empty) return;
  low = empty ? other.low : std::min(low, other.low);
  high = empty ? other.high : std::max(high, other.high);
  empty = false;
}

void Envelope::add(double t_s, double value) {
  last_s_ = t_s;
  // half a piece's thousandth keeps a sample on a boundary in the piece that ends there
  auto at = std::max(0.0, std::ceil((t_s - first_s_) / piece_s_ - 1e-3) - 1);
  while (at >= static_cast<double>(most_)) {
    for (std::size_t i = 0; i < ranges_.size(); i += 2) {
      Range both = ranges_[i];
      if (i + 1 < ranges_.size()) both.take(ranges_[i + 1]);
      ranges_[i / 2] = both;
    }
    ranges_.resize((ranges_.size() + 1) / 2);
    piece_s_ *= 2;
    at = std::max(0.0, std::ceil((t_s - first_s_) / piece_s_ - 1e-3) - 1);
  }
  const auto index = static_cast<std::size_t>(at);
  if (index >= ranges_.size()) ranges_.resize(index + 1);
  if (std::isfinite(value)) ranges_[index].take({value, value, false});
}

std::vector<Envelope::Piece> Envelope::pieces() const {
  std::vector<Piece> out(ranges_.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {first_s_ + static_cast<double>(i) * piece_s_, first_s_ + static_cast<double>(i + 1) * piece_s_,
              ranges_[i].low, ranges_[i].high, ranges_[i].empty};
  if (!out.empty()) out.back().end_s = last_s_;
  return out;
}

}  // namespace kadr::log_tools
