#include "emulator/cli/standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <string>

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

void print_result(std::string_view text) { print_gathered(shown_text(text)); }

void print_gathered(std::string_view bytes) {
  if (write_all(STDOUT_FILENO, bytes)) return;
  const int reason = errno;
  if (reason == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  throw WorldError(fmt::format("standard output: {}", std::strerror(reason)));
}

void tell(std::string_view text, Styles styles) noexcept {
  try {
    // what needs no change needs no memory either
    if (shown_bytes(text) == text.size())
      write_all(STDERR_FILENO, text);
    else
      write_all(STDERR_FILENO, shown_text(text, styles));
  } catch (const std::bad_alloc&) {
    // the message is lost
  }
}

void tell_line(std::string_view text) noexcept {
  try {
    tell(fmt::format("kadr: {}\n", displayable(text)));
  } catch (const std::bad_alloc&) {
    // the message is lost
  }
}

void tell_over(std::string_view text) noexcept {
  try {
    // back to the line's beginning; behind the text, erase to its end
    write_all(STDERR_FILENO, fmt::format("\r{}\x1b[K", displayable(text)));
  } catch (const std::bad_alloc&) {
    // the line is lost
  }
}

}  // namespace kadr::cli
