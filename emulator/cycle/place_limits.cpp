#include "emulator/cycle/place_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "planner/path/path_cut.h"

namespace kadr::cycle {

void limit_places(const std::vector<PlaceLimit>& points, ReadProgram& read, Diagnostics& diagnostics) {
  const auto refuse = [&](const PlaceLimit& point, std::string label, const std::string& allowed,
                          std::string help) {
    Diagnostic d{};
    d.code = Code::scenario_technology;
    d.span = point.span;
    d.message = std::string(code_entry(d.code).title);
    d.label = std::move(label);
    if (!allowed.empty()) d.notes.push_back("allowed: " + allowed);
    d.help = std::move(help);
    diagnostics.add(std::move(d));
  };
  const bool waits = std::any_of(read.events.begin(), read.events.end(), [](const ProgramEvent& event) {
    return gcode::is<gcode::InputWait>(event.block);
  });
  for (const PlaceLimit& point : points) {
    const double begin_u = read.path.program_begin_u();
    if (read.path.size() == 0 || point.at_u > read.path.length_u() - begin_u) {
      refuse(point, fmt::format("is at {:.6g} mm of the path", point.at_u),
             fmt::format("0 to {:.6g} mm, its length", read.path.length_u() - begin_u), "");
      continue;
    }
    if (waits) {
      refuse(point, "the program waits for an input (M66)", "", "name the line of a move: at_line");
      continue;
    }
    const std::size_t before = read.path.size(), segment = planner::cut_path(read.path, begin_u + point.at_u);
    if (segment == read.path.size()) continue;  // its end, at rest
    planner::PathSegment& begins = read.path.segments[segment];
    begins.begin_limit_u_s =
        std::min(begins.begin_limit_u_s, point.max_u_s * (begins.length_u / begins.feed_length_u));
    if (read.path.size() == before) continue;
    for (ProgramEvent& event : read.events)
      if (event.after_segment >= segment) ++event.after_segment;
  }
}

}  // namespace kadr::cycle
