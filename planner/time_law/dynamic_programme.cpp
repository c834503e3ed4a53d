#include "planner/time_law/dynamic_programme.h"

#include <fmt/format.h>

#include "machine/base/require.h"

namespace kadr::planner {
namespace {

constexpr std::size_t kTold = 16;  ///< nodes from one call of progress to the next

}  // namespace

DynamicProgramme::DynamicProgramme(const LawProblem& problem, DpStepFunction function)
    : problem_(problem), rows_(accel_rows(problem)), step_(function) {}

void DynamicProgramme::NodeLevels::set(const LevelRange& r, std::size_t padded) {
  range = r;
  speed.assign(padded, 0.0);
  square.assign(padded, 0.0);
  for (std::int32_t j = 0; j < r.count; ++j) {
    const auto at = static_cast<std::size_t>(j);
    speed[at] = r.speed_u_s(j);
    square[at] = speed[at] * speed[at];
  }
}

LawResult DynamicProgramme::run(const std::vector<LevelRange>& levels) {
  const std::size_t n = problem_.nodes();
  std::int32_t most = 1;
  for (const LevelRange& r : levels) most = std::max(most, r.count);
  require(levels.size() == n && most <= 65'535, "a node has at most 65,535 levels");
  require(levels.front().count == 1 && levels.back().count == 1, "both ends have one level");
  // a vector of lanes may begin at any level
  stride_ = (static_cast<std::size_t>(most) + 2 * kDpLanes - 1) / kDpLanes * kDpLanes;
  cost_.resize(n * stride_);
  first_.resize(n * stride_);
  last_.resize(n * stride_);
  for (auto* scratch : {&least_square_, &most_square_}) scratch->assign(stride_, 0.0);
  for (auto* scratch : {&step_first_, &step_last_}) scratch->assign(stride_, 0);

  std::fill(cost_.begin(), cost_.begin() + static_cast<std::ptrdiff_t>(stride_), kDpInfeasible);
  cost_[0] = 0.0;
  here_.set(levels[0], stride_);
  here_.first = here_.last = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (progress_ && i % kTold == 0) progress_(static_cast<double>(i) / static_cast<double>(n));
    std::swap(before_, here_);
    here_.set(levels[i], stride_);
    if (!step(i))
      return tl::unexpected(LawFailure{
          i, problem_.s_u[i],
          fmt::format(
              "none of {} speeds from {:.6g} to {:.6g} mm/s can be reached within the acceleration limits",
              levels[i].count, levels[i].low_u_s, levels[i].high_u_s)});
  }
  return read_back(levels);
}

/// @return whether a level of node i can be reached
bool DynamicProgramme::step(std::size_t i) {
  const double ds = problem_.ds_u(i);
  double* cost = &cost_[i * stride_];
  DpStep d{};
  d.before_count = before_.range.count;
  d.before_speed = before_.speed.data();
  d.before_square = before_.square.data();
  d.before_cost = cost - stride_;
  d.before_first = before_.first;
  d.before_last = before_.last;
  d.before_lower = before_.range.lower;
  d.before_low = before_.range.low_u_s;
  d.before_kept = before_.range.kept_u_s;
  d.before_step_low = before_.range.step_low_u_s;
  d.before_step_high = before_.range.step_high_u_s;
  d.count = here_.range.count;
  d.speed = here_.speed.data();
  d.square = here_.square.data();
  d.rows = static_cast<std::int32_t>(rows_.per_interval);
  d.row_before = &rows_.before[i * rows_.per_interval];
  d.row_after = &rows_.after[i * rows_.per_interval];
  d.twice_ds = 2.0 * ds;
  d.square_weight = problem_.penalty_weight(i) / (4.0 * ds * ds);
  d.least_square = least_square_.data();
  d.most_square = most_square_.data();
  d.cost = cost;
  d.first = step_first_.data();
  d.last = step_last_.data();
  transitions_ += step_(d);

  here_.first = d.count;
  here_.last = -1;
  for (std::int32_t j = 0; j < d.count; ++j) {
    const std::size_t at = i * stride_ + static_cast<std::size_t>(j);
    first_[at] = static_cast<std::uint16_t>(std::min(d.first[j], 65'535));
    last_[at] = static_cast<std::uint16_t>(std::max(d.last[j], 0));
    if (!(cost[j] < kDpInfeasible)) continue;
    if (here_.first == d.count) here_.first = j;
    here_.last = j;
  }
  for (std::size_t j = static_cast<std::size_t>(d.count); j < stride_; ++j) cost[j] = kDpInfeasible;
  return here_.last >= 0;
}

/// From the last node back: finds the k that gave each cost again.
LawSolution DynamicProgramme::read_back(const std::vector<LevelRange>& levels) {
  const std::size_t n = problem_.nodes();
  std::vector<double> speed(n);
  level_.assign(n, 0);
  speed[n - 1] = levels[n - 1].speed_u_s(0);
  for (std::size_t i = n - 1; i > 0; --i) {
    const double ds = problem_.ds_u(i), weight = problem_.penalty_weight(i) / (4.0 * ds * ds);
    const std::size_t at = i * stride_ + static_cast<std::size_t>(level_[i]);
    const double vj = speed[i], xj = vj * vj;
    double best = kDpInfeasible;
    for (std::int32_t k = first_[at]; k <= last_[at]; ++k) {
      const double vk = levels[i - 1].speed_u_s(k), x = xj - vk * vk;
      const double c =
          cost_[(i - 1) * stride_ + static_cast<std::size_t>(k)] + 2.0 * ds / (vk + vj) + weight * x * x;
      if (!(c < best)) continue;
      best = c;
      level_[i - 1] = k;
      speed[i - 1] = vk;
    }
    require(best < kDpInfeasible, "a level that was reached has one before it");
  }
  LawSolution out = summed(problem_, std::move(speed));
  out.cost_s = cost_[(n - 1) * stride_];
  return out;
}

}  // namespace kadr::planner
