#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "emulator/studies/time_law/path_table.h"
#include "emulator/studies/time_law/problem_axis.h"
#include "emulator/studies/time_law/problem_keys.h"
#include "emulator/studies/time_law/problem_machine.h"
#include "emulator/studies/time_law/program_problem.h"
#include "machine/file/named_file.h"
#include "machine/file/table_reader.h"

namespace kadr::studies {
namespace {

namespace fs = std::filesystem;
using machine::kInfinity;
using machine::Node;
using machine::read_key;
using machine::read_number;
using machine::Reading;
using machine::TableReader;

constexpr double kMostDerivatives = 2e7;  ///< nodes times axes

class ProblemReader {
 public:
  ProblemReader(SourceSet& sources, std::uint32_t file, const InputFolders& folders,
                machine::ReadContext& context, const gcode::ReadingBounds& bounds)
      : sources_(sources),
        file_(file),
        folders_(folders),
        context_(context),
        program_(sources, folders, context, bounds) {}

  void read(const Node& root) {
    TableReader table(&root, "", Span{file_, 1, 1, 1}, context_);
    const auto format = read_number(table, kProblemFormat);
    if (format.valid && format.value != 1)
      tell(Code::file_format, format.span,
           fmt::format("is edition {:.0f}, this kadr reads edition 1", format.value));
    out_.name = table.text(kProblemName.name, fs::path(sources_[file_].name()).stem().string()).value;
    read_path(table.table("path"), Span{file_, 1, 1, 1});
    for (const Node& axis : table.tables("axis")) read_axis(axis);
    for (const Node& zone : table.tables("zone")) read_zone(zone);
    read_penalty(table.table("penalty"));
    read_tube(table.table("tube"));
    read_classical(table.table("classical"));
    if (const Node* jerk = table.table("jerk")) {
      TableReader keys(jerk, "jerk", jerk->span, context_);
      out_.jerk_mm_s3 = read_number(keys, kJerkLimit).value;
      keys.finish();
    }
    table.finish();
    if (out_.axes.empty() && !by_program_ && context_.complete)
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

  /// Length and nodes, or a table, or a program; limits along the path.
  void read_path(const Node* node, const Span& missing) {
    TableReader keys(node, "path", missing, context_);
    read_source(keys);
    read_size(keys, node);
    read_limits(keys);
    keys.finish();
    path_span_ = keys.header();
  }

  /// Which of table, program and formula states the path.
  void read_source(TableReader& keys) {
    by_program_ = keys.has(kPathProgram.name);
    by_table_ = !by_program_ && keys.has(kPathTable.name);
    table_ = keys.text(kPathTable.name, "");
    if (by_program_ && keys.has(kPathTable.name))
      tell(Code::problem_path, table_.span, "the program already gives the path",
           "keep one of table and program");
    if (by_program_)
      program_.read_path(keys);
    else if (keys.has(kPathMachine.name))
      machine_ = open_problem_machine(sources_, folders_, keys.text(kPathMachine.name), context_);
    PathWords words;
    if (by_table_) read_key(keys, words, kPathEnds);
    ends_ = words.ends;
  }

  void read_size(TableReader& keys, const Node* node) {
    const bool has_length = keys.has(kPathLength.name), has_nodes = keys.has(kPathNodes.name);
    if (node && !by_table_ && !by_program_ && !has_length && !has_nodes)
      tell(Code::problem_path, node->span, "has neither length_mm and nodes nor a table or program",
           "write table = \"FILE.csv\", program = \"FILE.ngc\", or length_mm and nodes and the axes' "
           "formulas");
    // values that are not needed are read anyway, so that their keys are known
    const bool needed = !by_table_ && !by_program_ && (has_length || has_nodes);
    const auto otherwise = [&](double value) { return needed ? std::optional<double>() : value; };
    const auto length = read_number(keys, kPathLength, otherwise(1));
    const auto nodes = read_number(keys, kPathNodes, otherwise(3));
    if ((by_table_ || by_program_) && has_length) {
      const char* other = by_table_ ? "table" : "program";
      tell(Code::problem_path, length.span, fmt::format("the {} already gives the length", other),
           fmt::format("keep one of {} and length_mm", other));
    }
    if (by_program_ && !program_.by_spline() && has_nodes)
      tell(Code::problem_path, nodes.span, "a program's joints are nodes, and others lie between them",
           "write node_mm, the longest distance between nodes, or fit = \"spline\"");
    length_mm_ = length.value;
    if (needed || has_nodes) nodes_ = nodes;
    out_.size_span = nodes_ ? nodes_->span : by_program_ ? program_.program_span() : table_.span;
  }

  /// A program sets the speed, with its feeds and its machine.
  void read_limits(TableReader& keys) {
    const auto of_machine = [&](double machine::PathLimits::*limit) {
      return by_program_ ? std::optional<double>(kInfinity)
             : machine_ && machine_->model.path.*limit < kInfinity
                 ? std::optional<double>(machine_->model.path.*limit)
                 : std::nullopt;
    };
    planner::LawProblem& law = out_.law;
    law.path_feed_u_s = read_number(keys, kPathSpeed, of_machine(&machine::PathLimits::max_feed_mm_s)).value;
    law.path_accel_u_s2 = read_number(keys, kPathAcceleration,
                                      of_machine(&machine::PathLimits::max_accel_mm_s2).value_or(kInfinity))
                              .value;
    begin_ = read_key(keys, law, kPathBegin);
    end_ = read_key(keys, law, kPathEnd);
    read_key(keys, law, kPathAccelTest);
  }

  void read_axis(const Node& node) {
    if (by_program_) return program_.read_axis(node);
    read_problem_axis(node, by_table_, machine_ ? &machine_->model : nullptr, out_, context_);
  }

  void read_zone(const Node& node) {
    TableReader keys(&node, "zone", node.span, context_);
    planner::SpeedZone zone;
    read_key(keys, zone, kZoneSpeed);
    Span begin, end;
    std::optional<std::uint32_t> line;
    if (by_program_ && keys.has(kZoneLine.name)) {
      const auto at = read_number(keys, kZoneLine);
      line = static_cast<std::uint32_t>(at.value);
      begin = end = at.span;
    } else if (keys.one_of(kZoneAt.name, kZoneFrom.name) == kZoneAt.name) {
      const auto at = read_number(keys, kZoneAt);
      zone.begin_u = zone.end_u = at.value;
      begin = end = at.span;
      if (keys.has(kZoneTo.name)) {
        const auto to = read_number(keys, kZoneTo);
        tell(Code::problem_zone, to.span, "a zone at one position has no end",
             "write from_mm instead of at_mm");
      }
    } else {
      const auto from = read_number(keys, kZoneFrom), to = read_number(keys, kZoneTo);
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
    zone_lines_.push_back(line);
    out_.law.zones.push_back(zone);
  }

  void read_penalty(const Node* node) {
    if (!node) return;
    TableReader keys(node, "penalty", node->span, context_);
    // a value that is not given comes from the path: for a program, as in a run of it
    planner::Penalty written;
    read_key(keys, written, kPenaltyWeight);
    read_key(keys, written, kPenaltyPerLength);
    if (!by_program_ || keys.has(kPenaltyWeight.name)) weight_s5_u2_ = written.weight_s5_u2;
    if (!by_program_ || keys.has(kPenaltyPerLength.name)) per_length_ = written.per_length;
    keys.finish();
  }

  void read_tube(const Node* node) {
    if (!node) return;
    TableReader keys(node, "tube", node->span, context_);
    planner::TubeOptions& tube = out_.tube;
    read_key(keys, tube, kTubeGrid);
    auto levels = kTubeLevels;
    // two pieces that meet at a level have three
    if (tube.grid == planner::TubeGrid::nominal_kept) levels.bounds.low = 3;
    read_key(keys, tube, levels);
    machine::read_keys(keys, tube, kTubeKeys);
    keys.finish();
  }

  void read_classical(const Node* node) {
    if (!node) return;
    TableReader keys(node, "classical", node->span, context_);
    read_key(keys, out_, kClassicalLevels);
    keys.finish();
  }

  /// Evaluates the path at its nodes, and checks whether a law can exist.
  void place() {
    if (by_program_ ? !place_program() : by_table_ ? !place_table() : !place_formulas()) return;
    out_.law.penalty.weight_s5_u2 = weight_s5_u2_.value_or(out_.law.penalty.weight_s5_u2);
    out_.law.penalty.per_length = per_length_.value_or(out_.law.penalty.per_length);
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

  bool place_program() {
    std::optional<double> nodes;
    if (nodes_) nodes = nodes_->value;
    if (!program_.place(nodes, out_)) return false;
    for (std::size_t i = 0; i < zone_lines_.size(); ++i) {
      if (!zone_lines_[i]) continue;
      const auto at = ProgramProblem::line_s_mm(*out_.program, *zone_lines_[i], program_.program_file());
      if (!at)
        tell(Code::problem_zone, zone_spans_[i].first,
             fmt::format("no motion of the path begins on line {}", *zone_lines_[i]),
             fmt::format("the path has moves of lines {} to {}", out_.program->first_line,
                         out_.program->last_line));
      out_.law.zones[i].begin_u = out_.law.zones[i].end_u = at.value_or(0.0);
    }
    return !context_.diagnostics.has_errors() && small_enough(static_cast<double>(out_.law.nodes()));
  }

  bool place_formulas() {
    if (!small_enough(nodes_->value)) return false;
    planner::sample(out_.formulas, length_mm_, static_cast<std::size_t>(nodes_->value), out_.law);
    return true;
  }

  bool place_table() {
    const InputFile named(table_.value, folders_);
    const InputPlace place = machine::look_for(named, table_.span, context_.diagnostics);
    if (place == InputPlace::missing)
      tell(Code::problem_table, table_.span, missing_text(named), "the table is next to the problem file");
    if (place != InputPlace::inside) return false;
    std::vector<std::string> names;
    for (const PathAxis& axis : out_.axes) names.push_back(axis.name);
    const std::uint32_t file = sources_.add(SourceText::open(named, kMostTable_bytes));
    auto rows = read_path_table(sources_, file, names, context_.diagnostics);
    if (!rows || !small_enough(nodes_ ? nodes_->value : static_cast<double>(rows->s_u.size()))) return false;
    out_.table.emplace(std::move(rows->s_u), std::move(rows->values), out_.axes.size(), ends_);
    if (nodes_)
      out_.table->sample(static_cast<std::size_t>(nodes_->value), out_.law);
    else
      out_.table->place_rows(out_.law);
    return true;
  }

  void check_zones() {
    const double first = out_.law.s_u.front(), last = out_.law.s_u.back();
    // a program may have zones of its own after those of the file
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
                           : cap.reason == planner::NodeCap::kZone  ? std::string("a zone")
                           : cap.reason == planner::NodeCap::kGiven ? std::string("the program")
                                                                    : std::string("path.max_mm_s");
    tell(Code::problem_no_motion, speed.span,
         fmt::format("is {:g} mm/s, {} allows {:.6g} mm/s there", speed.value, by, cap.speed_u_s));
  }

  SourceSet& sources_;
  std::uint32_t file_;
  InputFolders folders_;  ///< below which its files lie
  machine::ReadContext& context_;
  ProgramProblem program_;
  std::optional<machine::MachineFile> machine_;  ///< of a path by formula or table
  TimeLawProblem out_;
  bool by_table_ = false, by_program_ = false;
  planner::SplineEnds ends_ = planner::SplineEnds::not_a_knot;
  std::optional<double> weight_s5_u2_;
  std::optional<bool> per_length_;
  Reading<std::string> table_;
  std::optional<Reading<double>> nodes_;
  double length_mm_ = 0;
  double begin_rest_ = 0, end_rest_ = 0;
  Reading<double> begin_, end_;
  Span path_span_;
  std::vector<std::pair<Span, Span>> zone_spans_;         // [zones], where begin and end are written
  std::vector<std::optional<std::uint32_t>> zone_lines_;  // [zones], at_line
};

}  // namespace

double TimeLawProblem::scale_mm_s() const {
  if (law.path_feed_u_s < kInfinity) return law.path_feed_u_s;
  double highest = 0;
  for (const planner::NodeCap& cap : planner::node_caps(law)) highest = std::max(highest, cap.speed_u_s);
  return highest;
}

tl::expected<TimeLawProblem, Diagnostics> read_time_law_problem(SourceSet& sources, std::uint32_t file,
                                                                const std::vector<std::string>& allowed,
                                                                const gcode::ReadingBounds& bounds) {
  Diagnostics diagnostics;
  const machine::ParsedTree tree = machine::parse_toml(sources, file, diagnostics);
  machine::ReadContext context{diagnostics, sources, tree.complete, {}};
  const InputFolders folders{fs::path(sources[file].name()).parent_path().string(), allowed};
  ProblemReader reader(sources, file, folders, context, bounds);
  reader.read(tree.root);
  if (diagnostics.has_errors()) return tl::unexpected(std::move(diagnostics));
  return reader.take();
}

}  // namespace kadr::studies
