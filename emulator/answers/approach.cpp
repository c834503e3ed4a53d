#include "emulator/answers/approach.h"

#include <fmt/format.h>

#include "emulator/text/text.h"

namespace kadr::answers {

std::optional<ApproachRow> approach_row(const cycle::Job& job) {
  if (!job.read.approach) return std::nullopt;
  ApproachRow row;
  row.line = job.read.approach->span.line;
  row.ways = std::get<gcode::Approach>(job.read.approach->action).ways;
  if (const std::size_t segments = job.read.path.approach_size(); segments > 0)
    row.time_s = job.planned.plan.segments[segments - 1].end_time_s;
  return row;
}

std::string ways_text(const std::vector<std::string>& ways) {
  std::string out;
  for (const std::string& axes : ways) {
    if (!out.empty()) out += ", then";
    for (const char letter : axes) out += fmt::format("{}{}", out.empty() ? "" : " ", letter);
  }
  return out.empty() ? "no axis moves" : out;
}

std::string approach_text(const ApproachRow& row) {
  return fmt::format("{}   {}, to where line {} begins", text::duration_text(row.time_s), ways_text(row.ways),
                     row.line);
}

}  // namespace kadr::answers
