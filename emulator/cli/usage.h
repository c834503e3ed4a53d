#pragma once
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace kadr::cli {

/// Reads the arguments as CLI11 will, from left to right, and finds the first that no command or option
/// takes. CLI11 blames positionals for these mistakes, or reports them in another order.
/// @param arguments  without the program's name
/// @return a sentence that begins with the command ("kadr run: there is no option --form; ..."); empty: no
///         mistake of these kinds
std::string usage_mistake(const CLI::App& app, const std::vector<std::string>& arguments);

/// @param names  the words after `kadr help`: a command and its sub-commands
/// @return what is wrong with them, as usage_mistake()
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& names);

/// Help in kadr's form: no counts after names, no "Excludes".
std::shared_ptr<CLI::Formatter> help_formatter();

}  // namespace kadr::cli
