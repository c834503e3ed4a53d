#include "emulator/cli/guard.h"

#include <fmt/format.h>

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
  try {
    return work();
  } catch (const WorldError& e) {
    tell_line(e.what());
    return kNotStarted;
  } catch (const BrokenPromise& e) {
    return report_fault(e.what(), argc, argv);
  } catch (const std::system_error& e) {
    tell_line(e.what());
    return kNotStarted;
  } catch (const std::bad_alloc&) {
    tell("kadr: out of memory\n");
    return kNotStarted;
  } catch (const std::exception& e) {
    return report_fault(e.what(), argc, argv);
  }
}

}  // namespace kadr::cli
