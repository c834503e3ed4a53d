#include "emulator/cli/output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "emulator/cli/console.h"

namespace kadr::cli {

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), part_(path_ + ".part"), file_(std::fopen(part_.c_str(), "w")) {
  if (!file_) fail();
}

OutputFile::~OutputFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(part_.c_str());
}

void OutputFile::fail() { throw WorldError(fmt::format("{}: {}", path_, std::strerror(errno))); }

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
}

void OutputFile::close() {
  std::FILE* file = std::exchange(file_, nullptr);
  if (std::fclose(file) == 0 && std::rename(part_.c_str(), path_.c_str()) == 0) return;
  const int reason = errno;
  std::remove(part_.c_str());
  errno = reason;
  fail();
}

}  // namespace kadr::cli
