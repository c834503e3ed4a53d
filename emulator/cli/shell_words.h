#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "emulator/cli/command_tree.h"

/// Common parts of the scripts for the three shells.
namespace kadr::cli {

/// " machine show" of "kadr machine show", "" of "kadr": the words that a script has read so far.
std::string shell_path(const Command& command);
/// " run check plan ...": the commands that may follow.
std::string command_words(const Command& command);
/// "' machine show'" of every command below `kadr`, in its order.
std::vector<std::string> command_paths(const Command& kadr);
/// One line in single quotes, for every shell.
/// @param special  characters before which a backslash goes
std::string shell_quoted(std::string_view text, std::string_view special = {});

}  // namespace kadr::cli
