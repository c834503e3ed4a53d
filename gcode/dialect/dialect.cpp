#include "gcode/dialect/dialect.h"

#include <array>

namespace kadr::gcode {
namespace {

constexpr double kMillisecond_s = 1e-3;
constexpr std::array<DwellWord, 1> kSeconds = {{{'P', 1}}};
constexpr std::array<DwellWord, 1> kMilliseconds = {{{'P', kMillisecond_s}}};
constexpr std::array<DwellWord, 2> kMarlinDwell = {{{'S', 1}, {'P', kMillisecond_s}}};
constexpr std::array<DwellWord, 3> kFanucDwell = {{{'X', 1}, {'U', 1}, {'P', kMillisecond_s}}};

constexpr DialectRules kLinuxCnc{.dwell_words = kSeconds, .finds_subs_of_other_files = false};

/// grbl/protocol.c (comments, $, length of a line), grbl/gcode.c (words, arcs, state at start) of Grbl 1.1h; the
/// remarks behind % are FluidNC's.
constexpr DialectRules kGrbl{.name = "grbl 1.1",
                             .text = {.comment_ends_at_first = true,
                                      .controller_lines = true,
                                      .percent_remarks = true,
                                      .expressions = false,
                                      .line_characters = 79},
                             .dwell_words = kSeconds,
                             .offset_outside_plane_ignored = true,
                             .arc_needs_end = true,
                             .begins_with_rapid = true,
                             .begins_in_mm = true,
                             .largest_tool = 255};

/// Using Mach3Mill, the chapter of the G and M code language: modal groups, G codes, M codes. Dwells are in milliseconds
/// unless the configuration says seconds.
constexpr DialectRules kMach3{.name = "Mach3",
                              .text = {.comment_ends_at_first = true},
                              .dwell_words = kMilliseconds,
                              .cycle_dwell_s = kMillisecond_s,
                              .offset_outside_plane_ignored = true,
                              .call_shares_line = true,
                              .begins_with_rapid = true,
                              .keeps_group_1 = true,
                              .bare_arc_sets_mode = true,
                              .radius_in_p = true,
                              .probe_in_2000 = true};

/// marlinfw.org, G-code index: G0 and G1 are one code; queue.cpp (checksums), parser.cpp (texts, letters without values).
constexpr DialectRules kMarlin{.name = "Marlin",
                               .text = {.checksums = true, .text_codes = true, .bare_letters = true},
                               .dwell_words = kMarlinDwell,
                               .cycle_dwell_s = kMillisecond_s,
                               .offset_outside_plane_ignored = true,
                               .cubic_g5_from_zero = true,
                               .begins_in_mm = true,
                               .homes_directly = true,
                               .rapid_at_feed_mm_min = 1500,
                               .extruder = true};

/// docs.duet3d.com, GCode dictionary: G0 at F as G1 but in CNC mode (M453); 3000 mm/min before the first F.
constexpr DialectRules kRepRap{.name = "RepRapFirmware",
                               .text = {.checksums = true, .text_codes = true, .bare_letters = true},
                               .dwell_words = kMarlinDwell,
                               .cycle_dwell_s = kMillisecond_s,
                               .offset_outside_plane_ignored = true,
                               .cubic_g5_from_zero = true,
                               .begins_in_mm = true,
                               .homes_directly = true,
                               .rapid_at_feed_mm_min = 3000,
                               .extruder = true};

/// Operator's manual of the series 0i and 30i for machining centres: groups of G codes, dwell (G04), reference position
/// (G28), additional work systems (G54.1), canned cycles, rigid and peck tapping.
constexpr DialectRules kFanuc{.name = "Fanuc",
                              .text = {.corners = true},
                              .dwell_words = kFanucDwell,
                              .cycle_dwell_s = kMillisecond_s,
                              .repeats_in_p = true,
                              .repeats_in_k = true,
                              .taps_peck = true,
                              .call_shares_line = true,
                              .begins_with_rapid = true,
                              .begins_with_g98 = true,
                              .keeps_group_1 = true,
                              .bare_arc_sets_mode = true,
                              .home_beside_motion = true,
                              .further_systems = 300,
                              .macros = {.on = true, .angles_to_360 = true, .returns_to_number = true}};

/// Mill operator's manual 96-8210, chapters G codes (G04, G73 to G89, G110, G154, G187) and M codes.
constexpr DialectRules kHaas{
    .name = "Haas",
    .text = {.corners = true},
    .dwell_words = kMilliseconds,
    .cycle_dwell_s = kMillisecond_s,
    .point_means_seconds = true,
    .repeats_in_k = true,
    .taps_peck = true,
    .call_shares_line = true,
    .begins_with_rapid = true,
    .begins_with_g98 = true,
    .keeps_group_1 = true,
    .bare_arc_sets_mode = true,
    .home_beside_motion = true,
    .further_systems = 99,
    .macros = {.on = true, .local_subs = true, .then_runs_words = true, .diameters_in_offsets = true}};

constexpr std::int64_t kProgramNumbers = 10'000;  // four digits

}  // namespace

const DialectRules& rules_of(Dialect dialect) {
  switch (dialect) {
    case Dialect::linuxcnc:
      return kLinuxCnc;
    case Dialect::grbl:
      return kGrbl;
    case Dialect::mach3:
      return kMach3;
    case Dialect::marlin:
      return kMarlin;
    case Dialect::reprap:
      return kRepRap;
    case Dialect::fanuc:
      return kFanuc;
    case Dialect::haas:
      return kHaas;
  }
  return kLinuxCnc;
}

SubprogramCall subprogram_call(Dialect dialect, std::int64_t p) {
  const std::int64_t repeats = rules_of(dialect).repeats_in_p ? p / kProgramNumbers : 0;
  if (repeats == 0) return {p, 1};
  return {p % kProgramNumbers, static_cast<std::uint64_t>(repeats)};
}

}  // namespace kadr::gcode
