#pragma once
#include "machine/file/table_reader.h"
#include "machine/settings.h"

namespace kadr::machine {

/// Keys of a [[technology]] table: `on`, an output's code ("M62 P1", "M63 P1", "M67 E0"), and `max_mm_s`.
TechnologyRule read_technology_rule(TableReader& keys);
/// Its `max_mm_s` alone.
double read_technology_limit(TableReader& keys);
/// "M62 P1", as in the file.
std::string technology_code(const TechnologyRule& rule);

}  // namespace kadr::machine
