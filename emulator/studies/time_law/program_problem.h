#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emulator/studies/time_law/problem.h"
#include "machine/base/confinement.h"
#include "machine/file/table_reader.h"

namespace kadr::studies {

/// A problem whose path is a stretch of a program: its keys and how they are used.
class ProgramProblem {
 public:
  /// @param folders  below which program, machine and tools lie
  ProgramProblem(SourceSet& sources, InputFolders folders, machine::ReadContext& context,
                 const gcode::ReadingBounds& bounds)
      : sources_(sources), folders_(std::move(folders)), context_(context), bounds_(bounds) {}

  /// The keys of [path] for such a problem; max_mm_s and others are read elsewhere.
  void read_path(machine::TableReader& keys);
  /// An [[axis]]: limits that override the machine's.
  void read_axis(const machine::Node& node);

  /// Opens machine and program, lays out the path and states it. Of `out` axes, program, warnings and law are
  /// set; limits along the path, end speeds, zones and accel_test stay.
  /// @param nodes  of a spline: even nodes instead of its rows
  /// @return false if there are mistakes (in the context's diagnostics)
  bool place(const std::optional<double>& nodes, TimeLawProblem& out);

  const Span& program_span() const { return program_.span; }
  bool by_spline() const { return spline_; }
  /// Where the first motion of a line begins, if the stretch contains it. @pre place()
  static std::optional<double> line_s_mm(const ProgramPath& program, std::uint32_t line,
                                         std::uint32_t program_file);
  std::uint32_t program_file() const { return program_file_; }

 private:
  struct AxisLimits {
    machine::Reading<std::string> name;
    const machine::Node* node = nullptr;
  };

  void tell(Code code, const Span& span, std::string label, const std::string& allowed = "",
            std::string help = "");
  bool override_axes(machine::MachineModel& machine);
  bool lay_out(machine::MachineFile machine, TimeLawProblem& out);
  bool choose_stretch(const planner::PathLimitTable& table, ProgramPath& program);
  bool state_lines(const planner::PathLimitTable& table, TimeLawProblem& out);
  bool state_spline(const std::optional<double>& nodes, TimeLawProblem& out);
  void note_nodes(const std::vector<planner::Signature>& held_by, TimeLawProblem& out) const;
  bool few_enough(double nodes);

  SourceSet& sources_;
  InputFolders folders_;
  machine::ReadContext& context_;
  gcode::ReadingBounds bounds_;
  machine::Reading<std::string> program_, machine_name_;
  std::optional<machine::Reading<std::string>> tools_;
  std::optional<machine::Reading<double>> from_line_, to_line_;
  std::optional<double> node_mm_;
  bool spline_ = false;
  machine::Reading<double> tolerance_;
  planner::SplineEnds ends_ = planner::SplineEnds::not_a_knot;
  std::vector<AxisLimits> axes_;
  machine::MachineModel model_;  ///< with the problem's limits
  std::uint32_t program_file_ = 0;
};

}  // namespace kadr::studies
