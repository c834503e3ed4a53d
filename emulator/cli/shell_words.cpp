#include "emulator/cli/shell_words.h"

namespace kadr::cli {

std::string shell_path(const Command& command) {
  const auto blank = command.name.find(' ');
  return blank == std::string::npos ? std::string() : command.name.substr(blank);
}

std::string command_words(const Command& command) {
  std::string out;
  for (const Command& sub : command.commands) out += ' ' + sub.last_word();
  return out;
}

std::vector<std::string> command_paths(const Command& kadr) {
  std::vector<std::string> out;
  for (const Command& sub : kadr.commands) {
    out.push_back('\'' + shell_path(sub) + '\'');
    const std::vector<std::string> below = command_paths(sub);
    out.insert(out.end(), below.begin(), below.end());
  }
  return out;
}

std::string shell_quoted(std::string_view text, std::string_view special) {
  std::string out = "'";
  bool blank = false;
  for (const char c : text) {
    // line ends and indentation of a help text are one blank
    const bool now = c == ' ' || c == '\n';
    if (now && blank) continue;
    blank = now;
    if (special.find(c) != std::string_view::npos) out += '\\';
    if (now)
      out += ' ';
    else if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + '\'';
}

}  // namespace kadr::cli
