#include <fmt/format.h>

#include "emulator/cli/command_tree.h"
#include "emulator/cli/shell_words.h"

namespace kadr::cli {
namespace {

constexpr std::string_view kFishSpecial = "\\";

constexpr std::string_view kFishHead =
    R"(# Completes kadr's command line in fish. Written by `kadr completion fish`.

# whether the words before the cursor name this command: __kadr_at ' machine show'
function __kadr_at -a wanted
  set -l words (commandline -opc)
  set -e words[1]
  set -l command ''
  for word in $words
    switch "$command $word"
      case )";

/// Lines that apply to one command.
std::string fish_line(const Command& command, std::string_view rest) {
  return fmt::format("complete -c kadr -n \"__kadr_at '{}'\"{}\n", shell_path(command), rest);
}

/// Options of fish's `complete` for the allowed values; with a value, nothing else is allowed.
std::string fish_offers(const Completion& c, bool value) {
  std::string out = value ? (c.files && c.extension.empty() ? " -r -F" : " -x") : "";
  if (!value && c.files && c.extension.empty()) out += " -F";
  std::string list = fmt::format("{}", fmt::join(c.words, " "));
  const auto add = [&list](const std::string& more) { list += (list.empty() ? "" : " ") + more; };
  if (c.files && !c.extension.empty()) add(fmt::format("(__fish_complete_suffix .{})", c.extension));
  if (c.folders) add("(__fish_complete_directories)");
  if (!list.empty()) out += fmt::format(" -k -a '{}'", list);
  return out;
}

void add_fish_command(const Command& command, std::string& out) {
  for (const Command& sub : command.commands)
    out += fish_line(command,
                     fmt::format(" -a {} -d {}", sub.last_word(), shell_quoted(sub.text, kFishSpecial)));
  for (const CommandOption& o : command.options) {
    std::string names;
    for (const std::string& name : o.names)
      names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!o.value.empty()) names += fish_offers(o.completion, true);
    out += fish_line(command, fmt::format("{} -d {}", names, shell_quoted(o.text, kFishSpecial)));
  }
  // the first operand that can be completed represents all
  for (const CommandOption& o : command.operands)
    if (const std::string text = fish_offers(o.completion, false); !text.empty()) {
      out += fish_line(command, text);
      break;
    }
  for (const Command& sub : command.commands) add_fish_command(sub, out);
}

}  // namespace

std::string fish_completion(const Command& kadr) {
  std::string out{kFishHead};
  out += fmt::format("{}\n        set command \"$command $word\"\n    end\n  end\n",
                     fmt::join(command_paths(kadr), " "));
  out += "  test \"$command\" = \"$wanted\"\nend\n\ncomplete -c kadr -f\n";
  add_fish_command(kadr, out);
  return out;
}

}  // namespace kadr::cli
