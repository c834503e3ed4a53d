#include "emulator/cli/options.h"

#include <cmath>

#include "machine/base/parse_number.h"

namespace kadr::cli {
namespace {

/// "blocks=", "call_depth=", ...
std::vector<std::string> names_with_equals(std::vector<std::string> names) {
  for (std::string& name : names) name += '=';
  return names;
}

constexpr std::string_view kLogBytes = "log_bytes";
constexpr std::uint32_t kLastLine = 4'000'000'000;

/// The names that --limit takes; `log`: of a command that writes a log.
std::vector<std::string> limit_names(bool log) {
  std::vector<std::string> names = gcode::bound_names();
  if (log) names.emplace_back(kLogBytes);
  return names;
}

constexpr std::string_view kAuto = "auto";  // --dialect

/// G54 .. G59.3 are 1 .. 9, G54.1P1 or G154P1 and on 10 and on; 0 for any other word.
int work_system(std::string_view word) {
  constexpr int kMostFurther = 300;
  for (const std::string_view head : {"G54.1P", "G154P"}) {
    if (word.substr(0, head.size()) != head) continue;
    const std::optional<double> number = parse_number(word.substr(head.size()));
    const bool whole = number && *number >= 1 && *number <= kMostFurther && *number == std::floor(*number);
    return whole ? gcode::kPlainWorkSystems + static_cast<int>(*number) : 0;
  }
  constexpr std::string_view kSystems[] = {"G54", "G55",   "G56",   "G57",  "G58",
                                           "G59", "G59.1", "G59.2", "G59.3"};
  for (std::size_t i = 0; i < std::size(kSystems); ++i)
    if (word == kSystems[i]) return static_cast<int>(i) + 1;
  return 0;
}

/// "G54=10,10,-30"
gcode::WorkOffset work_offset(const std::string& text) {
  constexpr double kFarthest_u = 1e8;
  const auto refuse = [&] {
    return CLI::ValidationError(
        fmt::format("--offset takes a work system G54 to G59.3, G54.1P1 or G154P1 and up to {} numbers, e.g. "
                    "G54=10,10,-30; "
                    "got '{}'",
                    kProgramAxes, text));
  };
  const std::size_t equals = text.find('=');
  gcode::WorkOffset offset{work_system(std::string_view(text).substr(0, equals)), {}};
  if (equals == std::string::npos || offset.system == 0) throw refuse();
  std::size_t axis = 0;
  for (std::size_t at = equals + 1; at <= text.size(); ++axis) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::optional<double> value = parse_number(std::string_view(text).substr(at, end - at));
    if (!value || axis >= kProgramAxes || !(std::fabs(*value) <= kFarthest_u)) throw refuse();
    offset.zero_u[axis] = *value;
    at = end + 1;
  }
  return offset;
}

/// "M31,M33" into the list of codes, each of them once.
tl::expected<void, std::string> take_ignored(const std::string& text,
                                             std::vector<machine::CodeName>& ignored) {
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string word = text.substr(at, end - at);
    const auto code = machine::parse_code_name(word);
    if (!code) return tl::unexpected(fmt::format("takes G and M codes, e.g. M31,M33; got '{}'", word));
    if (std::find(ignored.begin(), ignored.end(), *code) != ignored.end())
      return tl::unexpected(fmt::format("names {} twice", machine::code_text(*code)));
    ignored.push_back(*code);
    at = end + 1;
  }
  return {};
}

/// "spindle.0.at-speed=1" into the list of pins, each of them once.
tl::expected<void, std::string> take_hal(const std::string& text, std::vector<gcode::HalValue>& hal) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const std::optional<double> value =
      equals < text.size() ? parse_number(std::string_view(text).substr(equals + 1)) : std::nullopt;
  if (name.empty() || !value || !gcode::is_hal_name(name))
    return tl::unexpected(fmt::format("takes NAME=VALUE, e.g. plasmac.cut-feed-rate=1500; got '{}'", text));
  for (const gcode::HalValue& other : hal)
    if (other.name == name) return tl::unexpected(fmt::format("gives {} twice", name));
  hal.push_back({name, *value});
  return {};
}

}  // namespace

