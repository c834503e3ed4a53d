#include "emulator/cli/write_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "emulator/cli/console.h"

namespace kadr::cli {

void write_file(const std::string& path, std::string_view text, bool overwrite) {
  std::FILE* file = std::fopen(path.c_str(), overwrite ? "w" : "wx");
  if (!file) {
    const int reason = errno;
    throw WorldError(fmt::format("{}: {}{}", path, std::strerror(reason),
                                 reason == EEXIST ? "; --force overwrites it" : ""));
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int write_error = errno;
  if (std::fclose(file) != 0 || !written)
    throw WorldError(fmt::format("{}: {}", path, std::strerror(written ? errno : write_error)));
}

}  // namespace kadr::cli
