#include "emulator/cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "emulator/cli/exit_codes.h"
#include "emulator/cli/options.h"
#include "emulator/cli/standard_streams.h"
#include "emulator/cli/usage.h"

namespace kadr::cli {
namespace {

class Reader {
 public:
  Reader() : app_("kadr runs a control program on a simulated machine, exactly and repeatably.", "kadr") {
    app_.require_subcommand(1);
    app_.formatter(help_formatter());
    std::string codes;
    for (const ExitCode& c : kExitCodes)
      codes += fmt::format("{}{} {}", codes.empty() ? "" : c.code == "3" ? ",\n" : ", ", c.code, c.meaning);
    app_.footer(
        fmt::format("`kadr COMMAND --help` shows details. `-` is standard input. Data go to standard output, "
                    "messages to standard\nerror. Exit codes: {}.",
                    codes));
    app_.set_version_flag("--version", "kadr " KADR_VERSION);
    add_program_commands(options_);
    add_log_commands(options_);
    add_law_commands(options_);
    add_machine_commands(options_);
    add_teach_commands(options_);
    add_shell_commands(options_);
  }

  Command tree() const { return describe_commands(options_); }

  std::variant<Arguments, int> read(std::vector<std::string> words) {
    const bool help = !words.empty() && words.front() == "help";
    if (help) words.erase(words.begin());
    if (const std::string mistake = help ? unknown_command(app_, words) : usage_mistake(app_, words);
        !mistake.empty()) {
      tell(fmt::format("{}\nsee {} --help\n", displayable(mistake), mistake.substr(0, mistake.find(':'))));
      return kNotStarted;
    }
    try {
      if (help) words.emplace_back("--help");
      std::reverse(words.begin(), words.end());  // as CLI11 takes them
      app_.parse(std::move(words));
    } catch (const CLI::CallForHelp&) {
      const CLI::App* asked = &app_;
      std::string before;
      while (!asked->get_subcommands().empty()) {
        before += (before.empty() ? "" : " ") + asked->get_name();
        asked = asked->get_subcommands().front();
      }
      print_result(asked->help(before));
      return kYes;
    } catch (const CLI::Success& e) {
      print_result(fmt::format("{}\n", e.what()));
      return kYes;
    } catch (const CLI::ParseError& e) {
      const CLI::App* asked = &app_;
      std::string name = "kadr";
      while (!asked->get_subcommands().empty()) {
        asked = asked->get_subcommands().front();
        name += ' ' + asked->get_name();
      }
      std::string complaint = e.what();
      if (const std::string names = command_names(*asked); !names.empty())
        complaint = "which command? " + names;
      tell(fmt::format("{}: {}\nsee {} --help\n", name, displayable(complaint), name));
      return kNotStarted;
    }
    return arguments_;
  }

 private:
  static std::string command_names(const CLI::App& app) {
    std::string names;
    for (const CLI::App* sub : app.get_subcommands({}))
      names += (names.empty() ? "" : ", ") + sub->get_name();
    return names;
  }
  CLI::App app_;
  Arguments arguments_;
  Options options_{app_, arguments_};
};

}  // namespace

std::variant<Arguments, int> read_arguments(int argc, const char* const* argv) {
  return Reader().read({argv + std::min(argc, 1), argv + argc});
}

Command command_tree() { return Reader().tree(); }

}  // namespace kadr::cli
