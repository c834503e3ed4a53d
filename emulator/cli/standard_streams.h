#pragma once
#include <string_view>

namespace kadr::cli {

/// Puts something behind standard input, output and error if the parent left them closed, so that no file of ours gets
/// their numbers. Reading and writing there fails, as it would have.
void open_missing_streams();

/// Writes results to standard output at once.
/// @throws WorldError when they can't be written; a reader that has closed the pipe ends the program by SIGPIPE, as it
///         ends every filter
void print_result(std::string_view text);

/// Writes a message to standard error. If that can't be written the message is lost, and nothing else.
void tell(std::string_view text) noexcept;

}  // namespace kadr::cli
