#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "emulator/time_law/path_table.h"
#include "emulator/time_law/problem.h"
#include "machine/file/table_reader.h"

namespace kadr::emulator {
namespace {

namespace fs = std::filesystem;
using machine::Bounds;
using machine::kInfinity;
using machine::Node;
using machine::Reading;
using machine::TableReader;

// The outer ends are far beyond any path: they keep squares, products and angles of the values within reach.
constexpr Bounds kSpeed{1e-6, 1e9};
constexpr Bounds kEndSpeed{0, 1e9};
constexpr Bounds kAcceleration{1e-6, 1e12};
constexpr Bounds kPathAcceleration{1e-6, 1e12, true};
constexpr Bounds kJerk{1e-6, 1e15};
constexpr Bounds kPlace{-1e9, 1e9};
constexpr Bounds kLength{1e-3, 1e9};
constexpr Bounds kNodes{3, kMostNodes, false, true};
constexpr Bounds kValue{-1e8, 1e8};
constexpr Bounds kTurns{0, 1e5};
constexpr Bounds kPhase{-1e3, 1e3};
constexpr std::size_t kMostTerms = 64;    ///< waves, or steps, of an axis
constexpr double kMostDerivatives = 2e7;  ///< nodes times axes
constexpr std::size_t kMostNameLength = 32;
constexpr const char* kUnits[] = {"deg", "mm", "rad"};

class ProblemReader {
 public:
  ProblemReader(SourceSet& sources, std::uint32_t file, machine::ReadContext& context)
      : sources_(sources), file_(file), context_(context) {}

  void read(const Node& root) {
    TableReader table(&root, "", Span{file_, 1, 1, 1}, context_);
    const auto format = table.number("format", {1, 1e6, false, true});
    if (format.valid && format.value != 1)
      tell(Code::file_format, format.span,
           fmt::format("is edition {:.0f}, this kadr reads edition 1", format.value));
    out_.name = table.text("name", fs::path(sources_[file_].name()).stem().string()).value;
    read_path(table.table("path"), Span{file_, 1, 1, 1});
    for (const Node& axis : table.tables("axis")) read_axis(axis);
    for (const Node& zone : table.tables("zone")) read_zone(zone);
    read_penalty(table.table("penalty"));
    read_tube(table.table("tube"));
    read_classical(table.table("classical"));
    if (const Node* jerk = table.table("jerk")) {
      TableReader keys(jerk, "jerk", jerk->span, context_);
      out_.jerk_mm_s3 = keys.number("max_mm_s3", kJerk).value;
      keys.finish();
    }
    table.finish();
    if (out_.axes.empty() && context_.complete)
      tell(Code::problem_path, Span{file_, 1, 1, 1}, "there is no [[axis]]", "begin each axis with [[axis]]");
    if (!context_.diagnostics.has_errors()) place();
  }

  TimeLawProblem take() { return std::move(out_); }

 private:
  void tell(Code code, const Span& span, std::string label, std::string help = "") {
    Diagnostic d = machine::file_diagnostic(code, span, std::move(label));
    d.help = std::move(help);
    context_.diagnostics.add(std::move(d));
  }

  /// Length and nodes, or a table; limits along the path.
  void read_path(const Node* node, const Span& missing) {
    TableReader keys(node, "path", missing, context_);
    by_table_ = keys.has("table");
    table_ = keys.text("table", "");
    const bool has_length = keys.has("length_mm"), has_nodes = keys.has("nodes");
    if (node && !by_table_ && !has_length && !has_nodes)
      tell(Code::problem_path, node->span, "has neither length_mm and nodes nor a table",
           "write table = \"FILE.csv\", or length_mm and nodes and the axes' formulas");
    // what is not needed has a value that nobody reads, so that its key is known all the same
    const bool needed = !by_table_ && (has_length || has_nodes);
    const auto otherwise = [&](double value) { return needed ? std::optional<double>() : value; };
    const auto length = keys.number("length_mm", kLength, otherwise(1));
    const auto nodes = keys.number("nodes", kNodes, otherwise(3));
    if (by_table_ && has_length)
      tell(Code::problem_path, length.span, "the table gives the length already",
           "keep one of table and length_mm");
    length_mm_ = length.value;
    if (needed || has_nodes) nodes_ = nodes;
    out_.size_span = nodes_ ? nodes_->span : table_.span;
    planner::LawProblem& law = out_.law;
    law.path_feed_u_s = keys.number("max_mm_s", kSpeed).value;
    law.path_accel_u_s2 = keys.number("max_acceleration_mm_s2", kPathAcceleration, kInfinity).value;
    begin_ = keys.number("begin_mm_s", kEndSpeed, 0.0);
    end_ = keys.number("end_mm_s", kEndSpeed, 0.0);
    law.begin_u_s = begin_.value;
    law.end_u_s = end_.value;
    law.accel_test =
        static_cast<planner::AccelTest>(keys.choice("accel_test", {"end_node", "both_nodes"}, 1).value);
    keys.finish();
    path_span_ = keys.header();
  }

