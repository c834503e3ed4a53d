#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulator/studies/time_law/law_study.h"
#include "emulator/text/json.h"

/// The output of `kadr tube` about the laws of a problem.
namespace kadr::studies {

/// "docs/tube/laying.toml: laying, 893 nodes over 2 846.900 mm, 7 axes, ..."; for a path by program a line
/// more with its stretch, and one with the deviation of a spline through it.
std::string render_problem(const TimeLawProblem& problem, std::string_view file);
/// The loop of the tube as paper 000 prints it (figure 2): a time per length with 7 decimals, total and fall
/// with 5 digits, the half width used; why the loop ended.
std::string render_tube_log(const TubeStory& tube, const planner::LawSolution* law, double length_mm,
                            const planner::TubeOptions& options);
/// One row per method; wall times only on request, since they are never the same twice.
std::string render_law_table(const LawStudy& study, bool timing);
/// Methods that found no law, and where; limits that a law breaks, and where; limits kept.
std::string render_law_checks(const LawStudy& study, const TimeLawProblem& problem);

/// {"problem", "lower_bound_s", "methods", "passes", ...}; no wall times.
text::Json json_of(const LawStudy& study, const TimeLawProblem& problem);

/// "s_mm,cap_mm_s,held_by,tube_mm_s,tube_t_s,...": one row per node, a pair of columns per law found; in
/// pieces. Of a path by program "s_mm,line,cap_mm_s,...".
void write_law_csv(const LawStudy& study, const TimeLawProblem& problem,
                   const std::function<void(std::string_view)>& sink);
/// The limit of the speed at a node: "path", "zone" or the name of an axis; of a path by program also what
/// `kadr plan` prints: "program", "junction X", "rapid" ...
std::string held_by(const planner::NodeCap& cap, std::size_t node, const TimeLawProblem& problem);
/// How many nodes of a law each limit holds, most first: "A1 acceleration", "zone", "no limit".
std::vector<std::pair<std::string, std::size_t>> law_shares(const planner::LawSolution& law,
                                                            const TimeLawProblem& problem);
/// A limit in the words of its axis: "axis A acceleration", and its unit.
struct LimitText {
  std::string what, unit;
};
LimitText limit_text(const planner::LawViolation& violation, const TimeLawProblem& problem);
/// "+2.4794", "0.0000"
std::string signed_percent(double ratio);

}  // namespace kadr::studies
