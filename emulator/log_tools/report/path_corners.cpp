#include "emulator/log_tools/report/path_corners.h"

#include <algorithm>
#include <limits>

#include "machine/base/require.h"

namespace kadr::log_tools {

CornerFinder::CornerFinder(std::vector<double> step_mm, double tolerance_mm, std::size_t most)
    : step_mm_(std::move(step_mm)), tolerance_mm_(tolerance_mm), most_(most) {
  require(most > 1 && tolerance_mm > 0, "a path has two corners or more and a tolerance");
  kept_.nodes.resize(step_mm_.size());
}

/// Squared distance of a node from the line between two others, ends included.
double CornerFinder::off_mm2(const Sample& from, const Sample& to, const Sample& node) const {
  double along = 0, line = 0, way = 0;
  for (std::size_t a = 0; a < step_mm_.size(); ++a) {
    const double l = step_mm_[a] * (double(to.at[a]) - from.at[a]);
    const double w = step_mm_[a] * (double(node.at[a]) - from.at[a]);
    along += l * w;
    line += l * l;
    way += w * w;
  }
  if (along <= 0 || line <= 0) return way;
  if (along < line) return std::max(0.0, way - along * along / line);
  return way - 2 * along + line;
}

void CornerFinder::keep(const Sample& node) {
  kept_.ticks.push_back(node.tick);
  for (std::size_t a = 0; a < step_mm_.size(); ++a) kept_.nodes[a].push_back(node.at[a]);
  last_ = node;
}

void CornerFinder::add(std::int32_t tick, const std::vector<std::int32_t>& nodes) {
  Sample node{tick, nodes};
  if (kept_.ticks.empty()) return keep(node);
  // standing still: one node that lasts
  if (waiting_.size() == 1 && waiting_[0].at == node.at && last_.at == node.at) {
    waiting_[0].tick = tick;
    return;
  }
  const double most_mm2 = tolerance_mm_ * tolerance_mm_;
  const bool straight = waiting_.size() < kLongest &&
                        std::all_of(waiting_.begin(), waiting_.end(), [&](const Sample& on_the_way) {
                          return off_mm2(last_, node, on_the_way) <= most_mm2;
                        });
  if (!straight) {
    keep(waiting_.back());
    waiting_.clear();
  }
  waiting_.push_back(std::move(node));
  if (kept_.size() < most_) return;
  kept_ = thinned(std::move(kept_), step_mm_, tolerance_mm_, most_ / 2);
}

PathCorners CornerFinder::corners() const {
  PathCorners out = kept_;
  if (!waiting_.empty()) {
    out.ticks.push_back(waiting_.back().tick);
    for (std::size_t a = 0; a < step_mm_.size(); ++a) out.nodes[a].push_back(waiting_.back().at[a]);
  }
  return out;
}

PathCorners thinned(PathCorners corners, const std::vector<double>& step_mm, double& tolerance_mm,
                    std::size_t most) {
  most = std::max<std::size_t>(most, 2);
  for (bool again = false; corners.size() > most; again = true) {
    if (again) tolerance_mm *= 2;
    CornerFinder finder(step_mm, tolerance_mm, std::numeric_limits<std::size_t>::max());
    std::vector<std::int32_t> nodes(step_mm.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = corners.nodes[a][i];
      finder.add(corners.ticks[i], nodes);
    }
    corners = finder.corners();
  }
  return corners;
}

}  // namespace kadr::log_tools
