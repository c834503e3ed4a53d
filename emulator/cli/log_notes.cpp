#include "emulator/cli/log_notes.h"

#include <fmt/format.h>

namespace kadr::cli {

void note_passed_over(const std::string& path, const log::LogEnd& end, Console& console) {
  for (const std::string& note : end.passed_over) console.note(fmt::format("{}: {}", path, note));
}

}  // namespace kadr::cli