CLI::App* Options::command(CLI::App& parent, const std::string& name, Run value,
                           const std::string& description) {
  CLI::App* sub = parent.add_subcommand(name, description);
  sub->callback([this, value] { arguments.command = value; });
  return sub;
}

void Options::output(CLI::App* sub) {
  OutputOptions& out = arguments.output;
  sub->add_flag("--json", out.json, "Write one JSON document to standard output; its keys carry units")
      ->group("Output");
  sub->add_flag("-q,--quiet", out.quiet, "Only data and errors: no notes, no progress, no tables")
      ->group("Output");
  choice(sub, "--color", out.color, kWhens,
         fmt::format("Colour messages: {} (default auto: on a terminal, as NO_COLOR and CLICOLOR_FORCE say)",
                     kWhens.list("|")));
}

void Options::diagnostics(CLI::App* sub) {
  OutputOptions& out = arguments.output;
  choice(sub, "--format", out.format, kDiagnosticFormats,
         fmt::format("Form of diagnostics: {} (default human; json: one object per line; sarif: one SARIF "
                     "2.1.0 document)",
                     kDiagnosticFormats.list("|")));
  sub->add_option("--max-errors", out.max_errors,
                  "Show at most N diagnostics; 0: all (default 20; with sarif all)")
      ->type_name("N")
      ->group("Output");
}

void Options::progress(CLI::App* sub) {
  choice(sub, "--progress", arguments.output.progress, kProgressModes,
         fmt::format(
             "Progress on standard error: {} (default auto: a bar on a terminal, else a line every 10 s)",
             kProgressModes.list("|")));
}

