#include "emulator/cli/guard.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "emulator/cli/console.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/standard_streams.h"
#include "machine/base/require.h"

namespace kadr::cli {
namespace {

int report_fault(const char* what, int argc, const char* const* argv) {
  tell(
      fmt::format("kadr: this is a fault of kadr, not of your files; please report it\n"
                  "  promise:   {}\n"
                  "  version:   {}\n"
                  "  reproduce: {}\n",
                  what, KADR_VERSION, shell_line(argc, argv)));
  return kInternal;
}

std::atomic<bool> memory_ran_out = false;
std::terminate_handler terminate_before = std::abort;

/// What fails here may be swallowed by a stream, which then writes less than it was given: guarded() asks.
void note_failed_allocation() {
  memory_ran_out = true;
  throw std::bad_alloc();
}

/// Memory that ran out where nothing may be thrown, as in functions of libraries that promise so.
void end_without_memory() {
  if (memory_ran_out) {
    tell("kadr: out of memory\n");
    std::_Exit(kNotStarted);
  }
  terminate_before();
}

int out_of_memory() {
  tell("kadr: out of memory\n");
  return kNotStarted;
}

std::string quoted(std::string_view word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + '\'';
}

/// A word that a terminal may not be shown: its bytes by number.
std::string quoted_bytes(std::string_view word) {
  std::string out = "$'";
  for (const char c : word) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return out + '\'';
}

}  // namespace

std::string shell_line(int argc, const char* const* argv) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  std::string line = "kadr";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    line += ' ';
    if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) {
      line += word;
      continue;
    }
    line += displayable(word) == word ? quoted(word) : quoted_bytes(word);
  }
  return line;
}

int guarded(int argc, const char* const* argv, const std::function<int()>& work) {
  std::set_new_handler(note_failed_allocation);
  terminate_before = std::set_terminate(end_without_memory);
  try {
    const int code = work();
    return memory_ran_out ? out_of_memory() : code;
  } catch (const WorldError& e) {
    tell_line(e.what());
    return kNotStarted;
  } catch (const BrokenPromise& e) {
    return report_fault(e.what(), argc, argv);
  } catch (const std::system_error& e) {
    tell_line(e.what());
    return kNotStarted;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::exception& e) {
    return report_fault(e.what(), argc, argv);
  }
}

}  // namespace kadr::cli
