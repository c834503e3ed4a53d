#pragma once
#include <string>

#include "emulator/cli/console.h"
#include "emulator/log/log_reader.h"

namespace kadr::cli {

/// Says why a log can't be read. @return the exit code: a log whose summary denies its numbers is an answer
int unreadable_log(const log::LogReadError& error, Console& console);

/// Says what of a log of a newer kadr was passed over: a note for each channel.
void note_passed_over(const std::string& path, const log::LogEnd& end, Console& console);

}  // namespace kadr::cli
