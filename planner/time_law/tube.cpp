#include "planner/time_law/tube.h"

#include <fmt/format.h>

namespace kadr::planner {
namespace {

std::vector<LevelRange> full_levels(const LawProblem& p, const std::vector<NodeCap>& caps,
                                    std::int32_t count) {
  std::vector<LevelRange> levels(p.nodes());
  for (std::size_t i = 0; i < p.nodes(); ++i) levels[i] = LevelRange::uniform(count, 0.0, caps[i].speed_u_s);
  levels.front() = LevelRange::single(p.begin_u_s);
  levels.back() = LevelRange::single(p.end_u_s);
  return levels;
}

}  // namespace

LawResult ClassicalDp::solve(const LawProblem& problem) {
  DynamicProgramme programme(problem);
  if (progress_) programme.on_progress([this](double done) { progress_("levels", done); });
  LawResult out = programme.run(full_levels(problem, node_caps(problem), levels_));
  if (out) out->iterations = 1;
  return out;
}

TubeControl::TubeControl(const TubeOptions& options, const LawSolution& first, double half_width_u_s)
    : options_(options), half_width_u_s_(half_width_u_s) {
  passes_.push_back({1, first.time_s, first.cost_s});
}

const TubePass& TubeControl::pass(double time_s, double cost_s, bool touched) {
  const TubePass before = passes_.back();
  TubePass now{before.number + 1, time_s, cost_s, half_width_u_s_, touched};
  if (!touched) half_width_u_s_ *= 0.5;
  if (!touched && before.number > 1 && !before.touched) {
    now.compared = true;
    now.fall_percent = 100.0 * (1.0 - time_s / before.time_s);
    ended_ = now.fall_percent < options_.stop_percent;
  }
  ended_ = ended_ || half_width_u_s_ < options_.least_half_width_u_s;
  capped_ = !ended_ && now.number >= options_.most_passes;
  ended_ = ended_ || capped_;
  passes_.push_back(now);
  return passes_.back();
}

LawResult TubeDp::solve(const LawProblem& problem) {
  DynamicProgramme programme(problem);
  tell_pass(programme, 1);
  LawResult first = programme.run(full_levels(problem, node_caps(problem), options_.levels));
  passes_.clear();
  profiles_.clear();
  if (!first) return first;
  double fastest = 0;
  for (const double v : first->speed_u_s) fastest = std::max(fastest, v);
  TubeControl control(options_, *first, options_.relative_half_width * fastest);
  return loop(programme, problem, std::move(*first), std::move(control));
}

LawResult TubeDp::refine(const LawProblem& problem, const LawSolution& known, double half_width_u_s) {
  DynamicProgramme programme(problem);
  profiles_.clear();
  return loop(programme, problem, known, TubeControl(options_, known, half_width_u_s));
}

void TubeDp::tell_pass(DynamicProgramme& programme, std::size_t number) const {
  if (!progress_) return;
  programme.on_progress(
      [this, stage = fmt::format("pass {}", number)](double done) { progress_(stage, done); });
}

LawResult TubeDp::loop(DynamicProgramme& programme, const LawProblem& p, LawSolution law,
                       TubeControl control) {
  const std::vector<NodeCap> caps = node_caps(p);
  std::vector<LevelRange> levels(p.nodes());
  levels.front() = LevelRange::single(p.begin_u_s);
  levels.back() = LevelRange::single(p.end_u_s);
  LawSolution best = law;
  lost_.reset();
  if (keeps_profiles_) profiles_.push_back(law.speed_u_s);
  while (!control.ended()) {
    const double half = control.half_width_u_s();
    for (std::size_t i = 1; i + 1 < p.nodes(); ++i) {
      const double v = law.speed_u_s[i];
      const double low = std::max(v - half, 0.0), high = std::min(v + half, caps[i].speed_u_s);
      levels[i] = options_.grid == TubeGrid::uniform ? LevelRange::uniform(options_.levels, low, high)
                                                     : LevelRange::keeping(options_.levels, low, high, v);
    }
    tell_pass(programme, control.passes().size() + 1);
    LawResult next = programme.run(levels);
    if (!next) {  // the law found before is not among the levels of a uniform tube, and none may be within
                  // reach
      lost_ = next.error();
      break;
    }
    bool touched = false;
    for (std::size_t i = 1; i + 1 < p.nodes() && !touched; ++i) {
      const double v = law.speed_u_s[i];
      touched = (v + half < caps[i].speed_u_s && programme.level()[i] == levels[i].count - 1) ||
                (v - half > 0.0 && programme.level()[i] == 0);
    }
    control.pass(next->time_s, next->cost_s, touched);
    law = std::move(*next);
    if (keeps_profiles_) profiles_.push_back(law.speed_u_s);
    if (law.cost_s < best.cost_s) best = law;
  }
  passes_ = control.passes();
  capped_ = control.capped();
  transitions_ += programme.transitions();
  best.iterations = static_cast<std::uint32_t>(passes_.size());
  return best;
}

}  // namespace kadr::planner
