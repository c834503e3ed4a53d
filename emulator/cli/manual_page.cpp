#include <fmt/format.h>

#include <array>
#include <string_view>

#include "emulator/cli/command_tree.h"
#include "emulator/cli/exit_codes.h"

/// The manual page in the macros of man(7). It carries no date: the same sources make the same bytes.
namespace kadr::cli {
namespace {

struct ManualEntry {
  std::string_view name;
  std::string_view text;
};

constexpr std::array kEnvironment = {
    ManualEntry{"NO_COLOR", "Messages are not coloured (unless `--color always`)."},
    ManualEntry{"CLICOLOR_FORCE", "Messages are coloured even where no terminal reads them."},
    ManualEntry{"CI", "No progress bar and no colour unless requested."},
};
constexpr std::array kFiles = {
    ManualEntry{"PROG.lcmlog",
                "The log of `kadr run PROG`, in the current folder. While it is written, PROG.lcmlog.part."},
    ManualEntry{
        "PREFIX/share/kadr/machines/*.toml",
        "The machine files that ship with kadr; their names need no file. PREFIX is /usr in the Debian "
        "package."},
    ManualEntry{
        "PREFIX/share/kadr/scenarios/*/scenario.toml",
        "Programs with a machine and the expected results; `kadr scenario run` writes nothing there."},
    ManualEntry{"PREFIX/share/kadr/kadr.lcm", "The types of the log's messages, for lcm-gen(1)."},
    ManualEntry{"PREFIX/share/doc/kadr", "README.md, and docs/ with a page on each subject."},
};

constexpr std::string_view kManualTop = R"(.SH SYNOPSIS
.B kadr
.I COMMAND
[\fIOPTIONS\fR] [\fIFILES\fR]
.br
.B kadr
.I COMMAND
.B \-\-help
.br
.B kadr \-\-version
.SH DESCRIPTION
A control program goes in; step pulses stamped in ticks of an integer clock, the motion of a flexible machine,
alarms, a log and a summary come out. The same inputs give the same bytes.
.PP
A file named
.B \-
is standard input. Data go to standard output, messages to standard error.
)";
constexpr std::string_view kExamplesTitle = ".SH EXAMPLES\n";
constexpr std::string_view kSeeAlso = R"(.SH SEE ALSO
.BR lcm\-gen (1),
.BR lcm\-logplayer (1),
.BR lcm\-spy (1)
)";

std::string_view roff_escape(char c) {
  switch (c) {
    case '\\':
      return "\\(rs";
    case '-':
      return "\\-";
    case '\'':
      return "\\(aq";
    case '^':
      return "\\(ha";
    case '~':
      return "\\(ti";
    default:
      return {};
  }
}

/// Roff text: text between backticks becomes bold.
std::string roff_text(std::string_view text) {
  std::string out;
  bool bold = false;
  for (const char c : text) {
    if (c == '`') {
      bold = !bold;
      out += bold ? "\\fB" : "\\fR";
    } else if (const std::string_view escaped = roff_escape(c); !escaped.empty()) {
      out += escaped;
    } else {
      out += c;
    }
  }
  // a point at the beginning of a line would be a macro
  return out.starts_with('.') ? "\\&" + out : out;
}

std::string roff_bold(std::string_view text) { return fmt::format("\\fB{}\\fR", roff_text(text)); }
std::string roff_italic(std::string_view text) { return fmt::format("\\fI{}\\fR", roff_text(text)); }

/// A paragraph of help: its line ends are only layout, but lines that begin with blanks stay separate.
std::string paragraph(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool alone = line.starts_with("  ");
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.empty()) continue;
    out += fmt::format("{}{}\n", alone ? ".br\n" : "", roff_text(line));
  }
  return out;
}

std::string manual_synopsis(const Command& command) {
  std::string out = roff_bold(command.name);
  if (!command.commands.empty())
    return out + (command.needs_command ? " " : " [") + roff_italic("COMMAND") +
           (command.needs_command ? "" : "]");
  out += " [" + roff_italic("OPTIONS") + "]";
  for (const CommandOption& o : command.operands) {
    const std::string name = roff_italic(o.names.front()) + (o.repeatable ? " ..." : "");
    out += o.required ? " " + name : " [" + name + "]";
  }
  return out;
}

std::string option_entry(const CommandOption& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + roff_bold(name);
  if (!option.value.empty()) names += ' ' + roff_italic(option.value);
  return fmt::format(".TP\n{}\n{}", names, paragraph(option.text));
}

void add_commands(const Command& command, std::string& out) {
  for (const Command& sub : command.commands) {
    out += fmt::format(".SS {}\n{}", manual_synopsis(sub), paragraph(sub.text + '\n' + sub.note));
    for (const CommandOption& o : sub.operands)
      out += fmt::format(".TP\n{}\n{}", roff_italic(o.names.front()), paragraph(o.text));
    for (const CommandOption& o : sub.options)
      // said once, above
      if (o.names.back() != "--help") out += option_entry(o);
    add_commands(sub, out);
  }
}

void add_examples(const Command& command, std::string& out) {
  if (!command.example.empty())
    out += fmt::format("{}{}.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", out.ends_with(kExamplesTitle) ? "" : ".PP\n",
                       paragraph(command.text), roff_text(command.example));
  for (const Command& sub : command.commands) add_examples(sub, out);
}

template <class List>
std::string manual_section(std::string_view title, const List& list) {
  std::string out = fmt::format(".SH {}\n", title);
  for (const ManualEntry& e : list) out += fmt::format(".TP\n{}\n{}\n", roff_bold(e.name), roff_text(e.text));
  return out;
}

}  // namespace

std::string manual_page(const Command& kadr) {
  std::string out = fmt::format(
      ".\\\" Written by `kadr man`.\n.TH KADR 1 \"\" \"kadr {}\" \"User Commands\"\n.ad l\n", KADR_VERSION);
  out += ".SH NAME\nkadr \\- deterministic emulator of CNC machines\n";
  out += kManualTop;
  out += ".SH OPTIONS\n";
  for (const CommandOption& o : kadr.options) out += option_entry(o);
  out += ".PP\nEvery command takes " + roff_bold("--help") + ".\n.SH COMMANDS\n";
  add_commands(kadr, out);
  out += ".SH EXIT STATUS\n";
  for (const ExitCode& c : kExitCodes)
    out += fmt::format(".TP\n{}\n{}\n", roff_bold(c.code), roff_text(c.meaning));
  out += manual_section("ENVIRONMENT", kEnvironment);
  out += manual_section("FILES", kFiles);
  out += kExamplesTitle;
  add_examples(kadr, out);
  out += kSeeAlso;
  return out;
}

}  // namespace kadr::cli
