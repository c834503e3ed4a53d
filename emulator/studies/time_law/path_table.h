#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "machine/base/diagnostic.h"

namespace kadr::studies {

struct PathTable {
  std::vector<double> s_u;     // [rows], ascending
  std::vector<double> values;  // [rows][axes]
};

/// Reads sources[file] as the table of a path: "s,NAME,..." in any order after s, then rows of numbers.
/// Blank lines and those that begin with # are skipped.
/// @param axes  names; every one must have a column, and every column an axis
/// @return nothing if there are mistakes (in `diagnostics`, at most 20)
std::optional<PathTable> read_path_table(const SourceSet& sources, std::uint32_t file,
                                         const std::vector<std::string>& axes, Diagnostics& diagnostics);

}  // namespace kadr::studies
