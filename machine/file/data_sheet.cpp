#include "machine/file/data_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "machine/base/parse_number.h"
#include "machine/file/machine_keys.h"
#include "machine/file/units.h"

namespace kadr::machine {

namespace {

constexpr double kDefaultAcceleration_u_s2 = 500;
constexpr double kDefaultStepsPer_mm = 400, kDefaultStepsPer_deg = 100;
constexpr double kSheetClock_hz = 10e6;
constexpr double kJunctionDeviation_mm = 0.01;
constexpr double kMostToolChange_s = 1e6;

using Text = std::string_view;
template <class T>
using Result = tl::expected<T, std::string>;

Text trimmed(Text text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::vector<Text> split(Text text) {
  std::vector<Text> parts;
  for (;;) {
    const auto comma = text.find(',');
    parts.push_back(trimmed(text.substr(0, comma)));
    if (comma == Text::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

/// One number of a data sheet: its quantity on a linear and on a rotary axis, and its option.
struct Item {
  Text option;
  Text what;                ///< "a speed with its unit"
  Quantity linear, rotary;  ///< equal: the same for both kinds
  Text linear_unit, rotary_unit;
  Text examples_linear, examples_rotary;
  bool bare = true;  ///< a number without unit is taken in the first unit
  Bounds bounds;
};

constexpr Item kTravel{"--travel",
                       "a length or a range",
                       Quantity::length,
                       Quantity::angle,
                       "mm",
                       "deg",
                       "800, -75..5",
                       "-120..120, inf",
                       true,
                       {-1e8, 1e8}};
constexpr Item kSpeed{"--max-speed",
                      "a speed with its unit",
                      Quantity::speed,
                      Quantity::angular_speed,
                      "mm/s",
                      "deg/s",
                      "5000mm/min, 83.3mm/s, 5m/min",
                      "20rpm, 7200deg/min, 120deg/s",
                      false,
                      kFeedBounds};
constexpr Item kAcceleration{"--acceleration",
                             "an acceleration",
                             Quantity::acceleration,
                             Quantity::angular_acceleration,
                             "mm/s2",
                             "deg/s2",
                             "200, 0.2m/s2, 0.02g",
                             "500, 10rad/s2",
                             true,
                             kAccelBounds};
constexpr Item kJerk{"--jerk", "a jerk",   Quantity::jerk,       Quantity::angular_jerk,
                     "mm/s3",  "deg/s3",   "10000, 10m/s3, inf", "10000, inf",
                     true,     kJerkBounds};
constexpr Item kSteps{"--steps-per-mm",    "a number of steps", Quantity::per_length,
                      Quantity::per_angle, "steps/mm",          "steps/deg",
                      "40, 1016/inch",     "100, 36000/rev",    true,
                      kStepsPerBounds};
constexpr Item kHomePosition{"--home", "a position", Quantity::length, Quantity::angle, "mm", "deg", "0, -5",
                             "0",      true,         kPositionBounds};
constexpr Item kToolChange{"--tool-change", "a time", Quantity::time, Quantity::time,        "s", "s",
                           "8, 0.5min",     "",       true,           {0, kMostToolChange_s}};

bool turns(const SheetAxis& axis) { return axis.kind == AxisKind::rotary; }
Text unit_of(const Item& item, bool rotary) { return rotary ? item.rotary_unit : item.linear_unit; }

/// "--max-speed of axis X" or "--tool-change".
std::string place(const Item& item, const SheetAxis* axis) {
  return axis ? fmt::format("{} of axis {}", item.option, axis->letter) : std::string(item.option);
}

std::string refusal(const Item& item, const SheetAxis* axis, Text given, Text why = {}) {
  const bool rotary = axis && turns(*axis);
  return fmt::format("{} takes {}, e.g. {}; got '{}'{}{}", place(item, axis), item.what,
                     rotary ? item.examples_rotary : item.examples_linear, given, why.empty() ? "" : ": ",
                     why);
}

/// "mm/s^2" -> "mm_s2", "/mm" -> "per_mm": as units stand at the end of a key.
std::string suffix_of(Text unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '/')
      out += i == 0 ? "per_" : "_";
    else if (unit.substr(i, 2) == "\xC2\xB2" || unit.substr(i, 2) == "\xC2\xB3")  // superscript 2 and 3
      out += unit[++i] == '\xB2' ? '2' : '3';
    else if (unit[i] != '^' && unit[i] != ' ')
      out += unit[i];
  }
  return out;
}

/// 31.5 in are 800.1 mm, not 800.0999999999999: a product within rounding of 12 digits is those digits.
double without_noise(double product) {
  const double told = *parse_number(fmt::format("{:.12g}", product));
  return std::fabs(told - product) <= 4 * std::numeric_limits<double>::epsilon() * std::fabs(product)
             ? told
             : product;
}

/// The value in the item's first unit, whatever unit it was given in; not yet bounded.
Result<double> number_of(const Item& item, const SheetAxis* axis, Text text) {
  const bool rotary = axis && turns(*axis);
  std::size_t length = text.size();
  while (length > 0 && !parse_number(text.substr(0, length))) --length;
  if (length == 0) return tl::unexpected(refusal(item, axis, text));
  const double value = *parse_number(text.substr(0, length));
  const Text unit = trimmed(text.substr(length));
  const Quantity wanted = rotary ? item.rotary : item.linear;
  if (unit.empty()) {
    if (item.bare) return value;
    return tl::unexpected(refusal(item, axis, text, "add the unit"));
  }
  const Unit* known = find_unit(suffix_of(unit));
  if (!known) return tl::unexpected(refusal(item, axis, text, fmt::format("unit '{}' is not known", unit)));
  if (known->quantity != wanted) {
    const bool other = known->quantity == (rotary ? item.linear : item.rotary);
    const std::string why =
        other ? fmt::format("axis {} {}", axis->letter, rotary ? "turns" : "moves along a line")
              : fmt::format("'{}' is another kind of unit", unit);
    return tl::unexpected(refusal(item, axis, text, why));
  }
  return known->factor == 1 ? value : without_noise(value * known->factor);
}

std::string bounded(const Item& item, const SheetAxis* axis, Text given, double value) {
  const bool inside = value >= item.bounds.low && value <= item.bounds.high;
  if (inside || (std::isinf(value) && value > 0 && item.bounds.infinite)) return {};
  const Text unit = unit_of(item, axis && turns(*axis));
  return fmt::format("{} is {:.6g} {} ('{}'); allowed: {:g} to {:g} {}{}", place(item, axis), value, unit,
                     given, item.bounds.low, item.bounds.high, unit, item.bounds.infinite ? ", or inf" : "");
}

Result<SheetValue> value_of(const Item& item, const SheetAxis* axis, Text text) {
  Result<double> value = kInfinity;
  if (text != "inf" || !item.bounds.infinite) value = number_of(item, axis, text);
  if (!value) return tl::unexpected(std::move(value.error()));
  if (std::string wrong = bounded(item, axis, text, *value); !wrong.empty())
    return tl::unexpected(std::move(wrong));
  return SheetValue{*value, std::string(text)};
}

/// "XYZ", also "x,y,z".
Result<std::vector<SheetAxis>> axes_of(Text text) {
  std::vector<SheetAxis> axes;
  for (char letter : text) {
    if (letter == ',' || letter == ' ') continue;
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    const bool twice =
        std::any_of(axes.begin(), axes.end(), [&](const SheetAxis& axis) { return axis.letter == letter; });
    if (axis_index(letter) < 0 || twice)
      return tl::unexpected(
          fmt::format("--axes takes letters of X Y Z A B C U V W, each once, e.g. XYZ; "
                      "got '{}'{}",
                      text, twice ? fmt::format(": {} is given twice", letter) : ""));
    SheetAxis axis;
    axis.letter = letter;
    axis.kind = is_rotary_letter(letter) ? AxisKind::rotary : AxisKind::linear;
    axes.push_back(std::move(axis));
  }
  if (axes.empty())
    return tl::unexpected(
        fmt::format("--axes takes letters of X Y Z A B C U V W, each once, e.g. XYZ; got '{}'", text));
  return axes;
}

/// The words of a list, one for each axis.
Result<std::vector<Text>> words_of(const Item& item, Text list, const std::vector<SheetAxis>& axes) {
  std::vector<Text> words = split(list);
  if (words.size() == 1) words.resize(axes.size(), words.front());
  if (words.size() == axes.size()) return words;
  std::string order;
  for (const SheetAxis& axis : axes) order += (order.empty() ? "" : ",") + std::string(1, axis.letter);
  // "83,3mm/s": the first word lacks its unit, or there is one word too many
  const bool comma = parse_number(words.front()) && (!item.bare || words.size() > axes.size());
  return tl::unexpected(fmt::format("{} takes one value for all axes, or {} in the order {}; got {}: '{}'{}",
                                    item.option, axes.size(), order, words.size(), list,
                                    comma ? "; the decimal mark is a point" : ""));
}

/// Position of the travel if only its length is given: from 0 up; Z has its zero in the middle, so that a
/// program whose zero is the top of the part can retract above it.
void place_travel(SheetAxis& axis, double length_u) {
  axis.zero_given = false;
  axis.min_u = axis.letter == 'Z' ? -length_u / 2 : 0;
  axis.max_u = axis.letter == 'Z' ? length_u / 2 : length_u;
}

/// Reads "800", "-75..5", "inf".
std::string read_travel(SheetAxis& axis, Text text) {
  axis.travel = text;
  if (text == "inf" && turns(axis)) {
    axis.min_u = -kInfinity;
    axis.max_u = kInfinity;
    return {};
  }
  const auto dots = text.find("..");
  const Text last = dots == Text::npos ? text : trimmed(text.substr(dots + 2));
  const auto high = number_of(kTravel, &axis, last);
  if (!high) return refusal(kTravel, &axis, text);
  if (std::string wrong = bounded(kTravel, &axis, text, *high); !wrong.empty()) return wrong;
  if (dots == Text::npos) {
    if (*high > 0) return place_travel(axis, *high), std::string();
    return fmt::format("--travel of axis {} is {} {}; allowed: above 0, or a range such as -75..5",
                       axis.letter, number_text(*high), axis.unit());
  }
  // "-75..5mm": the unit behind the range holds for both of its ends
  std::size_t digits = last.size();
  while (digits > 0 && !parse_number(last.substr(0, digits))) --digits;
  std::string first(trimmed(text.substr(0, dots)));
  if (parse_number(first)) first += last.substr(digits);
  const auto low = number_of(kTravel, &axis, first);
  if (!low) return refusal(kTravel, &axis, text);
  if (std::string wrong = bounded(kTravel, &axis, text, *low); !wrong.empty()) return wrong;
  if (*low >= *high)
    return fmt::format("--travel of axis {} runs from {} to {} {}; allowed: LOW..HIGH with LOW < HIGH",
                       axis.letter, number_text(*low), number_text(*high), axis.unit());
  axis.min_u = *low;
  axis.max_u = *high;
  return {};
}

/// A list of numbers into a member of each axis; without a list the default of each.
template <class Default>
std::string read_list(const Item& item, Text list, std::vector<SheetAxis>& axes,
                      SheetValue SheetAxis::*member, Default otherwise) {
  if (list.empty()) {
    for (SheetAxis& axis : axes) axis.*member = {otherwise(axis), {}};
    return {};
  }
  const auto words = words_of(item, list, axes);
  if (!words) return words.error();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    auto value = value_of(item, &axes[i], (*words)[i]);
    if (!value) return value.error();
    axes[i].*member = std::move(*value);
  }
  return {};
}

std::string check_home(const SheetAxis& axis) {
  const double home = axis.home_u.value;
  if (home >= axis.min_u && home <= axis.max_u) return {};
  return fmt::format("--home of axis {} is {} {}; allowed: {} to {} {} (--travel)", axis.letter,
                     number_text(home), axis.unit(), number_text(axis.min_u), number_text(axis.max_u),
                     axis.unit());
}

std::string check_step_rate(const SheetAxis& axis) {
  const double rate_hz = axis.max_u_s.value * axis.steps_per_u.value;
  if (rate_hz <= kSheetClock_hz / 2) return {};
  return fmt::format(
      "axis {}: {} steps per {} at {:.6g} {}/s are {:.6g} steps/s; allowed: up to {:.6g} steps/s, half of "
      "the clock",
      axis.letter, number_text(axis.steps_per_u.value), axis.unit(), axis.max_u_s.value, axis.unit(), rate_hz,
      kSheetClock_hz / 2);
}

std::string read_axes(const DataSheetWords& words, std::vector<SheetAxis>& axes) {
  for (const auto& [option, word, example] :
       {std::tuple{"--travel", &words.travel, "--travel 800,800,80"},
        std::tuple{"--max-speed", &words.max_speed, "--max-speed 5000mm/min"}})
    if (word->empty()) return fmt::format("a data sheet needs {}, e.g. {}", option, example);
  const auto travel = words_of(kTravel, words.travel, axes);
  if (!travel) return travel.error();
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (std::string wrong = read_travel(axes[i], (*travel)[i]); !wrong.empty()) return wrong;

  const auto always = [](double value) { return [value](const SheetAxis&) { return value; }; };
  const auto steps = [](const SheetAxis& a) { return turns(a) ? kDefaultStepsPer_deg : kDefaultStepsPer_mm; };
  const auto home = [](const SheetAxis& a) { return std::clamp(0.0, a.min_u, a.max_u); };
  std::string wrong = read_list(kSpeed, words.max_speed, axes, &SheetAxis::max_u_s, always(0));
  if (wrong.empty())
    wrong = read_list(kAcceleration, words.acceleration, axes, &SheetAxis::acceleration_u_s2,
                      always(kDefaultAcceleration_u_s2));
  if (wrong.empty()) wrong = read_list(kJerk, words.jerk, axes, &SheetAxis::jerk_u_s3, always(kInfinity));
  if (wrong.empty()) wrong = read_list(kSteps, words.steps, axes, &SheetAxis::steps_per_u, steps);
  if (wrong.empty()) wrong = read_list(kHomePosition, words.home, axes, &SheetAxis::home_u, home);
  for (SheetAxis& axis : axes) {
    axis.junction_u_s2 = default_junction_u_s2(axis.acceleration_u_s2.value);
    if (wrong.empty()) wrong = check_home(axis);
    if (wrong.empty()) wrong = check_step_rate(axis);
  }
  return wrong;
}

std::string command_of(const DataSheetWords& words) {
  std::string out;
  const auto add = [&](Text option, const std::string& word) {
    if (word.empty()) return;
    const bool plain = word.find(' ') == std::string::npos;
    // a value that begins with a minus sign would look like an option
    out += fmt::format(" {}{}{}{}{}", option, word.front() == '-' ? "=" : " ", plain ? "" : "'", word,
                       plain ? "" : "'");
  };
  add("--axes", words.axes);
  add("--travel", words.travel);
  add("--max-speed", words.max_speed);
  add("--acceleration", words.acceleration);
  add("--jerk", words.jerk);
  add("--steps-per-mm", words.steps);
  add("--home", words.home);
  add("--tool-change", words.tool_change);
  return out;
}

/// Lines "key = value  # comment", the comments in one column.
class Lines {
 public:
  void text(Text line) { out_ += fmt::format("{}\n", line); }
  void key(Text key, Text value, Text comment) {
    out_ += fmt::format("{:<38} # {}\n", fmt::format("{} = {}", key, value), comment);
  }
  /// `matters`: a default that changes times.
  void value(Text name, const SheetValue& value, Text remark, bool matters = false) {
    const bool given = !value.given.empty();
    key(name, number_text(value.value),
        fmt::format("{}; {}",
                    given     ? "given: " + value.given
                    : matters ? "default, matters"
                              : "default",
                    remark));
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

void write_axis(Lines& out, const SheetAxis& axis) {
  const Text u = axis.unit();
  const auto key = [&](Text stem, Text suffix = "") { return fmt::format("{}_{}{}", stem, u, suffix); };
  out.text("");
  out.text("[[axis]]");
  out.key("name", fmt::format("\"{}\"", axis.letter),
          turns(axis) ? "rotary: every number in deg" : "linear: every number in mm");
  out.value(key("steps_per"), axis.steps_per_u, fmt::format("motor steps per {}, microsteps included", u));
  out.key(key("range"), fmt::format("[{}, {}]", number_text(axis.min_u), number_text(axis.max_u)),
          fmt::format("given: {}; {}, soft limits{}", axis.travel, u,
                      axis.zero_given ? "" : "; where zero lies: default, matters"));
  out.value(key("home"), axis.home_u, fmt::format("{}, where the axis stands when a program begins", u));
  out.value(key("max", "_s"), axis.max_u_s, fmt::format("{}/s, also the rapid rate", u));
  out.value(key("max_acceleration", "_s2"), axis.acceleration_u_s2, fmt::format("{}/s2", u), true);
  out.value(key("max_jerk", "_s3"), axis.jerk_u_s3, fmt::format("{}/s3; inf: acceleration jumps", u), true);
  out.value(key("junction_acceleration", "_s2"), {axis.junction_u_s2, {}},
            fmt::format("{0}/s2: the speed may jump by {1:.4g} {0}/s at a corner", u,
                        axis.junction_u_s2 * kSheetPeriod_s),
            true);
  out.text("  [axis.plant]");
  out.key("  model", "\"rigid\"",
          "default: follows its steps exactly; \"spring\" and \"stepper\" need masses");
}

}  // namespace

bool DataSheetWords::empty() const {
  return axes.empty() && travel.empty() && max_speed.empty() && acceleration.empty() && jerk.empty() &&
         steps.empty() && home.empty() && tool_change.empty();
}

double default_junction_u_s2(double acceleration_u_s2) {
  const double s = std::sqrt(0.5);
  const double corner_u_s =
      std::sqrt(std::sqrt(2.0) * acceleration_u_s2 * kJunctionDeviation_mm * s / (1 - s));
  // through text: two significant digits are the nearest double to them
  return *parse_number(fmt::format("{:.1e}", corner_u_s / kSheetPeriod_s));
}

tl::expected<DataSheet, std::string> read_data_sheet(const DataSheetWords& words) {
  DataSheet sheet;
  auto axes = axes_of(words.axes.empty() ? "XYZ" : words.axes);
  if (!axes) return tl::unexpected(std::move(axes.error()));
  sheet.axis = std::move(*axes);
  if (std::string wrong = read_axes(words, sheet.axis); !wrong.empty()) return tl::unexpected(wrong);
  if (!words.tool_change.empty()) {
    auto time = value_of(kToolChange, nullptr, words.tool_change);
    if (!time) return tl::unexpected(std::move(time.error()));
    sheet.tool_change_s = std::move(*time);
  }
  sheet.command = command_of(words);
  return sheet;
}

std::string render_data_sheet(const DataSheet& sheet, std::string_view name) {
  Lines out;
  out.text(fmt::format("# {}, from a data sheet:", name));
  out.text(fmt::format("#   kadr machine new {}{}", name, sheet.command));
  out.text("#");
  out.text(
      "# \"given\" marks what the data sheet said, \"default\" what was filled in. A default that matters "
      "changes");
  out.text("# times: put your machine's number there.");
  out.text("#");
  out.text(
      "# junction_acceleration decides the time of programs of short lines: at a corner an axis may change "
      "its");
  out.text(
      "# speed at once by this times the control period. The default passes a square corner as fast as grbl "
      "does");
  out.text("# with a junction deviation ($11) of 0.010 mm; lower is slower and smoother.");
  out.text("#");
  out.text(
      "# `kadr machine show FILE` prints every value in force; a copy of mill3 (`kadr machine new NAME`) "
      "explains all");
  out.text("# keys. A key that kadr does not know is an error.");
  out.key("format", "1", "edition of this file's format");
  out.key("name", fmt::format("\"{}\"", name), "the machine's name in reports");
  out.text("");
  out.text("[clock]");
  out.key("rate_hz", fmt::format("{:.0f}", kSheetClock_hz), "default: step pulses are stamped in its ticks");
  out.key("control_period_us", fmt::format("{:.0f}", kSheetPeriod_s * 1e6),
          "default: the feed is computed once per control period");
  out.text("");
  out.text("[planner]");
  out.value("tool_change_s", sheet.tool_change_s, "s, time that M6 takes", true);
  for (const SheetAxis& axis : sheet.axis) write_axis(out, axis);
  return out.take();
}

}  // namespace kadr::machine
