#include "gcode/dialect/dialect.h"

#include <array>

#include "gcode/dialect/codes.h"

namespace kadr::gcode {
namespace {

constexpr double kMillisecond_s = 1e-3;
constexpr std::array<DwellWord, 1> kSeconds = {{{'P', 1}}};
constexpr std::array<DwellWord, 2> kMarlin = {{{'S', 1}, {'P', kMillisecond_s}}};
constexpr std::array<DwellWord, 3> kFanuc = {{{'X', 1}, {'U', 1}, {'P', kMillisecond_s}}};
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

std::span<const DwellWord> dwell_words(Dialect dialect) {
  switch (dialect) {
    case Dialect::marlin:
      return kMarlin;
    case Dialect::fanuc:
      return kFanuc;
    case Dialect::linuxcnc:
    case Dialect::grbl:
      break;
  }
  return kSeconds;
}

bool offset_outside_plane_is_ignored(Dialect dialect) {
  switch (dialect) {
    case Dialect::grbl:
    case Dialect::marlin:
      return true;
    case Dialect::linuxcnc:
    case Dialect::fanuc:
      break;
  }
  return false;
}

int meant_code(Dialect dialect, char letter, int number) {
  for (const Meaning& meaning : kMeanings)
    if (meaning.dialect == dialect && meaning.letter == letter && meaning.written == number)
      return meaning.meant;
  return number;
}

SubprogramCall subprogram_call(Dialect dialect, std::int64_t p) {
  const std::int64_t repeats = dialect == Dialect::fanuc ? p / kProgramNumbers : 0;
  if (repeats == 0) return {p, 1};
  return {p % kProgramNumbers, static_cast<std::uint64_t>(repeats)};
}

}  // namespace kadr::gcode