void Options::machine(CLI::App* sub) {
  sub->add_option("-m,--machine", arguments.machine,
                  "Machine file, or the name of a shipped one: `kadr machine list` (default mill3)")
      ->type_name("FILE|NAME");
  sub->add_option("--set", arguments.settings,
                  "Change one value of the machine file, e.g. feed.max_mm_s=80; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

void Options::reading(CLI::App* sub, Writes writes) {
  sub->add_flag("--block-delete", arguments.block_delete, "Skip lines that begin with / (block delete)");
  sub->add_option("--subs", arguments.sub_folders,
                  "Folder to search for called files, after the program's own; repeatable")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->take_all();
  allow(sub);
  limits(sub, writes);
  sub->add_option("--tools", arguments.tools,
                  "Tool table: LinuxCNC's .tbl text, lengths in mm (default: every tool has length 0)")
      ->type_name("TABLE");
  sub->add_option_function<std::vector<std::string>>(
         "--offset",
         [this](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             const gcode::WorkOffset offset = work_offset(text);
             for (const gcode::WorkOffset& other : arguments.offsets)
               if (other.system == offset.system)
                 throw CLI::ValidationError(
                     fmt::format("--offset gives {} twice", text.substr(0, text.find('='))));
             arguments.offsets.push_back(offset);
           }
         },
         "Zero point of a work system before the first line, mm and deg in the order X Y Z A B C U V W, e.g. "
         "G54=10,10,-30; repeatable")
      ->type_name("SYSTEM=LIST")
      ->allow_extra_args(false)
      ->take_all();
  repeated(
      sub, "--ignore", "LIST",
      "G and M codes of the machine's owner to pass over, with the words that belong to them, e.g. M31,M33; "
      "repeatable",
      [this](const std::string& text) { return take_ignored(text, arguments.ignored); });
  sub->add_option("--ini", arguments.ini, "LinuxCNC's INI file of the machine, for #<_ini[SECTION]NAME>")
      ->type_name("FILE");
  repeated(sub, "--hal", "NAME=VALUE", "Value of a HAL pin, for #<_hal[NAME]>; repeatable",
           [this](const std::string& text) { return take_hal(text, arguments.hal); });
  dialect(sub);
}

void Options::dialect(CLI::App* sub) {
  sub->add_option_function<std::string>(
         "--dialect",
         [this](const std::string& text) {
           arguments.dialect = gcode::kDialects.find(text);
           arguments.recognise_dialect = text == kAuto;
           if (!arguments.dialect && !arguments.recognise_dialect)
             throw CLI::ValidationError(fmt::format("--dialect takes one of {}, {}; got '{}'",
                                                    gcode::kDialects.list(), kAuto, text));
         },
         fmt::format("Where controllers read codes differently, read them as this one does: {}|{} (default "
                     "linuxcnc; auto takes the one that the program's words show)",
                     gcode::kDialects.list("|"), kAuto))
      ->type_name("WORD");
  std::vector<std::string> dialects = gcode::kDialects.strings();
  dialects.emplace_back(kAuto);
  words(sub->get_option("--dialect"), dialects);
  line_range(sub);
}

void Options::line_range(CLI::App* sub) {
  const auto line = [sub](const char* name, std::optional<std::uint32_t>& value, const char* description) {
    sub->add_option_function<std::string>(
           name,
           [name, &value](const std::string& text) {
             std::uint32_t number = 0;
             if (!read_number(text, number) || number < 1 || number > kLastLine)
               throw CLI::ValidationError(
                   fmt::format("{} takes a line number of the program, 1 or above; got '{}'", name, text));
             value = number;
           },
           description)
        ->type_name("LINE");
  };
  line("--from-line", arguments.from_line,
       "Enter the program at this line of its text: what comes before it is run without motion (default: run "
       "all)");
  line("--to-line", arguments.to_line,
       "End the program when this line of its text has been run for the first time (default: run all)");
}

void Options::limits(CLI::App* sub, Writes writes) {
  const bool log = writes == Writes::log;
  sub->add_option_function<std::vector<std::string>>(
         "--limit",
         [this, log](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) limit(text, log);
         },
         fmt::format("Set a bound on programs{}; 0: no bound; repeatable; one of\n{}",
                     log ? " or the log" : "", fmt::join(limit_names(log), ", ")))
      ->type_name("NAME=N")
      ->allow_extra_args(false)
      ->take_all();
  words(sub->get_option("--limit"), names_with_equals(limit_names(log)));
}

void Options::allow(CLI::App* sub) {
  sub->add_option("--allow", arguments.allowed_folders,
                  "Folder below which files may lie that a file names, besides its own folder; repeatable")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->take_all();
}

void Options::limit(const std::string& text, bool log) {
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals);
  std::uint64_t value = 0;
  const bool number = equals != std::string::npos && read_number(text.substr(equals + 1), value);
  if (number && log && name == kLogBytes) {
    arguments.log_bytes = value;
    return;
  }
  if (!number || !gcode::set_bound(arguments.bounds, name, value))
    throw CLI::ValidationError(fmt::format("--limit takes NAME=N with NAME one of {} (0: no bound); got '{}'",
                                           fmt::join(limit_names(log), " "), text));
}

void Options::strict(CLI::App* sub) {
  sub->add_flag("--strict", arguments.strict, "Count warnings as errors (exit 1)");
}

CLI::Option* Options::programs(CLI::App* sub, const std::string& name, bool several) {
  CLI::Option* option = sub->add_option(name, arguments.files,
                                        several ? "Control programs; `-`: standard input"
                                                : "Control program; `-`: standard input")
                            ->required();
  if (!several) option->expected(1);
  return option->type_name("");
}

void Options::repeated(CLI::App* sub, const std::string& name, const char* type,
                       const std::string& description,
                       const std::function<tl::expected<void, std::string>(const std::string&)>& take) {
  sub->add_option_function<std::vector<std::string>>(
         name,
         [name, take](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             if (const auto taken = take(text); !taken)
               throw CLI::ValidationError(fmt::format("{} {}", name, taken.error()));
         },
         description)
      ->type_name(type)
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace kadr::cli
