#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "emulator/emulator.h"
#include "machine/base/require.h"
#include "planner/planner.h"

namespace kadr::cycle {
namespace {

/// Of what verify() measures: "mm/s2", "s", "" ...; mm and deg count alike along the path.
std::string unit_of(const planner::Violation& v, const machine::MachineModel& machine) {
  const std::string_view what = v.what;
  const auto has = [&](std::string_view word) { return what.find(word) != std::string_view::npos; };
  if (what == "kl" || what == "table size") return "";
  if (has("time") || has("duration") || has("ticks") || what == "pause" || what == "block end inside a piece")
    return " s";
  const bool rotary = v.axis >= 0 && is_rotary_letter(machine.axis[static_cast<std::size_t>(v.axis)].letter);
  const std::string length = rotary ? " deg" : " mm";
  if (has("jerk")) return length + "/s3";
  if (has("acceleration") || what == "curvature step") return length + "/s2";
  const bool speed = has("speed") || has("feed") || has("rest at") || has("peak") || has("diagram") ||
                     what == "junction" || what == "technology point";
  return speed && what != "rest at a stop" ? length + "/s" : length;
}

/// Whether two numbers are to be the same, rather than one below the other.
bool is_equality(std::string_view what) {
  return what.starts_with("continuity") || what.starts_with("table") || what.starts_with("length") ||
         what == "start" || what == "duration" || what == "gap in time" || what == "path without law" ||
         what == "pause" || what.starts_with("time of");
}

/// "part.ngc:12: axis acceleration of X is 39991 mm/s2, allowed 2500 mm/s2, at 1.5 s and 20 of 38 mm of path"
std::string violation_text(const planner::Violation& v, const JobInputs& given, const SourceSet& sources,
                           const planner::Path& path, const planner::MotionLaw& law) {
  const machine::MachineModel& machine = given.machine.model;
  std::string place = sources[given.program].name();
  double at_u = 0;
  if (v.segment < path.size()) {
    const Span& span = path.segments[v.segment].span;
    place = fmt::format("{}:{}", sources[span.file].name(), span.line);
    at_u = path.start_s_u[v.segment];
  }
  if (!law.pieces.empty()) {
    std::size_t hint = 0;
    at_u = law.eval(std::clamp(v.time_s, 0.0, law.duration_s), hint).s_u;
  }
  std::string what = v.what;
  if (v.axis >= 0) what += fmt::format(" of {}", machine.axis[static_cast<std::size_t>(v.axis)].letter);
  const std::string unit = unit_of(v, machine);
  return fmt::format(
      "a plan keeps path and machine: {}: {} is {:.10g}{}, {} {:.10g}{}, at {:.6f} s and "
      "{:.6g} of {:.6g} mm of path",
      place, what, v.value, unit, is_equality(v.what) ? "expected" : "allowed", v.limit, unit, v.time_s, at_u,
      path.length_u());
}

}  // namespace

void require_sound_plan(const JobInputs& given, const SourceSet& sources, const ReadProgram& read,
                        const planner::FeedPlan& plan) {
  const machine::MachineModel& machine = given.machine.model;
  const auto found =
      planner::verify(read.path, plan, machine, planner::production_check(), pauses(read.events, machine));
  if (!found.empty()) throw BrokenPromise(violation_text(found.front(), given, sources, read.path, plan.law));
}

}  // namespace kadr::cycle
