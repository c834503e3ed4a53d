#include "emulator/cli/log_notes.h"

#include <fmt/format.h>

#include "emulator/cli/exit_codes.h"

namespace kadr::cli {

int unreadable_log(const log::LogReadError& error, Console& console) {
  console.error(fmt::format("{}: {}", error.path, error.reason));
  return error.fault == log::LogReadFault::altered ? kNo : kNotStarted;
}

void note_passed_over(const std::string& path, const log::LogEnd& end, Console& console) {
  for (const std::string& note : end.passed_over) console.note(fmt::format("{}: {}", path, note));
}

}  // namespace kadr::cli
