#pragma once
#include <string_view>

#include "machine/base/terminal_text.h"

/// The sink: everything that reaches standard output and standard error goes through here (tools/sink forbids other ways).
/// Texts are held to what a terminal may be shown (machine/base/terminal_text.h), whoever composed them and wherever they
/// go, so that a file, a pipe and a terminal get the same. Bytes for a file stay as they are, except on a terminal.
namespace kadr::cli {

/// Puts something behind standard input, output and error if the parent left them closed, so that no file of ours gets
/// their numbers. Reading and writing there fails, as it would have.
void open_missing_streams();

/// Writes a text to standard output at once.
/// @throws WorldError when it can't be written; a reader that has closed the pipe ends the program by SIGPIPE, as it
///         ends every filter
void print_result(std::string_view text);

/// Writes what Console has gathered, held to the rule where it is text. @throws as print_result()
void print_gathered(std::string_view bytes);

/// Writes a message of one or more lines to standard error. If that can't be written the message is lost, and nothing
/// else.
void tell(std::string_view text, Styles styles = Styles::replaced) noexcept;
/// "kadr: " and the message as one line: no name of a file can break it in two.
void tell_line(std::string_view text) noexcept;

/// Shows a text instead of the line of standard error, a terminal, in which the cursor stands; empty: erases it.
void tell_over(std::string_view text) noexcept;

}  // namespace kadr::cli
