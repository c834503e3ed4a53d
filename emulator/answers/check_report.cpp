#include "emulator/answers/check_report.h"

#include <fmt/format.h>

#include "emulator/answers/summary.h"
#include "emulator/text/text.h"
#include "emulator/text/units.h"

namespace kadr::answers {
namespace {

std::string limits_text(const machine::AxisModel& axis) {
  const auto limit = [](double value_u) {
    return value_u == machine::kInfinity || value_u == -machine::kInfinity ? std::string("none")
                                                                           : text::fixed(value_u, 3);
  };
  if (axis.soft_min_u == -machine::kInfinity && axis.soft_max_u == machine::kInfinity) return "none";
  return fmt::format("{} .. {} {}", limit(axis.soft_min_u), limit(axis.soft_max_u), text::axis_unit(axis));
}

bool outside(const AxisTravel& travel, const machine::AxisModel& axis) {
  // as in the soft-limit check: a limit reached up to rounding is inside
  return travel.min_u < axis.soft_min_u - kSamePoint_u || travel.max_u > axis.soft_max_u + kSamePoint_u;
}

}  // namespace

CheckResult check_result(const cycle::Job& job) {
  CheckResult r;
  r.motion_s = job.planned.plan.motion_s;
  r.dwell_s = job.planned.plan.pause_s;
  r.time_s = job.planned.plan.motion_s + job.planned.plan.pause_s;
  r.blocks = job.read.blocks;
  r.travel = axis_travel(job.read.path);
  r.path_unit = path_unit(job.read.path, job.given.machine.model);
  r.limited_by = cycle::limit_shares(job.planned.plan.law, job.given.machine.model);
  r.approach = approach_row(job);
  for (std::size_t i = job.read.path.approach_size(); i < job.read.path.size(); ++i) {
    const planner::PathSegment& segment = job.read.path.segments[i];
    const planner::SegmentPlan& plan = job.planned.plan.segments[i];
    r.path_u += segment.feed_length_u;
    if (segment.rapid) {
      r.rapid_s += plan.end_time_s - plan.begin_time_s;
      r.rapid_path_u += segment.feed_length_u;
    }
    const double peak_u_s = plan.peak_u_s * segment.feed_length_u / segment.length_u;
    if (peak_u_s > r.peak_u_s) {
      r.peak_u_s = peak_u_s;
      r.peak_line = segment.span.line;
    }
  }
  return r;
}

std::string render_check(const CheckResult& r, const std::string& program, const std::string& machine_text,
                         const machine::MachineModel& model) {
  std::string out = fmt::format("{} on {}\n", text::one_line(program, 60), text::one_line(machine_text, 60));
  const double approach_s = r.approach ? r.approach->time_s : 0.0;
  out += fmt::format("  time         {}   ({} cutting, {} rapid, {} standing)   {}\n",
                     text::duration_text(r.time_s), text::duration_text(r.motion_s - r.rapid_s - approach_s),
                     text::duration_text(r.rapid_s), text::duration_text(r.dwell_s),
                     text::counted(r.blocks, "block"));
  if (r.approach) out += fmt::format("  approach     {}\n", approach_text(*r.approach));
  out += fmt::format("  path         {} {}   ({} rapid)", text::fixed(r.path_u, 3), r.path_unit,
                     text::fixed(r.rapid_path_u, 3));
  if (r.peak_u_s > 0)
    out += fmt::format("   peak feed {} {} (line {})", text::fixed(r.peak_u_s, 3),
                       text::speed_unit(r.path_unit), r.peak_line);
  out += '\n';

  using Align = text::TextTable::Align;
  text::TextTable table(
      {{"axis", Align::left}, {"from"}, {"to"}, {"", Align::left}, {"soft limits"}, {"", Align::left}});
  for (std::size_t a = 0; a < r.travel.size(); ++a) {
    const machine::AxisModel& axis = model.axis[a];
    const AxisTravel& t = r.travel[a];
    table.add({std::string("  ") + axis.letter, text::fixed(t.min_u, 3), text::fixed(t.max_u, 3),
               text::axis_unit(axis), limits_text(axis),
               outside(t, axis) ? "OUTSIDE"
               : t.travel_u > 0 ? ""
                                : "not moved"});
  }
  out += table.render("  ");
  if (const std::string limits = render_limits(r.limited_by); !limits.empty()) out += "  " + limits;
  return out;
}

}  // namespace kadr::answers
