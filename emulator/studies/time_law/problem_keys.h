#pragma once
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "emulator/studies/time_law/problem.h"
#include "machine/file/key.h"

/// The keys of a problem file, each declared once: from here they are read, bounded and documented
/// (`kadr tube --keys`, docs/time_law.md).
namespace kadr::studies {

// The outer ends are far beyond any path: they keep squares, products and angles of the values within reach.
inline constexpr machine::Bounds kProblemSpeed{1e-6, 1e9};
inline constexpr machine::Bounds kProblemEndSpeed{0, 1e9};
inline constexpr machine::Bounds kProblemAcceleration{1e-6, 1e12};
inline constexpr machine::Bounds kProblemPlace{-1e9, 1e9};
inline constexpr machine::Bounds kProblemLength{1e-3, 1e9};
inline constexpr machine::Bounds kProblemLine{1, 4e9, false, true};
inline constexpr machine::Bounds kProblemValue{-1e8, 1e8};

// ---- in front of all tables

inline constexpr machine::NumberKey kProblemFormat{
    "format", {1, 1e6, false, true}, "edition of the file's format: 1", "required"};
inline constexpr machine::PlainKey kProblemName{"name", "a text", "that of the file", "name of the problem"};

// ---- [path]

/// How a program's lines become a path.
enum class PathFit : std::uint8_t { exact, spline };
inline constexpr Vocabulary<PathFit, 2> kPathFits{{
    {PathFit::exact, "exact", "the moves of the program, as a run has them"},
    {PathFit::spline, "spline", "a smooth curve through the ends of the program's lines"},
}};
static_assert(kPathFits.complete());

/// Words of [path] that the problem itself does not keep.
struct PathWords {
  PathFit fit = PathFit::exact;
  planner::SplineEnds ends = planner::SplineEnds::not_a_knot;
};

inline constexpr machine::PlainKey kPathTable{
    "table", "a file", "",
    "beside the problem: a line s,NAME,... and a row of numbers per position, s in mm, axes in their units"};
inline constexpr machine::PlainKey kPathProgram{"program", "a file", "",
                                                "a control program beside the problem"};
inline constexpr machine::PlainKey kPathMachine{
    "machine", "a name or file", "required by program",
    "a machine that ships with kadr, or a file beside the problem: its axes, and limits that are not given"};
inline constexpr machine::PlainKey kPathTools{"tools", "a file", "tools have no length",
                                              "program: a tool table beside the problem"};
inline constexpr machine::NumberKey kPathFromLine{
    "from_line", kProblemLine, "program: the path begins with the first move on or after this line",
    "first move"};
inline constexpr machine::NumberKey kPathToLine{
    "to_line", kProblemLine, "program: and ends with the last one on or before this line", "last move"};
inline constexpr auto kPathFit =
    machine::key("fit", &PathWords::fit, kPathFits, "program: how its lines become a path");
inline constexpr machine::NumberKey kPathTolerance{
    "tolerance_mm", {1e-9, 1e6}, "fit = \"spline\": allowed distance from the lines", "required by spline"};
inline constexpr machine::NumberKey kPathNodeStep{
    "node_mm", {1e-6, 1e6}, "fit = \"exact\": longest distance between two nodes", "planner.node_mm"};
inline constexpr auto kPathEnds = machine::key("ends", &PathWords::ends, planner::kSplineEnds,
                                               "ends of the splines through a table or a program's points");
inline constexpr machine::NumberKey kPathLength{
    "length_mm", kProblemLength, "path by formula: s runs from 0 to this", "required by formula"};
inline constexpr machine::NumberKey kPathNodes{
    "nodes",
    {3, kMostNodes, false, true},
    "even nodes; of a table or spline instead of its rows or points",
    "required by formula"};
inline constexpr machine::NumberKey kPathSpeed{"max_mm_s", kProblemSpeed, "highest speed along the path",
                                               "that of machine or program, else required"};
inline constexpr machine::NumberKey kPathAcceleration{"max_acceleration_mm_s2",
                                                      {1e-6, 1e12, true},
                                                      "highest acceleration along the path",
                                                      "that of the machine, else inf"};
inline constexpr auto kPathBegin =
    machine::key("begin_mm_s", &planner::LawProblem::begin_u_s, kProblemEndSpeed, "speed at the first node");
inline constexpr auto kPathEnd =
    machine::key("end_mm_s", &planner::LawProblem::end_u_s, kProblemEndSpeed, "speed at the last node");
inline constexpr auto kPathAccelTest =
    machine::key("accel_test", &planner::LawProblem::accel_test, planner::kAccelTests,
                 "at which ends of an interval accelerations are limited");

// ---- [[axis]]; {u} is its unit

enum class PathUnit : std::uint8_t { deg, mm, rad };
inline constexpr Vocabulary<PathUnit, 3> kPathUnits{{
    {PathUnit::deg, "deg", "degrees"},
    {PathUnit::mm, "mm", "millimetres"},
    {PathUnit::rad, "rad", "radians"},
}};
static_assert(kPathUnits.complete());

struct AxisWords {
  PathUnit unit = PathUnit::mm;
};

inline constexpr machine::PlainKey kPathAxisName{"name", "letters, digits and _", "required",
                                                 "of the table's column, or of the machine's axis"};
inline constexpr auto kPathAxisUnit =
    machine::key("unit", &AxisWords::unit, kPathUnits, "unit of its positions")
        .default_is("the machine's, else required");
inline constexpr machine::NumberKey kPathAxisSpeed{"max_{u}_s", kProblemSpeed, "highest speed",
                                                   "the machine's, else required"};
inline constexpr machine::NumberKey kPathAxisAcceleration{
    "max_acceleration_{u}_s2", kProblemAcceleration, "highest acceleration", "the machine's, else required"};
inline constexpr auto kFormulaKeys = machine::keys_of(
    machine::key("offset_{u}", &planner::FormulaAxis::offset, kProblemValue, "position at s = 0"),
    machine::key("slope_{u}", &planner::FormulaAxis::slope, kProblemValue, "way from s = 0 to the end"));

inline constexpr machine::PlainKey kAxisWaves{"waves", "[{ ... }, ...]", "none",
                                              "path by formula: waves that are added, see below"};
inline constexpr machine::PlainKey kAxisSteps{"steps", "[{ ... }, ...]", "none",
                                              "path by formula: steps that are added, see below"};
inline constexpr auto kWaveKeys = machine::keys_of(
    machine::key("amplitude_{u}", &planner::FormulaAxis::Wave::amplitude, kProblemValue, "of the wave")
        .required(),
    machine::key("turns", &planner::FormulaAxis::Wave::turns, machine::Bounds{0, 1e5},
                 "periods over the path")
        .required(),
    machine::key("phase_rad", &planner::FormulaAxis::Wave::phase_rad, machine::Bounds{-1e3, 1e3},
                 "at s = 0"));
inline constexpr auto kStepKeys = machine::keys_of(
    machine::key("height_{u}", &planner::FormulaAxis::Step::height, kProblemValue, "half the rise")
        .required(),
    machine::key("at_mm", &planner::FormulaAxis::Step::at_u, kProblemPlace, "its middle").required(),
    machine::key("width_mm", &planner::FormulaAxis::Step::width_u, kProblemLength, "w of tanh((s - at)/w)")
        .required());

// ---- [[zone]]

inline constexpr machine::NumberKey kZoneAt{"at_mm", kProblemPlace, "a position"};
inline constexpr machine::NumberKey kZoneFrom{"from_mm", kProblemPlace, "or from this position"};
inline constexpr machine::NumberKey kZoneTo{"to_mm", kProblemPlace, "to this one", "required by from_mm"};
inline constexpr machine::NumberKey kZoneLine{"at_line", kProblemLine,
                                              "program: or where the first move of that line begins"};
inline constexpr auto kZoneSpeed =
    machine::key("max_mm_s", &planner::SpeedZone::speed_u_s, kProblemSpeed, "highest speed there").required();

// ---- settings of the methods

inline constexpr auto kPenaltyWeight =
    machine::key("weight_s5_per_mm2", &planner::Penalty::weight_s5_u2, machine::Bounds{0, 1e6},
                 "of the axes' accelerations squared in J");
inline constexpr auto kPenaltyPerLength =
    machine::key("per_length", &planner::Penalty::per_length, "finer nodes leave the problem the same");

inline constexpr auto kTubeGrid =
    machine::key("grid", &planner::TubeOptions::grid, planner::kTubeGrids, "which speeds a pass tries");
inline constexpr auto kTubeLevels =
    machine::key("levels", &planner::TubeOptions::levels, machine::Bounds{2, 65'535},
                 "speeds tried at a node; from 3 with grid = \"nominal-kept\"");
inline constexpr auto kTubeKeys = machine::keys_of(
    machine::key("relative_half_width", &planner::TubeOptions::relative_half_width, machine::Bounds{1e-6, 1},
                 "first half width of the tube, of the highest speed of the first pass"),
    machine::key("stop_pct", &planner::TubeOptions::stop_percent, machine::Bounds{0, 100},
                 "the loop ends where time falls by less"),
    machine::key("least_half_width_mm_s", &planner::TubeOptions::least_half_width_u_s, kProblemEndSpeed,
                 "and where the tube is narrower"),
    machine::key("most_passes", &planner::TubeOptions::most_passes, machine::Bounds{2, 1000},
                 "and after so many passes"));

inline constexpr auto kClassicalLevels = machine::key("levels", &TimeLawProblem::classical_levels,
                                                      machine::Bounds{2, 65'535}, "speeds tried at a node");
inline constexpr machine::NumberKey kJerkLimit{
    "max_mm_s3", {1e-6, 1e15}, "highest jerk along the path, of jerk-limited", "required"};

// ---- keys of [[axis]] carry the axis's unit

/// "max_{u}_s" is max_rad_s.
std::string in_unit(std::string_view name, PathUnit unit);

/// Reads a key of an axis under the name that it has in the axis's unit.
machine::Reading<double> read_axis_key(machine::TableReader& r, const machine::NumberKey& key, PathUnit unit,
                                       std::optional<double> otherwise);
template <class Model>
machine::Reading<double> read_axis_key(machine::TableReader& r, Model& model,
                                       const machine::Key<Model, double>& key, PathUnit unit) {
  return machine::read_named(r, model, key, in_unit(key.name, unit), key.need == machine::Need::always);
}
template <class Model, class... Keys>
void read_axis_keys(machine::TableReader& r, Model& model, const std::tuple<Keys...>& keys, PathUnit unit) {
  std::apply([&](const auto&... each) { (read_axis_key(r, model, each, unit), ...); }, keys);
}

/// Every key of a problem file, table by table.
std::vector<machine::TableDocument> problem_keys();

}  // namespace kadr::studies
