#pragma once
#include <functional>
#include <string>

namespace kadr::cli {

/// Runs the work of a program and turns exceptions into a message on standard error and an exit code:
/// I/O errors (WorldError, std::system_error, no memory) into 2, anything else into 70
/// with a line that reproduces it.
int guarded(int argc, const char* const* argv, const std::function<int()>& work);

/// The command line, quoted so that it can be pasted into a shell (bash or zsh, where a word holds what a terminal may
/// not be shown).
std::string shell_line(int argc, const char* const* argv);

}  // namespace kadr::cli
