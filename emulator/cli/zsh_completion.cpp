#include <fmt/format.h>

#include <algorithm>

#include "emulator/cli/command_tree.h"
#include "emulator/cli/shell_words.h"

/// One function for each command, in the terms of zsh's own _arguments.
namespace kadr::cli {
namespace {

/// These characters end a part of an _arguments specification.
constexpr std::string_view kZshSpecial = ":[]\\";

/// "_kadr_machine_show"
std::string function_name(const Command& command) {
  std::string name = '_' + command.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Completion of a value or an operand: an action of _arguments, inside single quotes.
std::string zsh_action(const Completion& c) {
  std::string words;
  for (const std::string& word : c.words) words += ' ' + word;
  const bool waits = !c.words.empty() && c.words.front().ends_with('=');
  if (waits) return fmt::format("{{compadd -S \"\" --{}}}", words);
  const std::string files = c.folders             ? "_files -/"
                            : !c.files            ? ""
                            : c.extension.empty() ? "_files"
                                                  : fmt::format("_files -g \"*.{}\"", c.extension);
  if (words.empty()) return files.empty() ? " " : files;
  if (files.empty()) return fmt::format("({})", words.substr(1));
  return fmt::format("{{compadd --{}; {}}}", words, files);
}

/// An option of two names excludes itself; one that may be given again is marked by a star.
std::string zsh_specifications(const CommandOption& o) {
  std::string out;
  const std::string before = o.repeatable ? "*" : fmt::format("({})", fmt::join(o.names, " "));
  for (const std::string& name : o.names) {
    const bool with_value = !o.value.empty();
    out += fmt::format(" \\\n    '{}'{}", before, name);
    if (with_value && name.starts_with("--")) out += '=';
    std::string text = shell_quoted(o.text, kZshSpecial);
    out += fmt::format("'[{}]", text.substr(1, text.size() - 2));
    if (with_value) out += fmt::format(":{}:{}", o.value, zsh_action(o.completion));
    out += '\'';
  }
  return out;
}

void add_zsh_operands(const Command& command, std::string& out) {
  for (std::size_t i = 0; i < command.operands.size(); ++i) {
    const CommandOption& o = command.operands[i];
    const std::string place = o.repeatable ? "*" : std::to_string(i + 1);
    out += fmt::format(" \\\n    '{}:{}:{}'", place, o.names.front(), zsh_action(o.completion));
  }
}

void add_zsh_group(const Command& command, std::string& out) {
  out += "  local curcontext=$curcontext state line\n  local -a commands=(\n";
  for (const Command& sub : command.commands)
    out += fmt::format("    {}\n", shell_quoted(sub.last_word() + ':' + sub.text));
  out += "  )\n  _arguments -C";
  for (const CommandOption& o : command.options) out += zsh_specifications(o);
  out += " \\\n    '1: :->command' '*:: :->rest' && return\n  case $state in\n";
  out += fmt::format("    command) _describe -t commands '{} command' commands ;;\n", command.name);
  out += "    rest)\n      case $words[1] in\n";
  for (const Command& sub : command.commands)
    out += fmt::format("        {}) {} ;;\n", sub.last_word(), function_name(sub));
  out += "      esac\n      ;;\n  esac\n";
}

void add_zsh_command(const Command& command, std::string& out) {
  for (const Command& sub : command.commands) add_zsh_command(sub, out);
  out += fmt::format("{}() {{\n", function_name(command));
  if (!command.commands.empty()) {
    add_zsh_group(command, out);
  } else {
    out += "  _arguments -s";
    for (const CommandOption& o : command.options) out += zsh_specifications(o);
    add_zsh_operands(command, out);
    out += '\n';
  }
  out += "}\n\n";
}

}  // namespace

std::string zsh_completion(const Command& kadr) {
  std::string out =
      "#compdef kadr\n# Completes kadr's command line in zsh. Written by `kadr completion zsh`.\n\n";
  add_zsh_command(kadr, out);
  // found by name in $fpath it is called for a completion; sourced it registers itself
  return out + "if [[ $funcstack[1] == _kadr ]]; then\n  _kadr \"$@\"\nelse\n  compdef _kadr kadr\nfi\n";
}

}  // namespace kadr::cli
