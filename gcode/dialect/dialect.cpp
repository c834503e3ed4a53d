#include "gcode/dialect/dialect.h"

#include <array>

#include "gcode/dialect/codes.h"

namespace kadr::gcode {
namespace {

constexpr double kMillisecond_s = 1e-3;
constexpr std::array<DwellWord, 1> kSeconds = {{{'P', 1}}};
constexpr std::array<DwellWord, 1> kMilliseconds = {{{'P', kMillisecond_s}}};
constexpr std::array<DwellWord, 2> kMarlinDwell = {{{'S', 1}, {'P', kMillisecond_s}}};
constexpr std::array<DwellWord, 3> kFanucDwell = {{{'X', 1}, {'U', 1}, {'P', kMillisecond_s}}};

constexpr DialectRules kLinuxCnc{.dwell_words = kSeconds, .finds_subs_of_other_files = false};
constexpr DialectRules kGrbl{.dwell_words = kSeconds, .offset_outside_plane_ignored = true};
constexpr DialectRules kMach3{
    .dwell_words = kMilliseconds, .offset_outside_plane_ignored = true, .call_shares_line = true};
constexpr DialectRules kMarlin{
    .dwell_words = kMarlinDwell, .offset_outside_plane_ignored = true, .cubic_g5_from_zero = true};
constexpr DialectRules kFanuc{.dwell_words = kFanucDwell,
                              .repeats_in_p = true,
                              .call_shares_line = true,
                              .macros = {.on = true, .angles_to_360 = true, .returns_to_number = true}};
constexpr DialectRules kHaas{
    .dwell_words = kMilliseconds,
    .call_shares_line = true,
    .macros = {.on = true, .local_subs = true, .then_runs_words = true, .diameters_in_offsets = true}};

constexpr std::int64_t kProgramNumbers = 10'000;  // four digits

/// A code of a dialect that RS-274/NGC writes differently; G codes in tenths.
struct Meaning {
  Dialect dialect;
  char letter;
  int written;
  int meant;
};
constexpr Meaning kMeanings[] = {
    {Dialect::fanuc, 'G', 700, code::g20},
    {Dialect::fanuc, 'G', 710, code::g21},
};

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
    case Dialect::fanuc:
      return kFanuc;
    case Dialect::haas:
      return kHaas;
  }
  return kLinuxCnc;
}

int meant_code(Dialect dialect, char letter, int number) {
  for (const Meaning& meaning : kMeanings)
    if (meaning.dialect == dialect && meaning.letter == letter && meaning.written == number)
      return meaning.meant;
  return number;
}

SubprogramCall subprogram_call(Dialect dialect, std::int64_t p) {
  const std::int64_t repeats = rules_of(dialect).repeats_in_p ? p / kProgramNumbers : 0;
  if (repeats == 0) return {p, 1};
  return {p % kProgramNumbers, static_cast<std::uint64_t>(repeats)};
}

}  // namespace kadr::gcode