  void read_axis(const Node& node) {
    const machine::Entry* given = node.find("name");
    const bool named = given && given->value.kind == Node::Kind::text;
    TableReader keys(&node, named ? "axis." + given->value.text : "axis", node.span, context_);
    const std::string name = read_name(keys);
    const std::string unit = kUnits[keys.choice("unit", {"deg", "mm", "rad"}).value];
    out_.law.max_feed_u_s.push_back(keys.number(fmt::format("max_{}_s", unit), kSpeed).value);
    out_.law.max_accel_u_s2.push_back(
        keys.number(fmt::format("max_acceleration_{}_s2", unit), kAcceleration).value);
    if (by_table_)
      refuse_formula(keys, unit);
    else
      read_formula(keys, unit);
    keys.finish();
    out_.axes.push_back({name, unit});
    if (out_.axes.size() == kMostPathAxes + 1)
      tell(Code::problem_path, node.span,
           fmt::format("is axis {}, at most {} are allowed", out_.axes.size(), kMostPathAxes));
  }

  std::string read_name(TableReader& keys) {
    const auto name = keys.text("name");
    if (!name.valid) return {};
    const bool plain =
        !name.value.empty() && name.value.size() <= kMostNameLength && name.value != "s" &&
        std::all_of(name.value.begin(), name.value.end(), [](char c) {
          return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        });
    if (!plain)
      tell(Code::problem_path, name.span,
           fmt::format("a name has 1 to {} letters, digits and _, and is not s", kMostNameLength));
    if (std::any_of(out_.axes.begin(), out_.axes.end(),
                    [&](const PathAxis& axis) { return axis.name == name.value; }))
      tell(Code::problem_path, name.span, "another axis has this name");
    return name.value;
  }

  void refuse_formula(TableReader& keys, const std::string& unit) {
    for (const std::string& key : {"offset_" + unit, "slope_" + unit}) {
      if (!keys.has(key)) continue;
      tell(Code::problem_path, keys.number(key, kValue).span, "the table gives the axis's values already",
           "keep one of the table and the formula");
    }
    for (const char* key : {"waves", "steps"}) {
      if (!keys.has(key)) continue;
      const std::vector<Node>& terms = keys.tables(key);
      tell(Code::problem_path, terms.empty() ? keys.header() : terms.front().span,
           "the table gives the axis's values already", "keep one of the table and the formula");
    }
  }

  void read_formula(TableReader& keys, const std::string& unit) {
    planner::FormulaAxis axis;
    axis.offset = keys.number("offset_" + unit, kValue, 0.0).value;
    axis.slope = keys.number("slope_" + unit, kValue, 0.0).value;
    const auto each = [&](const char* key, auto&& read) {
      const std::vector<Node>& terms = keys.tables(key);
      if (terms.size() > kMostTerms)
        tell(Code::problem_path, terms[kMostTerms].span,
             fmt::format("{} {}, at most {} are allowed", terms.size(), key, kMostTerms));
      for (const Node& term : terms) {
        TableReader of_term(&term, keys.path_of(key), term.span, context_);
        read(of_term);
        of_term.finish();
      }
    };
    each("waves", [&](TableReader& wave) {
      const double amplitude = wave.number("amplitude_" + unit, kValue).value;
      const double turns = wave.number("turns", kTurns).value;
      axis.waves.push_back({amplitude, turns, wave.number("phase_rad", kPhase, 0.0).value});
    });
    each("steps", [&](TableReader& step) {
      const double height = step.number("height_" + unit, kValue).value;
      const double at = step.number("at_mm", kPlace).value;
      axis.steps.push_back({height, at, step.number("width_mm", kLength).value});
    });
    out_.formulas.push_back(std::move(axis));
  }

