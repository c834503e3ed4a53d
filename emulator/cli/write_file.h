#pragma once
#include <string>
#include <string_view>

namespace kadr::cli {

/// Writes a whole text to a file.
/// @param overwrite false: an existing file is refused, and the message names --force
/// @throws WorldError with path and reason
void write_file(const std::string& path, std::string_view text, bool overwrite = true);

}  // namespace kadr::cli
