#pragma once
#include <string>
#include <vector>

/// The command line's own definitions as plain data: the manual page and the shells' completions are made
/// from it, so that they agree with `kadr --help`.
namespace kadr::cli {

/// Allowed values of an option or operand.
struct Completion {
  std::vector<std::string> words;  ///< from a vocabulary; one that ends in `=` waits for its value
  bool files = false;              ///< names of files, and folders on the way
  bool folders = false;            ///< names of folders alone
  std::string extension;           ///< of the files, without the point; empty: any
};

/// An option, or an operand (its name is in capitals then).
struct CommandOption {
  std::vector<std::string> names;  ///< "-m", "--machine"
  std::string value;               ///< "FILE|NAME"; empty: takes none
  std::string text;                ///< lines that begin with blanks stay separate
  bool required = false;
  bool repeatable = false;
  Completion completion;
};

struct Command {
  std::string name;     ///< "kadr", "kadr machine show"
  std::string text;     ///< what it does
  std::string example;  ///< a command line; empty: none
  std::string note;     ///< what `--help` says below its options, without the example
  std::vector<CommandOption> options;
  std::vector<CommandOption> operands;
  std::vector<Command> commands;
  bool needs_command = false;  ///< one of `commands` has to follow

  /// "show" of "kadr machine show"
  std::string last_word() const { return name.substr(name.rfind(' ') + 1); }
};

/// The whole command line, beginning with `kadr` itself.
Command command_tree();

/// A page for man(1).
std::string manual_page(const Command& kadr);
std::string bash_completion(const Command& kadr);
std::string zsh_completion(const Command& kadr);
std::string fish_completion(const Command& kadr);

}  // namespace kadr::cli
