#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/options.h"

/// `kadr man` and `kadr completion`: texts that a package installs for man(1) and the shells.
namespace kadr::cli {
namespace {

struct Shell {
  const char* name;
  std::string (*completion)(const Command& kadr);
};
constexpr Shell kShells[] = {{"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}};

}  // namespace

void add_shell_commands(Options& o) {
  CLI::App* man = o.command(o.app, "man", print_manual, "Print the manual page, for `man -l -`");
  man->footer("Example: kadr man | man -l -");
  CLI::App* completion =
      o.command(o.app, "completion", print_completion,
                "Print a script that completes commands, options and values in bash, zsh or fish");
  std::vector<std::string> names;
  for (const Shell& shell : kShells) names.emplace_back(shell.name);
  CLI::Option* shell = completion->add_option("SHELL", o.arguments.files, "bash, zsh or fish");
  shell->required()->expected(1)->type_name("");
  o.words(shell, names);
  shell->check([names](const std::string& text) {
    return std::find(names.begin(), names.end(), text) != names.end()
               ? std::string()
               : fmt::format("one of {}; got '{}'", fmt::join(names, ", "), text);
  });
  completion->footer("Example: source <(kadr completion bash)");
}

int print_manual(const Arguments&, Console& console) {
  console.data(manual_page(command_tree()));
  return kYes;
}

int print_completion(const Arguments& arguments, Console& console) {
  for (const Shell& shell : kShells)
    if (arguments.files.front() == shell.name) console.data(shell.completion(command_tree()));
  return kYes;
}

}  // namespace kadr::cli
