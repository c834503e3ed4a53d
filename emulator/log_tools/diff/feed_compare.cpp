#include "emulator/log_tools/diff/feed_compare.h"

#include <algorithm>
#include <cmath>

namespace kadr::log_tools {
namespace {

/// The point of a log at path length s_u, between two of its control ticks.
FeedPoint between(const FeedPoint& before, const FeedPoint& after, double s_u) {
  FeedPoint point = after;
  point.path_u = s_u;
  const double span_u = after.path_u - before.path_u;
  if (!(span_u > 0)) return point;
  const double share = (s_u - before.path_u) / span_u;
  const double v0 = before.feed_u_s, v1 = after.feed_u_s;
  point.feed_u_s = std::sqrt(std::max(0.0, v0 * v0 + (v1 * v1 - v0 * v0) * share));
  return point;
}

double slack_u_s(const FeedPoint& before, const FeedPoint& after) {
  return std::fabs(after.accel_u_s2 - before.accel_u_s2) * after.tau_s / 4;
}

}  // namespace

void FeedCompare::add(int side, const FeedPoint& point) {
  auto& waiting = waiting_[side];
  const FeedPoint& newest = waiting.empty() ? last_[side] : waiting.back();
  // at rest the path has been compared already
  if (!(point.path_u > newest.path_u)) return;
  waiting.push_back(point);
  match();
}

/// Compares at every position that both logs have passed.
void FeedCompare::match() {
  auto &of_a = waiting_[0], &of_b = waiting_[1];
  while (!of_a.empty() && !of_b.empty()) {
    const FeedPoint a = of_a.front(), b = of_b.front();
    if (a.path_u == b.path_u) {
      compare(a, b, 0);
    } else if (a.path_u < b.path_u) {
      compare(a, between(last_[1], b, a.path_u), slack_u_s(last_[1], b));
    } else {
      compare(between(last_[0], a, b.path_u), b, slack_u_s(last_[0], a));
    }
    const bool a_passed = a.path_u <= b.path_u, b_passed = b.path_u <= a.path_u;
    if (!a_passed && !b_passed) {  // not a number: a damaged log
      of_a.pop_front();
      of_b.pop_front();
    }
    if (a_passed) {
      last_[0] = a;
      of_a.pop_front();
    }
    if (b_passed) {
      last_[1] = b;
      of_b.pop_front();
    }
  }
}

void FeedCompare::compare(const FeedPoint& a, const FeedPoint& b, double slack) {
  const double size_u_s = std::fabs(b.feed_u_s - a.feed_u_s);
  // a stretch continues until the feeds are clearly together again: no series of short ones near the tolerance
  const double allowed_u_s = tolerance_u_s_ + slack;
  if (size_u_s <= (span_ ? allowed_u_s / 2 : allowed_u_s)) return end_span();
  if (!span_) span_ = FeedSpan{a.path_u, a.path_u, a, b, 0, 0};
  span_->to_u = a.path_u;
  if (size_u_s > span_->largest_u_s) {
    span_->largest_u_s = size_u_s;
    span_->largest_at_u = a.path_u;
  }
}

void FeedCompare::end_span() {
  if (!span_) return;
  ++spans_;
  length_u_ += span_->to_u - span_->from_u;
  if (!largest_ || span_->largest_u_s > largest_->largest_u_s) largest_ = span_;
  found_.push_back(std::move(*span_));
  span_.reset();
}

void FeedCompare::finish() { end_span(); }

std::vector<FeedSpan> FeedCompare::take() {
  std::vector<FeedSpan> list;
  list.swap(found_);
  return list;
}

}  // namespace kadr::log_tools
