#include <variant>

#include "emulator/cli/arguments.h"
#include "emulator/cli/console.h"
#include "emulator/cli/guard.h"
#include "emulator/cli/signals.h"
#include "emulator/cli/standard_streams.h"
#include "machine/base/input_files.h"

namespace kadr::cli {
namespace {

int work(int argc, const char* const* argv) {
  const auto read = read_arguments(argc, argv);
  if (const int* code = std::get_if<int>(&read)) return *code;
  const Arguments& arguments = std::get<Arguments>(read);
  Console console(arguments.output);
  const int code = arguments.command(arguments, console);
  console.finish(code);
  return code;
}

}  // namespace
}  // namespace kadr::cli

int main(int argc, char** argv) {
  kadr::cli::open_missing_streams();
  kadr::cli::ignore_write_signals();
  const kadr::InputMemory inputs;
  return kadr::cli::guarded(argc, argv, [&] { return kadr::cli::work(argc, argv); });
}