  void read_zone(const Node& node) {
    TableReader keys(&node, "zone", node.span, context_);
    planner::SpeedZone zone;
    zone.speed_u_s = keys.number("max_mm_s", kSpeed).value;
    Span begin, end;
    if (keys.one_of("at_mm", "from_mm") == "at_mm") {
      const auto at = keys.number("at_mm", kPlace);
      zone.begin_u = zone.end_u = at.value;
      begin = end = at.span;
      if (keys.has("to_mm")) {
        const auto to = keys.number("to_mm", kPlace);
        tell(Code::problem_zone, to.span, "a zone at a place has no end", "write from_mm in place of at_mm");
      }
    } else {
      const auto from = keys.number("from_mm", kPlace), to = keys.number("to_mm", kPlace);
      zone.begin_u = from.value;
      zone.end_u = to.value;
      begin = from.span;
      end = to.span;
      if (from.valid && to.valid && to.value < from.value)
        tell(Code::problem_zone, to.span,
             fmt::format("ends at {:g} mm, before it begins at {:g} mm", to.value, from.value),
             fmt::format("write from_mm = {:g} and to_mm = {:g}", to.value, from.value));
    }
    keys.finish();
    zone_spans_.emplace_back(begin, end);
    out_.law.zones.push_back(zone);
  }

  void read_penalty(const Node* node) {
    if (!node) return;
    TableReader keys(node, "penalty", node->span, context_);
    planner::Penalty& penalty = out_.law.penalty;
    penalty.weight_s5_u2 = keys.number("weight_s5_per_mm2", {0, 1e6}, penalty.weight_s5_u2).value;
    penalty.per_length = keys.flag("per_length", penalty.per_length).value;
    keys.finish();
  }

