#pragma once
#include <source_location>
#include <stdexcept>

namespace kadr {

/// Our own broken promise: never the user's fault. The command line prints it with "please report" and exits with 70.
class BrokenPromise : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws BrokenPromise with the promise and the place.
[[noreturn]] void break_promise(const char* promise, std::source_location where);

/// A promise of our own code, checked in every build.
inline void require(bool kept, const char* promise,
                    std::source_location where = std::source_location::current()) {
  if (!kept) [[unlikely]] break_promise(promise, where);
}

}  // namespace kadr
