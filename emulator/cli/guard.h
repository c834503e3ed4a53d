#pragma once
#include <functional>
#include <string>

namespace kadr::cli {

/// Runs the work of a program and turns what it throws into a message on standard error and an exit code: the
/// world's faults (WorldError, std::system_error, no memory) into 2, anything else into 70 with a line that
/// reproduces it.
int guarded(int argc, const char* const* argv, const std::function<int()>& work);

/// The command line as one can paste it into a shell.
std::string shell_line(int argc, const char* const* argv);

}  // namespace kadr::cli
