#pragma once
#include <vector>

#include "emulator/cli/console.h"
#include "machine/machine_file.h"

namespace kadr::cli {

/// Prints the keys of a kind of file, table by table; with --json one object per key. @return the exit code
int list_keys(const std::vector<machine::TableDocument>& tables, Console& console);

}  // namespace kadr::cli
