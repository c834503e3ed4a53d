#include "machine/file/data_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "machine/base/parse_number.h"
#include "machine/file/sheet_value.h"

namespace kadr::machine {

namespace {

constexpr double kDefaultAcceleration_u_s2 = 500;
constexpr double kDefaultStepsPer_mm = 400, kDefaultStepsPer_deg = 100;
constexpr double kJunctionDeviation_mm = 0.01;

using Text = std::string_view;
template <class T>
using Result = SheetResult<T>;

std::vector<Text> split(Text text) {
  std::vector<Text> parts;
  for (;;) {
    const auto comma = text.find(',');
    parts.push_back(trimmed_blanks(text.substr(0, comma)));
    if (comma == Text::npos) return parts;
    text.remove_prefix(comma + 1);
  }
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
Result<std::vector<Text>> words_of(const SheetItem& item, Text list, const std::vector<SheetAxis>& axes) {
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
  if (text == "inf" && axis.turns()) {
    axis.min_u = -kInfinity;
    axis.max_u = kInfinity;
    return {};
  }
  const auto dots = text.find("..");
  const Text last = dots == Text::npos ? text : trimmed_blanks(text.substr(dots + 2));
  const auto high = sheet_number(kSheetTravel, &axis, last);
  if (!high) return sheet_refusal(kSheetTravel, &axis, text);
  if (std::string wrong = out_of_bounds(kSheetTravel, &axis, text, *high); !wrong.empty()) return wrong;
  if (dots == Text::npos) {
    if (*high > 0) return place_travel(axis, *high), std::string();
    return fmt::format("--travel of axis {} is {} {}; allowed: above 0, or a range such as -75..5",
                       axis.letter, number_text(*high), axis.unit());
  }
  // "-75..5mm": the unit behind the range holds for both of its ends
  std::size_t digits = last.size();
  while (digits > 0 && !parse_number(last.substr(0, digits))) --digits;
  std::string first(trimmed_blanks(text.substr(0, dots)));
  if (parse_number(first)) first += last.substr(digits);
  const auto low = sheet_number(kSheetTravel, &axis, first);
  if (!low) return sheet_refusal(kSheetTravel, &axis, text);
  if (std::string wrong = out_of_bounds(kSheetTravel, &axis, text, *low); !wrong.empty()) return wrong;
  if (*low >= *high)
    return fmt::format("--travel of axis {} runs from {} to {} {}; allowed: LOW..HIGH with LOW < HIGH",
                       axis.letter, number_text(*low), number_text(*high), axis.unit());
  axis.min_u = *low;
  axis.max_u = *high;
  return {};
}

/// A list of numbers into a member of each axis; without a list the default of each.
template <class Default>
std::string read_list(const SheetItem& item, Text list, std::vector<SheetAxis>& axes,
                      SheetValue SheetAxis::*member, Default otherwise) {
  if (list.empty()) {
    for (SheetAxis& axis : axes) axis.*member = {otherwise(axis), {}};
    return {};
  }
  const auto words = words_of(item, list, axes);
  if (!words) return words.error();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    auto value = sheet_value(item, &axes[i], (*words)[i]);
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
  const auto travel = words_of(kSheetTravel, words.travel, axes);
  if (!travel) return travel.error();
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (std::string wrong = read_travel(axes[i], (*travel)[i]); !wrong.empty()) return wrong;

  const auto always = [](double value) { return [value](const SheetAxis&) { return value; }; };
  const auto steps = [](const SheetAxis& a) {
    return a.turns() ? kDefaultStepsPer_deg : kDefaultStepsPer_mm;
  };
  const auto home = [](const SheetAxis& a) { return std::clamp(0.0, a.min_u, a.max_u); };
  std::string wrong = read_list(kSheetSpeed, words.max_speed, axes, &SheetAxis::max_u_s, always(0));
  if (wrong.empty())
    wrong = read_list(kSheetAcceleration, words.acceleration, axes, &SheetAxis::acceleration_u_s2,
                      always(kDefaultAcceleration_u_s2));
  if (wrong.empty())
    wrong = read_list(kSheetJerk, words.jerk, axes, &SheetAxis::jerk_u_s3, always(kInfinity));
  if (wrong.empty()) wrong = read_list(kSheetSteps, words.steps, axes, &SheetAxis::steps_per_u, steps);
  if (wrong.empty()) wrong = read_list(kSheetHome, words.home, axes, &SheetAxis::home_u, home);
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
    auto time = sheet_value(kSheetToolChange, nullptr, words.tool_change);
    if (!time) return tl::unexpected(std::move(time.error()));
    sheet.tool_change_s = std::move(*time);
  }
  sheet.command = command_of(words);
  return sheet;
}

}  // namespace kadr::machine
