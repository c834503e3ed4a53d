#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <functional>
#include <string>
#include <tl/expected.hpp>

#include "emulator/cli/arguments.h"
#include "emulator/cli/command_tree.h"
#include "machine/base/vocabulary.h"

namespace kadr::cli {

/// Reads a whole text as a number, whatever the locale; `_` between digits is skipped as everywhere in kadr.
template <class T>
bool read_number(std::string text, T& value) {
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// The command line under construction: where its commands store what they read, and the options that several
/// of them share.
class Options {
 public:
  Options(CLI::App& application, Arguments& values) : app(application), arguments(values) {}

  CLI::App& app;
  Arguments& arguments;
  /// For options whose values are words of a vocabulary; others are completed by the name of their value.
  std::map<const CLI::Option*, Completion> completions;

  CLI::App* command(CLI::App& parent, const std::string& name, Run run, const std::string& description);

  void output(CLI::App* sub);
  void diagnostics(CLI::App* sub);
  void progress(CLI::App* sub);
  void machine(CLI::App* sub);
  enum class Writes : std::uint8_t { nothing, log };
  void reading(CLI::App* sub, Writes writes = Writes::nothing);
  void line_range(CLI::App* sub);
  /// --limit, for every command that reads programs: messages about a bound name it.
  void dialect(CLI::App* sub);
  void limits(CLI::App* sub, Writes writes = Writes::nothing);
  void allow(CLI::App* sub);
  void strict(CLI::App* sub);
  CLI::Option* programs(CLI::App* sub, const std::string& name, bool several);

  /// Values of an option that a shell may complete.
  void words(const CLI::Option* option, std::vector<std::string> list) {
    completions[option].words = std::move(list);
  }

  /// An option whose values are passed to `take`, which may reject them.
  void repeated(CLI::App* sub, const std::string& name, const char* type, const std::string& description,
                const std::function<tl::expected<void, std::string>(const std::string&)>& take);

  /// An option that takes one word of a vocabulary.
  template <class Enum, std::size_t kCount>
  CLI::Option* choice(CLI::App* sub, const std::string& name, Enum& value,
                      const Vocabulary<Enum, kCount>& vocabulary, const std::string& description) {
    std::vector<std::string> list = vocabulary.strings();
    std::sort(list.begin(), list.end());
    CLI::Option* option = sub->add_option_function<std::string>(
        name,
        [&value, &vocabulary, name, list](const std::string& text) {
          const auto found = vocabulary.find(text);
          if (!found)
            throw CLI::ValidationError(
                fmt::format("{} takes one of {}; got '{}'", name, fmt::join(list, ", "), text));
          value = *found;
        },
        description);
    words(option, std::move(list));
    return option->type_name("WORD")->group("Output");
  }

 private:
  void limit(const std::string& text, bool log);
};

/// The commands, by subject.
void add_program_commands(Options& options);
void add_log_commands(Options& options);
void add_law_commands(Options& options);
void add_machine_commands(Options& options);
void add_teach_commands(Options& options);
void add_shell_commands(Options& options);

/// The commands that were added, as plain data (emulator/cli/command_tree.h).
Command describe_commands(const Options& options);

}  // namespace kadr::cli
