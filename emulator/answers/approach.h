#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/emulator.h"

namespace kadr::answers {

/// The way from home to the line where the program is entered (--from-line).
struct ApproachRow {
  std::uint32_t line = 0;
  double time_s = 0;  ///< as planned
  std::vector<std::string>
      ways;  ///< axes that move together, one group after the other: {"XY", "Z"}; may be empty
};

/// Nothing: the program is run from its beginning.
std::optional<ApproachRow> approach_row(const cycle::Job& job);
/// "X Y, then Z"
std::string ways_text(const std::vector<std::string>& ways);
/// "1.234 s   X Y, then Z, to where line 40 begins"
std::string approach_text(const ApproachRow& row);

}  // namespace kadr::answers
