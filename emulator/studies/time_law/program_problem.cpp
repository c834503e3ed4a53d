#include "emulator/studies/time_law/program_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "emulator/emulator.h"
#include "emulator/studies/time_law/problem_keys.h"
#include "emulator/studies/time_law/problem_machine.h"
#include "machine/file/named_file.h"

namespace kadr::studies {
namespace {

using machine::Node;
using machine::read_key;
using machine::read_number;
using machine::TableReader;

constexpr std::size_t kMostListed = 8;  ///< motions that a message names

std::string lines_text(std::uint32_t first, std::uint32_t last) {
  return first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
}

bool rests(const planner::PathLimitTable& table, std::size_t joint) {
  return !(table.cap_u_s[2 * joint] > 0.0);
}

}  // namespace

void ProgramProblem::tell(Code code, const Span& span, std::string label, const std::string& allowed,
                          std::string help) {
  Diagnostic d = machine::file_diagnostic(code, span, std::move(label));
  if (!allowed.empty()) d.notes.push_back("allowed: " + allowed);
  d.help = std::move(help);
  context_.diagnostics.add(std::move(d));
}

void ProgramProblem::read_path(TableReader& keys) {
  program_ = keys.text(kPathProgram.name);
  machine_name_ = keys.text(kPathMachine.name);
  if (keys.has(kPathTools.name)) tools_ = keys.text(kPathTools.name);
  if (keys.has(kPathFromLine.name)) from_line_ = read_number(keys, kPathFromLine);
  if (keys.has(kPathToLine.name)) to_line_ = read_number(keys, kPathToLine);
  if (from_line_ && to_line_ && to_line_->value < from_line_->value)
    tell(Code::problem_program, to_line_->span, fmt::format("is line {:.0f}", to_line_->value),
         fmt::format("{:.0f} and more, the path.from_line", from_line_->value));
  PathWords words;
  spline_ = read_key(keys, words, kPathFit).value == PathFit::spline;
  if (spline_) {
    tolerance_ = read_number(keys, kPathTolerance);
    ends_ = read_key(keys, words, kPathEnds).value;
  } else if (keys.has(kPathNodeStep.name)) {
    node_mm_ = read_number(keys, kPathNodeStep).value;
  }
}

void ProgramProblem::read_axis(const Node& node) {
  const machine::Entry* given = node.find(kPathAxisName.name);
  const bool named = given && given->value.kind == Node::Kind::text;
  if (named) {
    axes_.push_back({{given->value.text, true, given->value.span}, &node});
    return;
  }
  TableReader keys(&node, "axis", node.span, context_);
  keys.text(kPathAxisName.name);
  keys.finish();
}

bool ProgramProblem::override_axes(machine::MachineModel& machine) {
  const std::size_t errors = context_.diagnostics.errors();
  for (const AxisLimits& axis : axes_) {
    machine::AxisModel* model = find_problem_axis(machine, axis.name, context_);
    if (!model) continue;
    TableReader keys(axis.node, "axis." + axis.name.value, axis.node->span, context_);
    keys.text(kPathAxisName.name);
    const PathUnit unit = model->kind == machine::AxisKind::rotary ? PathUnit::deg : PathUnit::mm;
    model->max_feed_u_s = read_axis_key(keys, kPathAxisSpeed, unit, model->max_feed_u_s).value;
    model->max_accel_u_s2 = read_axis_key(keys, kPathAxisAcceleration, unit, model->max_accel_u_s2).value;
    keys.finish();
  }
  return context_.diagnostics.errors() == errors;
}

bool ProgramProblem::lay_out(machine::MachineFile machine, TimeLawProblem& out) {
  const auto open = [&](const machine::Reading<std::string>& name, auto read,
                        std::uint64_t most_bytes) -> std::optional<SourceText> {
    const InputFile file(name.value, folders_);
    const InputPlace place = machine::look_for(file, name.span, context_.diagnostics);
    if (place == InputPlace::inside) return read(file, most_bytes);
    if (place == InputPlace::missing) tell(Code::problem_program, name.span, missing_text(file));
    return {};
  };
  auto program = open(program_, gcode::open_program, bounds_.file_bytes);
  const auto open_table = [](const InputFile& file, std::uint64_t most_bytes) {
    return SourceText::open(file, most_bytes);
  };
  auto tools = tools_ ? open(*tools_, open_table, kMostTable_bytes) : std::nullopt;
  if (!program || (tools_ && !tools)) return false;
  cycle::JobInputs given;
  given.machine = std::move(machine);
  given.reading.bounds = bounds_;
  given.reading.allowed_folders = folders_.allowed;
  Diagnostics found;
  if (tools) given.reading.tools = gcode::read_tool_table(sources_, sources_.add(std::move(*tools)), found);
  given.program = program_file_ = sources_.add(std::move(*program));
  auto read = found.has_errors() ? std::nullopt : cycle::lay_out(given, sources_, found);
  if (read)
    for (const Diagnostic& fault : read->path.faults) found.add(fault);
  if (!read || found.has_errors()) {
    context_.diagnostics.add(found);
    return false;
  }
  out.warnings = std::move(found);
  out.program.emplace();
  out.program->program = program_.value;
  out.program->machine = given.machine.model.name;
  out.program->path = std::move(read->path);
  model_ = std::move(given.machine.model);
  return true;
}

bool ProgramProblem::place(const std::optional<double>& nodes, TimeLawProblem& out) {
  auto machine = open_problem_machine(sources_, folders_, machine_name_, context_);
  if (!machine || !override_axes(machine->model)) return false;
  // corners and arcs as a run by a time law has them
  machine->model.planner.method = machine::PlanMethod::certified;
  if (node_mm_) machine->model.planner.node_mm = *node_mm_;
  if (!lay_out(std::move(*machine), out)) return false;
  for (const machine::AxisModel& axis : model_.axis)
    out.axes.push_back({std::string(1, axis.letter), axis.kind == machine::AxisKind::rotary ? "deg" : "mm"});
  const auto table = planner::limit_table(out.program->path, model_);
  if (!table) {
    context_.diagnostics.add(table.error().diagnostic);
    return false;
  }
  if (!choose_stretch(*table, *out.program)) return false;
  return spline_ ? state_spline(nodes, out) : state_lines(*table, out);
}

bool ProgramProblem::choose_stretch(const planner::PathLimitTable& table, ProgramPath& program) {
  const std::vector<planner::PathSegment>& segments = program.path.segments;
  const auto inside = [&](const planner::PathSegment& s) {
    if (s.span.file != program_file_) return !from_line_ && !to_line_;
    return !(from_line_ && s.span.line < from_line_->value) && !(to_line_ && s.span.line > to_line_->value);
  };
  const auto first = std::find_if(segments.begin(), segments.end(), inside);
  if (first == segments.end()) {
    tell(Code::problem_program,
         from_line_ ? from_line_->span
         : to_line_ ? to_line_->span
                    : program_.span,
         from_line_ || to_line_ ? "the program has no motion on these lines" : "the program has no motion");
    return false;
  }
  const auto last = std::find_if(segments.rbegin(), segments.rend(), inside);
  program.run.first = static_cast<std::size_t>(first - segments.begin());
  program.run.last = static_cast<std::size_t>(last.base() - segments.begin()) - 1;
  program.first_line = first->span.line;
  program.last_line = last->span.line;
  std::vector<std::string> motions;
  std::size_t begin = program.run.first, count = 0, behind = 0;
  for (std::size_t i = program.run.first; i <= program.run.last; ++i) {
    if (i < program.run.last && !rests(table, i + 1)) continue;
    if (++count == 1) behind = i;
    if (motions.size() < kMostListed)
      motions.push_back(lines_text(segments[begin].span.line, segments[i].span.line));
    begin = i + 1;
  }
  if (count == 1) return true;
  if (count > motions.size()) motions.push_back("...");
  tell(Code::problem_program, segments[behind].span, "the machine stops after this move",
       fmt::format("one motion from rest to rest; here are {}: {}", count, fmt::join(motions, "; ")),
       "name one of them with path.from_line and path.to_line");
  return false;
}

bool ProgramProblem::few_enough(double nodes) {
  if (nodes <= kMostNodes) return true;
  tell(Code::problem_too_large, program_.span, fmt::format("the path has about {:.3g} nodes", nodes),
       fmt::format("{:.0f}", kMostNodes), "use a larger path.node_mm, or fewer lines");
  return false;
}

bool ProgramProblem::state_lines(const planner::PathLimitTable& table, TimeLawProblem& out) {
  const ProgramPath& program = *out.program;
  const double length_u =
      program.path.start_s_u[program.run.last + 1] - program.path.start_s_u[program.run.first];
  const auto moves = static_cast<double>(program.run.last - program.run.first + 1);
  if (!few_enough(moves + length_u / model_.planner.node_mm)) return false;
  planner::Stretch stated = planner::state_stretch(program.path, table, program.run, model_);
  if (!few_enough(static_cast<double>(stated.problem.nodes()))) return false;
  planner::LawProblem& law = stated.problem;
  law.path_feed_u_s = out.law.path_feed_u_s;
  law.path_accel_u_s2 = out.law.path_accel_u_s2;
  law.begin_u_s = out.law.begin_u_s;
  law.end_u_s = out.law.end_u_s;
  law.zones = std::move(out.law.zones);
  law.accel_test = out.law.accel_test;
  out.law = std::move(law);
  for (const std::size_t segment : stated.segment)
    out.program->line.push_back(out.program->path.segments[segment].span.line);
  note_nodes(stated.held_by, out);
  return true;
}

bool ProgramProblem::state_spline(const std::optional<double>& nodes, TimeLawProblem& out) {
  ProgramPath& program = *out.program;
  const planner::Path& path = program.path;
  for (std::size_t i = program.run.first; i <= program.run.last; ++i) {
    if (path.segments[i].kind == planner::SegmentKind::line) continue;
    tell(Code::problem_program, path.segments[i].span, "is not a straight line",
         "lines alone, whose ends are the points of a spline",
         "keep fit = \"exact\", or name the lines with path.from_line and path.to_line");
    return false;
  }
  if (program.run.last - program.run.first < 2) {
    tell(Code::problem_program, program_.span,
         fmt::format("{} points", program.run.last - program.run.first + 2), "4 and more for a spline");
    return false;
  }
  program.fit = planner::fit_spline(path, program.run, ends_);
  program.tolerance_mm = tolerance_.value;
  if (program.fit->deviation_u > tolerance_.value) {
    tell(Code::problem_fit, path.segments[program.fit->segment].span,
         fmt::format("the spline is {:.6g} mm from this line, at s = {:.3f} mm", program.fit->deviation_u,
                     program.fit->deviation_s_u),
         fmt::format("{:g} mm, path.tolerance_mm", tolerance_.value),
         "a smooth path has no corners: end the stretch there, keep fit = \"exact\", or allow more");
    return false;
  }
  std::optional<std::size_t> even;
  if (nodes) even = static_cast<std::size_t>(*nodes);
  std::vector<planner::Signature> held_by;
  planner::state_fit(*program.fit, path, program.run, model_, even, out.law, held_by);
  out.law.penalty = planner::run_penalty(out.law.length_u());
  std::size_t segment = program.run.first;
  const double origin = path.start_s_u[segment];
  for (const double s : out.law.s_u) {
    while (segment < program.run.last && path.start_s_u[segment + 1] - origin < s) ++segment;
    program.line.push_back(path.segments[segment].span.line);
  }
  note_nodes(held_by, out);
  return true;
}

void ProgramProblem::note_nodes(const std::vector<planner::Signature>& held_by, TimeLawProblem& out) const {
  ProgramPath& program = *out.program;
  for (const planner::Signature& s : held_by) {
    const std::string reason = cycle::limited_by_text(s.reason, s.axis, model_);
    const auto known = std::find(program.reasons.begin(), program.reasons.end(), reason);
    program.held_by.push_back(static_cast<std::uint16_t>(known - program.reasons.begin()));
    if (known == program.reasons.end()) program.reasons.push_back(reason);
  }
}

std::optional<double> ProgramProblem::line_s_mm(const ProgramPath& program, std::uint32_t line,
                                                std::uint32_t program_file) {
  const planner::Path& path = program.path;
  for (std::size_t i = program.run.first; i <= program.run.last; ++i)
    if (path.segments[i].span.line == line && path.segments[i].span.file == program_file)
      return path.start_s_u[i] - path.start_s_u[program.run.first];
  return {};
}

}  // namespace kadr::studies
