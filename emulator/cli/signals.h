#pragma once
#include <atomic>

namespace kadr::cli {

/// While it lives, SIGINT and SIGTERM end the program at once, and from hold() on only set a flag, so that a log can be
/// closed; a second one ends the program at once. One at a time.
class SignalGuard {
 public:
  SignalGuard();
  void hold();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
  ~SignalGuard();
  const std::atomic<bool>* flag() const;
  /// Number of the signal that came, 0 if none did.
  int signal() const;
};

/// Writing to a closed pipe or past a file size limit becomes an error of the write instead of the program's end.
void ignore_write_signals();

}  // namespace kadr::cli
