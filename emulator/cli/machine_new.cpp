#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <iostream>

#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/cli/inputs.h"
#include "emulator/cli/result_file.h"
#include "emulator/cli/standard_streams.h"
#include "emulator/text/text.h"
#include "machine/base/parse_number.h"
#include "machine/base/require.h"
#include "machine/base/terminal_text.h"

/// `kadr machine new`: a machine file to start from, a copy of another machine or made from a data sheet.
namespace kadr::cli {
namespace {

using machine::DataSheet;
using machine::DataSheetWords;
using machine::SheetAxis;
using text::Json;

/// The machine's text with `name = "..."` replaced.
std::string renamed(std::string_view toml, const std::string& name) {
  std::string out;
  bool done = false;
  while (!toml.empty()) {
    const auto end = std::min(toml.find('\n'), toml.size() - 1) + 1;
    const std::string_view line = toml.substr(0, end);
    toml.remove_prefix(end);
    const auto key_end = line.find_first_of(" =");
    if (!done && line.substr(0, key_end) == "name" && line.find('=') != std::string_view::npos) {
      const auto open = line.find('"'), close = line.find('"', open + 1);
      if (open != std::string_view::npos && close != std::string_view::npos) {
        out += fmt::format("{}\"{}\"{}", line.substr(0, open), name, line.substr(close + 1));
        done = true;
        continue;
      }
    }
    out += line;
  }
  return out;
}

void check_name(const std::string& name) {
  const bool plain = !name.empty() && name.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-") == std::string::npos;
  if (!plain)
    throw WorldError(
        fmt::format("machine name '{}': letters, digits, _ and - make a name; the file is NAME.toml in "
                    "the current folder",
                    name));
  if (name.front() == '-')
    throw WorldError(fmt::format(
        "machine name '{}': a name that begins with - reads as an option; begin with a letter, a digit or _",
        name));
  if (name.size() > machine::kMostMachineName)
    throw WorldError(fmt::format("machine name '{}': {} characters; allowed: up to {}", name, name.size(),
                                 machine::kMostMachineName));
}

/// "83.333 mm/s (5000 mm/min)"
std::string speed_text(const SheetAxis& axis) {
  const double u_s = axis.max_u_s.value;
  return fmt::format("{} {}/s ({} {}/min)", text::significant(u_s), axis.unit(), text::significant(60 * u_s),
                     axis.unit());
}

std::string value_text(const machine::SheetValue& value) {
  return text::significant(value.value) + (value.given.empty() ? " *" : "");
}

/// "2.600 mm/s *"
std::string corner_text(const SheetAxis& axis) {
  return fmt::format("{} {}/s *", text::significant(axis.junction_u_s2 * machine::kSheetPeriod_s),
                     axis.unit());
}

/// The values read, one row per axis; `*` marks a default.
std::string understood(const DataSheet& sheet) {
  text::TextTable table({{"axis"},
                         {"travel"},
                         {"home"},
                         {"max speed"},
                         {"acceleration"},
                         {"jerk"},
                         {"corner"},
                         {"steps"},
                         {"unit", text::TextTable::Align::left}});
  for (const SheetAxis& axis : sheet.axis)
    table.add({std::string(1, axis.letter),
               fmt::format("{} .. {}{}", number_text(axis.min_u), number_text(axis.max_u),
                           axis.zero_given ? "" : " *"),
               value_text(axis.home_u), speed_text(axis), value_text(axis.acceleration_u_s2),
               value_text(axis.jerk_u_s3), corner_text(axis), value_text(axis.steps_per_u),
               std::string(axis.unit())});
  return table.render("  ");
}

/// A line for each default that changes times or refuses programs, with the key to change.
std::string defaults_that_matter(const DataSheet& sheet) {
  const auto any = [&](auto is_default) {
    return std::any_of(sheet.axis.begin(), sheet.axis.end(), is_default);
  };
  const bool linear = any([](const SheetAxis& a) { return a.kind == machine::AxisKind::linear; });
  const std::string u = linear ? "mm" : "deg";
  std::string out = "defaults that matter (* above); change them in the file:\n";
  const auto tell = [&](const std::string& key, std::string_view meaning) {
    out += fmt::format("  {:<28}  {}\n", key, meaning);
  };
  tell("junction_acceleration_" + u + "_s2",
       "corner above is this times 1 ms: an axis may change its speed by that much at once");
  if (any([](const SheetAxis& a) { return a.acceleration_u_s2.given.empty(); }))
    tell("max_acceleration_" + u + "_s2", "a guess; --acceleration gives the machine's");
  if (any([](const SheetAxis& a) { return a.jerk_u_s3.given.empty(); }))
    tell("max_jerk_" + u + "_s3", "inf: acceleration jumps; --jerk limits it");
  if (any([](const SheetAxis& a) { return !a.zero_given; }))
    tell("range_" + u, "travel runs from 0 up, for Z half of it below 0; --travel LOW..HIGH sets it");
  if (sheet.tool_change_s.given.empty())
    tell("tool_change_s", "M6 takes no time; --tool-change gives the seconds");
  return out;
}

/// An infinite number is null.
Json axis_json(const SheetAxis& axis) {
  Json j;
  j["axis"] = std::string(1, axis.letter);
  j["unit"] = axis.unit();
  j["min_u"] = axis.min_u;
  j["max_u"] = axis.max_u;
  j["home_u"] = axis.home_u.value;
  j["max_u_s"] = axis.max_u_s.value;
  j["max_acceleration_u_s2"] = axis.acceleration_u_s2.value;
  j["max_jerk_u_s3"] = axis.jerk_u_s3.value;
  j["junction_acceleration_u_s2"] = axis.junction_u_s2;
  j["steps_per_u"] = axis.steps_per_u.value;
  return j;
}

/// Reads back what was written: a data sheet that passed makes a file without errors.
void check_text(const std::string& text, const std::string& path) {
  SourceSet sources;
  const auto read = machine::read_machine(SourceText(path, text), sources);
  require(read.has_value(), "a machine file made from a data sheet has no errors");
}

int write_sheet(const Arguments& arguments, const DataSheetWords& words, const std::string& name,
                Console& console) {
  const auto sheet = machine::read_data_sheet(words);
  if (!sheet) {
    console.error("machine new: " + sheet.error());
    return kNotStarted;
  }
  const std::string path = name + ".toml";
  const std::string text = machine::render_data_sheet(*sheet, name);
  check_text(text, path);
  write_file(path, text, {.overwrite = arguments.force});
  if (console.options().json) {
    Json j({{"file", path}, {"name", name}, {"copied_from", nullptr}});
    j["axes"] = Json::array();
    for (const SheetAxis& axis : sheet->axis) j["axes"].push_back(axis_json(axis));
    j["tool_change_s"] = sheet->tool_change_s.value;
    console.document(j);
  } else if (!console.options().quiet) {
    console.data(fmt::format("wrote {}, from a data sheet:\n{}{}next: kadr check PROGRAM -m {}\n", path,
                             understood(*sheet), defaults_that_matter(*sheet), path));
  }
  return kYes;
}

struct Question {
  std::string DataSheetWords::*word;
  std::string_view option;  ///< beginning of a complaint about the answer
  std::string_view text;
  std::string_view otherwise;  ///< of an empty answer
  bool must = false;           ///< an empty answer is no answer
};
constexpr Question kQuestions[] = {
    {&DataSheetWords::axes, "--axes", "Axes [XYZ]", "XYZ"},
    {&DataSheetWords::travel, "--travel", "Travel of each axis in mm or deg, e.g. 800,800,80", "", true},
    {&DataSheetWords::max_speed, "--max-speed", "Rapid rate with its unit, e.g. 5000mm/min", "", true},
    {&DataSheetWords::acceleration, "--acceleration", "Acceleration in mm/s2 or deg/s2 [500]", ""},
    {&DataSheetWords::steps, "--steps-per-mm",
     "Motor steps per mm or deg, microsteps included [400; A B C: 100]", ""},
    {&DataSheetWords::tool_change, "--tool-change", "Time of a tool change in s [0]", "0"},
};

/// Error in the answer to a question; later questions have no answer yet.
std::string complaint(DataSheetWords words, const Question& question) {
  if (words.travel.empty()) words.travel = "1";
  if (words.max_speed.empty()) words.max_speed = "1mm/s";
  const auto sheet = machine::read_data_sheet(words);
  if (sheet || !(sheet.error().starts_with(question.option) || sheet.error().starts_with("axis "))) return {};
  return sheet.error();
}

/// A speed for each axis, in its unit, that is not too fast for any number of steps.
std::string slow(const std::string& axes) {
  std::string speeds;
  for (const char letter : axes) {
    if (letter == ',' || letter == ' ') continue;
    const bool rotary = is_rotary_letter(static_cast<char>(std::toupper(static_cast<unsigned char>(letter))));
    speeds += fmt::format("{}{}", speeds.empty() ? "" : ",", rotary ? "0.001deg/s" : "0.001mm/s");
  }
  return speeds;
}

/// Errors in the given options, before any question. Without axes a single value has
/// to suit a linear or a rotary axis; a list waits for the axes.
std::string given_wrong(DataSheetWords words) {
  const bool axes_given = !words.axes.empty();
  if (!axes_given)
    for (const std::string* list :
         {&words.travel, &words.max_speed, &words.acceleration, &words.jerk, &words.steps, &words.home})
      if (list->find(',') != std::string::npos) return {};
  if (words.travel.empty()) words.travel = "-1e8..1e8";
  const bool speed_given = !words.max_speed.empty();
  std::string wrong;
  for (const char* axes : {"X", "A"}) {
    if (!axes_given) words.axes = axes;
    if (!speed_given) words.max_speed = slow(words.axes);
    const auto sheet = machine::read_data_sheet(words);
    if (sheet) return {};
    if (wrong.empty()) wrong = sheet.error();
  }
  return wrong;
}

std::string answer(const Question& question) {
  print_result(fmt::format("{}: ", question.text));
  std::string line;
  if (!std::getline(std::cin, line)) throw WorldError("--ask: no answer, nothing is written");
  return line.empty() ? std::string(question.otherwise) : line;
}

/// Asks for the values that the options leave open, each question until its answer can be read.
/// @throws WorldError where nobody can answer
void ask(DataSheetWords& words) {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0)
    throw WorldError("--ask needs a terminal; in a script give --travel, --max-speed ... instead");
  const auto check_given = [&words] {
    if (const std::string wrong = given_wrong(words); !wrong.empty())
      throw WorldError(fmt::format("machine new: {}", wrong));
  };
  check_given();
  for (const Question& question : kQuestions) {
    std::string& word = words.*question.word;
    if (!word.empty()) continue;
    for (;;) {
      word = answer(question);
      if (word.empty() && question.must) continue;
      const std::string wrong = complaint(words, question);
      if (wrong.empty()) break;
      print_result(wrong + '\n');
    }
    if (question.word == &DataSheetWords::axes) check_given();  // the lists among them
  }
}

int copy_machine(const Arguments& arguments, const std::string& name, Console& console) {
  SourceSet sources;
  machine::MachineFile machine;
  Diagnostics diagnostics;
  if (!load_machine(arguments.machine, {}, sources, machine, diagnostics)) {
    console.diagnostics(diagnostics, sources, "the machine file", Console::Where::errors);
    return kNotStarted;
  }
  const std::string path = name + ".toml";
  write_file(path, renamed(machine.text, name), {.overwrite = arguments.force});
  if (console.options().json)
    console.document(Json({{"file", path}, {"name", name}, {"copied_from", machine.model.name}}));
  else if (!console.options().quiet)
    console.data(fmt::format(
        "wrote {0}, a copy of {1}; change it, then: kadr machine check {0}\n"
        "from a data sheet instead: kadr machine new {2} --axes XYZ --travel 800,800,80 --max-speed "
        "5000mm/min ...\n",
        path, displayable(machine.model.name), name));
  return kYes;
}

}  // namespace

int machine_new(const Arguments& arguments, Console& console) {
  const std::string& name = arguments.files.front();
  check_name(name);
  DataSheetWords words = arguments.sheet;
  if (arguments.ask) ask(words);
  if (words.empty()) return copy_machine(arguments, name, console);
  if (!arguments.machine.empty()) {
    console.error(
        "machine new: --from copies a machine; it can't be used with --axes, --travel and the others");
    return kNotStarted;
  }
  return write_sheet(arguments, words, name, console);
}

}  // namespace kadr::cli
