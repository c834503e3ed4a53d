#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kadr {

/// Stable number of a diagnostic, printed as K2107. Never reused. Ranges: K1xxx reading, K2xxx geometry,
/// K3xxx machine and scenario files, K4xxx planning and limits, K5xxx motion and plant, K9xxx internal.
/// Each is listed once, in machine/base/codes/<range>.inc, as KADR_CODE(number, name, title, long text).
enum class Code : std::uint16_t {
#define KADR_CODE(number, name, title, explanation) name = number,
#include "machine/base/codes/compensation.inc"
#include "machine/base/codes/curves.inc"
#include "machine/base/codes/cycles.inc"
#include "machine/base/codes/files.inc"
#include "machine/base/codes/flow.inc"
#include "machine/base/codes/functions.inc"
#include "machine/base/codes/geometry.inc"
#include "machine/base/codes/internal.inc"
#include "machine/base/codes/motion.inc"
#include "machine/base/codes/planning.inc"
#include "machine/base/codes/reading.inc"
#undef KADR_CODE
};

struct CodeEntry {
  Code code;
  std::string_view name;         ///< identifier, snake_case
  std::string_view title;        ///< headline of the diagnostic, lower case, no full stop
  std::string_view explanation;  ///< what `kadr explain` prints: cause, example, what to do
};

/// All codes in ascending order.
std::span<const CodeEntry> all_codes();
const CodeEntry& code_entry(Code code);
/// "K2107"
std::string code_name(Code code);
/// Reads "K2107" or "2107"; nothing if there is no such code.
std::optional<Code> parse_code(std::string_view text);

}  // namespace kadr
