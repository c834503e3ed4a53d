#pragma once
#include <cstdint>

#include "machine/base/vocabulary.h"

namespace kadr {

/// The numbers are those of KADR_DIAG.
enum class Severity : std::uint8_t { note, warning, error };

inline constexpr Vocabulary<Severity, 3> kSeverities{{
    {Severity::note, "note", "a fact"},
    {Severity::warning, "warning", "the program runs; something in it may not be meant"},
    {Severity::error, "error", "nothing moves"},
}};
static_assert(kSeverities.complete());

}  // namespace kadr
