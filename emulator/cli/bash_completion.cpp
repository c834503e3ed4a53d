#include <fmt/format.h>

#include "emulator/cli/command_tree.h"
#include "emulator/cli/shell_words.h"

namespace kadr::cli {
namespace {

constexpr std::string_view kBashHead =
    R"(# Completes kadr's command line in bash. Written by `kadr completion bash`.

# words that begin as typed; one that ends in = waits for its value
_kadr_words() {
  local word
  for word in "$@"; do
    [[ $word != "$cur"* ]] || COMPREPLY+=("$word")
  done
  [[ ${#COMPREPLY[@]} -ne 1 || ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
}

# names of files with the ending $1 (none: of any file), and folders on the way
_kadr_files() {
  local name
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do COMPREPLY+=("$name"); done < <(
    compgen -d -- "$cur"
    if [[ -n ${1-} ]]; then compgen -f -X "!*.$1" -- "$cur"; else compgen -f -- "$cur"; fi | while IFS= read -r name; do
      [[ -d $name ]] || printf '%s\n' "$name"
    done
  )
}

_kadr_folders() {
  local name
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do COMPREPLY+=("$name"); done < <(compgen -d -- "$cur")
}

_kadr() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command='' i
  COMPREPLY=()
  # bash takes --option=value for three words
  if [[ $cur == '=' ]]; then
    cur=''
  elif [[ $prev == '=' ]]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
    # of --option name=value the value
    [[ $prev == -* ]] || return 0
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${COMP_WORDS[i]}" in
)";

/// Completion of a value or an operand, as commands of the script.
std::string bash_offers(const Completion& c) {
  std::string out;
  if (!c.words.empty()) out += fmt::format("_kadr_words {}; ", fmt::join(c.words, " "));
  if (c.files) out += c.extension.empty() ? "_kadr_files; " : fmt::format("_kadr_files {}; ", c.extension);
  if (c.folders) out += "_kadr_folders; ";
  return out;
}

void add_bash_command(const Command& command, std::string& out) {
  out += fmt::format("    '{}')\n", shell_path(command));
  std::string names, values;
  for (const CommandOption& o : command.options) {
    for (const std::string& name : o.names) names += ' ' + name;
    if (!o.value.empty())
      values +=
          fmt::format("        {}) {}return 0 ;;\n", fmt::join(o.names, " | "), bash_offers(o.completion));
  }
  if (!values.empty()) out += fmt::format("      case $prev in\n{}      esac\n", values);
  out += fmt::format("      if [[ $cur == -* ]]; then _kadr_words{}; return 0; fi\n", names);
  if (!command.commands.empty()) out += fmt::format("      _kadr_words{}\n", command_words(command));
  // the first operand that can be completed represents all
  for (const CommandOption& o : command.operands)
    if (const std::string text = bash_offers(o.completion); !text.empty()) {
      out += fmt::format("      {}\n", text.substr(0, text.size() - 2));
      break;
    }
  out += "      ;;\n";
  for (const Command& sub : command.commands) add_bash_command(sub, out);
}

}  // namespace

std::string bash_completion(const Command& kadr) {
  std::string out{kBashHead};
  out += fmt::format("      {}) command=\"$command ${{COMP_WORDS[i]}}\" ;;\n",
                     fmt::join(command_paths(kadr), " | "));
  out += "    esac\n  done\n  case $command in\n";
  add_bash_command(kadr, out);
  return out + "  esac\n  return 0\n}\n\ncomplete -F _kadr kadr\n";
}

}  // namespace kadr::cli