  void read_tube(const Node* node) {
    if (!node) return;
    TableReader keys(node, "tube", node->span, context_);
    planner::TubeOptions& tube = out_.tube;
    tube.grid = static_cast<planner::TubeGrid>(keys.choice("grid", {"uniform", "nominal-kept"}, 0).value);
    // two pieces that meet at a level have three
    const double least = tube.grid == planner::TubeGrid::nominal_kept ? 3 : 2;
    tube.levels =
        static_cast<std::int32_t>(keys.number("levels", {least, 65'535, false, true}, tube.levels).value);
    tube.relative_half_width = keys.number("relative_half_width", {1e-6, 1}, tube.relative_half_width).value;
    tube.stop_percent = keys.number("stop_pct", {0, 100}, tube.stop_percent).value;
    tube.least_half_width_u_s = keys.number("least_half_width_mm_s", {0, 1e9}, 0.0).value;
    tube.most_passes = static_cast<std::uint32_t>(
        keys.number("most_passes", {2, 1000, false, true}, tube.most_passes).value);
    keys.finish();
  }

  void read_classical(const Node* node) {
    if (!node) return;
    TableReader keys(node, "classical", node->span, context_);
    out_.classical_levels = static_cast<std::int32_t>(
        keys.number("levels", {2, 65'535, false, true}, out_.classical_levels).value);
    keys.finish();
  }

  /// Puts the path at its nodes, and looks whether a law can be thought of.
  void place() {
    if (by_table_ ? !place_table() : !place_formulas()) return;
    check_zones();
    check_law();
  }

  bool small_enough(double nodes) {
    const double derivatives = nodes * static_cast<double>(out_.axes.size());
    if (derivatives <= kMostDerivatives) return true;
    tell(Code::problem_too_large, out_.size_span,
         fmt::format("{:.0f} nodes of {} axes, nodes times axes may be at most {:.0f}", nodes,
                     out_.axes.size(), kMostDerivatives));
    return false;
  }

  bool place_formulas() {
    if (!small_enough(nodes_->value)) return false;
    planner::sample(out_.formulas, length_mm_, static_cast<std::size_t>(nodes_->value), out_.law);
    return true;
  }

  bool place_table() {
    const fs::path path = fs::path(sources_[file_].name()).parent_path() / table_.value;
    if (!fs::is_regular_file(path)) {
      tell(Code::problem_table, table_.span, fmt::format("there is no file {}", path.string()),
           "the table lies beside the problem");
      return false;
    }
    std::vector<std::string> names;
    for (const PathAxis& axis : out_.axes) names.push_back(axis.name);
    const std::uint32_t file = sources_.add(SourceText::open(path.string()));
    auto rows = read_path_table(sources_, file, names, context_.diagnostics);
    if (!rows || !small_enough(nodes_ ? nodes_->value : static_cast<double>(rows->s_u.size()))) return false;
    out_.table.emplace(std::move(rows->s_u), std::move(rows->values), out_.axes.size());
    if (nodes_)
      out_.table->sample(static_cast<std::size_t>(nodes_->value), out_.law);
    else
      out_.table->place_rows(out_.law);
    return true;
  }

  void check_zones() {
    const double first = out_.law.s_u.front(), last = out_.law.s_u.back();
    for (std::size_t i = 0; i < zone_spans_.size(); ++i) {
      const planner::SpeedZone& zone = out_.law.zones[i];
      const bool before = zone.begin_u < first;
      if (!before && zone.end_u <= last) continue;
      tell(Code::problem_zone, before ? zone_spans_[i].first : zone_spans_[i].second,
           fmt::format("is at {:g} mm, the path is from {:g} to {:g} mm", before ? zone.begin_u : zone.end_u,
                       first, last));
    }
  }

  void check_law() {
    planner::LawProblem& law = out_.law;
    std::swap(law.begin_u_s, begin_rest_);
    std::swap(law.end_u_s, end_rest_);
    const auto wrong = planner::check_problem(law);
    std::swap(law.begin_u_s, begin_rest_);
    std::swap(law.end_u_s, end_rest_);
    if (wrong)
      return tell(Code::problem_no_motion, path_span_,
                  fmt::format("node {}, s = {:g} mm: {}", wrong->node, wrong->s_u, wrong->reason));
    const std::vector<planner::NodeCap> caps = planner::node_caps(law);
    check_end(begin_, caps.front());
    check_end(end_, caps.back());
  }

  void check_end(const Reading<double>& speed, const planner::NodeCap& cap) {
    if (speed.value <= cap.speed_u_s) return;
    const std::string by = cap.reason >= 0 ? "axis " + out_.axes[static_cast<std::size_t>(cap.reason)].name
                           : cap.reason == planner::NodeCap::kZone ? std::string("a zone")
                                                                   : std::string("path.max_mm_s");
    tell(Code::problem_no_motion, speed.span,
         fmt::format("is {:g} mm/s, {} allows {:.6g} mm/s there", speed.value, by, cap.speed_u_s));
  }

  SourceSet& sources_;
  std::uint32_t file_;
  machine::ReadContext& context_;
  TimeLawProblem out_;
  bool by_table_ = false;
  Reading<std::string> table_;
  std::optional<Reading<double>> nodes_;
  double length_mm_ = 0;
  double begin_rest_ = 0, end_rest_ = 0;
  Reading<double> begin_, end_;
  Span path_span_;
  std::vector<std::pair<Span, Span>> zone_spans_;  // [zones], where begin and end are written
};

}  // namespace

tl::expected<TimeLawProblem, Diagnostics> read_time_law_problem(SourceSet& sources, std::uint32_t file) {
  Diagnostics diagnostics;
  const machine::ParsedTree tree = machine::parse_toml(sources, file, diagnostics);
  machine::ReadContext context{diagnostics, sources, tree.complete, {}};
  ProblemReader reader(sources, file, context);
  reader.read(tree.root);
  if (diagnostics.has_errors()) return tl::unexpected(std::move(diagnostics));
  return reader.take();
}

}  // namespace kadr::emulator
