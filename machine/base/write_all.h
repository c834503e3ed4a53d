#pragma once
#include <string_view>

namespace kadr {

/// Writes all of a text to a file descriptor, waiting where it would block. @return false with errno if that fails
bool write_all(int fd, std::string_view text);

}  // namespace kadr
