#include <variant>

#include "emulator/cli/arguments.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/console.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/guard.h"
#include "emulator/cli/signals.h"

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
    case Command::fmt:
      return format_programs(arguments, console);
    case Command::diff:
      return diff_logs(arguments, console);
    case Command::tube:
      return solve_tube(arguments, console);
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
    case Command::scenario_check:
      return scenario_check(arguments, console);
    case Command::scenario_list:
      return scenario_list(arguments, console);
    case Command::wind:
      return write_winding(arguments, console);
    case Command::version:
      return print_version(arguments, console);
  }
  return kInternal;
}

int work(int argc, const char* const* argv) {
  const auto read = read_arguments(argc, argv);
  if (const int* code = std::get_if<int>(&read)) return *code;
  const Arguments& arguments = std::get<Arguments>(read);
  Console console(arguments.output);
  const int code = dispatch(arguments, console);
  console.finish(code);
  return code;
}

}  // namespace
}  // namespace kadr::cli

int main(int argc, char** argv) {
  kadr::cli::ignore_write_signals();
  return kadr::cli::guarded(argc, argv, [&] { return kadr::cli::work(argc, argv); });
}
