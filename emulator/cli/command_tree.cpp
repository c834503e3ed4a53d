#include "emulator/cli/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "emulator/cli/options.h"
#include "machine/base/codes.h"
#include "machine/machine.h"
#include "machine/machine_file.h"

namespace kadr::cli {
namespace {

constexpr std::string_view kExample = "Example: ";

Completion files_of(std::string extension) { return {{}, true, false, std::move(extension)}; }

/// A shipped name or a machine file.
Completion machines() {
  Completion c = files_of("toml");
  for (const std::string_view name : machine::shipped_machine_names()) c.words.emplace_back(name);
  return c;
}

Completion diagnostic_codes() {
  Completion c;
  for (const CodeEntry& entry : all_codes()) c.words.push_back(code_name(entry.code));
  return c;
}

/// By the name that an option's value has in `--help`.
Completion completion_of_value(const std::string& value) {
  if (value == "FILE") return files_of("");
  if (value == "LOG") return files_of("lcmlog");
  if (value == "TABLE") return files_of("tbl");
  if (value == "DIR") return {{}, false, true, ""};
  if (value == "FILE|NAME" || value == "MACHINE") return machines();
  return {};
}

Completion completion_of_operand(const std::string& name) {
  if (name == "PROG" || name == "FILE") return files_of("");
  if (name == "LOG" || name == "A" || name == "B") return files_of("lcmlog");
  if (name == "PROBLEM" || name == "DIR") return files_of("toml");
  if (name == "MACHINE") return machines();
  if (name == "CODE") return diagnostic_codes();
  return {};
}

CommandOption describe(const CLI::Option& option, const Options& options) {
  CommandOption out;
  out.text = option.get_description();
  out.required = option.get_required();
  out.repeatable = option.get_items_expected_max() > 1;
  const auto given = options.completions.find(&option);
  if (option.get_positional()) {
    out.names = {option.get_name(true)};
    out.completion = completion_of_operand(out.names.front());
  } else {
    for (const std::string& name : option.get_snames()) out.names.push_back('-' + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    if (option.get_items_expected_max() > 0) out.value = option.get_type_name();
    out.completion = completion_of_value(out.value);
  }
  if (given != options.completions.end()) out.completion = given->second;
  return out;
}

/// Options and commands of one App; those of an option group are listed with the command it belongs to.
void gather(const CLI::App& app, const Options& options, Command& out);

Command describe(const CLI::App& app, const std::string& name, const Options& options) {
  Command out;
  out.name = name;
  out.text = app.get_description();
  // CLI11 hands the footer of `kadr` down to commands without their own
  const bool own = &app == &options.app || app.get_footer() != options.app.get_footer();
  const std::string footer = own ? app.get_footer() : std::string();
  const auto at = footer.find(kExample);
  out.note = footer.substr(0, at);
  if (at != std::string::npos) out.example = footer.substr(at + kExample.size());
  out.needs_command = app.get_require_subcommand_min() > 0;
  gather(app, options, out);
  return out;
}

void gather(const CLI::App& app, const Options& options, Command& out) {
  for (const CLI::Option* option : app.get_options()) {
    const bool hidden = option->get_group().empty();
    const bool group_help = app.get_name().empty() && option == app.get_help_ptr();
    if (hidden || group_help) continue;
    (option->get_positional() ? out.operands : out.options).push_back(describe(*option, options));
  }
  for (const CLI::App* sub : app.get_subcommands({})) {
    if (sub->get_name().empty())
      gather(*sub, options, out);
    else
      out.commands.push_back(describe(*sub, out.name + ' ' + sub->get_name(), options));
  }
}

}  // namespace

Command describe_commands(const Options& options) {
  return describe(options.app, options.app.get_name(), options);
}

}  // namespace kadr::cli
