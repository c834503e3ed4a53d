#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>

#include "emulator/cli/arguments.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/console.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/signals.h"
#include "machine/base/require.h"

namespace kadr::cli {
namespace {

int dispatch(const Arguments& arguments, Console& console) {
  switch (arguments.command) {
    case Command::run:
      return run_program(arguments, console);
    case Command::check:
      return check_programs(arguments, console);
    case Command::plan:
      return plan_program(arguments, console);
    case Command::canon:
      return canon_program(arguments, console);
    case Command::info:
      return log_info(arguments, console);
    case Command::machine_show:
      return machine_show(arguments, console);
    case Command::machine_list:
      return machine_list(arguments, console);
    case Command::machine_check:
      return machine_check(arguments, console);
    case Command::machine_new:
      return machine_new(arguments, console);
    case Command::explain:
      return explain_codes(arguments, console);
    case Command::scenario_run:
      return scenario_run(arguments, console);
    case Command::scenario_list:
      return scenario_list(arguments, console);
    case Command::version:
      return print_version(arguments, console);
  }
  return kInternal;
}

/// The command line as one can paste it into a shell.
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
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

int report_fault(const char* what, int argc, const char* const* argv) {
  fmt::print(stderr,
             "kadr: this is a fault of kadr, not of your files; please report it\n"
             "  promise:   {}\n"
             "  version:   {}\n"
             "  reproduce: {}\n",
             what, KADR_VERSION, shell_line(argc, argv));
  return kInternal;
}

int guarded(int argc, const char* const* argv) {
  try {
    const auto read = read_arguments(argc, argv);
    if (const int* code = std::get_if<int>(&read)) return *code;
    const Arguments& arguments = std::get<Arguments>(read);
    Console console(arguments.output);
    const int code = dispatch(arguments, console);
    console.flush();
    return code;
  } catch (const WorldError& e) {
    fmt::print(stderr, "kadr: {}\n", e.what());
    return kNotStarted;
  } catch (const BrokenPromise& e) {
    return report_fault(e.what(), argc, argv);
  } catch (const std::system_error& e) {
    fmt::print(stderr, "kadr: {}\n", e.what());
    return kNotStarted;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "kadr: out of memory\n");
    return kNotStarted;
  } catch (const std::exception& e) {
    return report_fault(e.what(), argc, argv);
  }
}

}  // namespace
}  // namespace kadr::cli

int main(int argc, char** argv) {
  kadr::cli::ignore_write_signals();
  return kadr::cli::guarded(argc, argv);
}
