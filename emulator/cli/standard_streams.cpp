#include "emulator/cli/standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "emulator/cli/console.h"
#include "machine/base/write_all.h"

namespace kadr::cli {

void open_missing_streams() {
  // open() takes the lowest free number: in this order each stream gets its own
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    const int mode = fd == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    // a root without /dev still has a folder
    if (::open("/dev/null", mode) < 0 && ::open("/", O_PATH | O_DIRECTORY) < 0) return;
  }
}

void print_result(std::string_view text) {
  if (write_all(STDOUT_FILENO, text)) return;
  const int reason = errno;
  if (reason == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  throw WorldError(fmt::format("standard output: {}", std::strerror(reason)));
}

void tell(std::string_view text) noexcept { write_all(STDERR_FILENO, text); }

}  // namespace kadr::cli
