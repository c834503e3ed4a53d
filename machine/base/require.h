#pragma once
#include <stdexcept>

namespace kadr {

/// A broken promise of kadr itself: never the user's fault. The command line prints it with "please report"
/// and exits with 70.
class BrokenPromise : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws BrokenPromise with the promise and the place.
[[noreturn]] void break_promise(const char* promise, const char* file, int line);

/// A promise of kadr's own code, checked in every build. (The defaults name the caller's place; clang 14 has the
/// built-ins but not std::source_location.)
inline void require(bool kept, const char* promise, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
  if (!kept) [[unlikely]]
    break_promise(promise, file, line);
}

}  // namespace kadr
