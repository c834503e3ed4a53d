#include "machine/file/sheet_value.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "machine/base/parse_number.h"

namespace kadr::machine {

namespace {

using Text = std::string_view;

Text unit_of(const SheetItem& item, bool rotary) { return rotary ? item.rotary_unit : item.linear_unit; }

/// "--max-speed of axis X" or "--tool-change".
std::string place(const SheetItem& item, const SheetAxis* axis) {
  return axis ? fmt::format("{} of axis {}", item.option, axis->letter) : std::string(item.option);
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

}  // namespace

std::string_view trimmed_blanks(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string sheet_refusal(const SheetItem& item, const SheetAxis* axis, Text given, Text why) {
  const bool rotary = axis && axis->turns();
  return fmt::format("{} takes {}, e.g. {}; got '{}'{}{}", place(item, axis), item.what,
                     rotary ? item.examples_rotary : item.examples_linear, given, why.empty() ? "" : ": ",
                     why);
}

SheetResult<double> sheet_number(const SheetItem& item, const SheetAxis* axis, Text text) {
  const bool rotary = axis && axis->turns();
  std::size_t length = text.size();
  while (length > 0 && !parse_number(text.substr(0, length))) --length;
  if (length == 0) return tl::unexpected(sheet_refusal(item, axis, text));
  const double value = *parse_number(text.substr(0, length));
  const Text unit = trimmed_blanks(text.substr(length));
  const Quantity wanted = rotary ? item.rotary : item.linear;
  if (unit.empty()) {
    if (item.bare) return value;
    return tl::unexpected(sheet_refusal(item, axis, text, "add the unit"));
  }
  const Unit* known = find_unit(suffix_of(unit));
  if (!known)
    return tl::unexpected(sheet_refusal(item, axis, text, fmt::format("unit '{}' is not known", unit)));
  if (known->quantity != wanted) {
    const bool other = known->quantity == (rotary ? item.linear : item.rotary);
    const std::string why =
        other ? fmt::format("axis {} {}", axis->letter, rotary ? "turns" : "moves along a line")
              : fmt::format("'{}' is another kind of unit", unit);
    return tl::unexpected(sheet_refusal(item, axis, text, why));
  }
  return known->factor == 1 ? value : without_noise(value * known->factor);
}

std::string out_of_bounds(const SheetItem& item, const SheetAxis* axis, Text given, double value) {
  const bool inside = value >= item.bounds.low && value <= item.bounds.high;
  if (inside || (std::isinf(value) && value > 0 && item.bounds.infinite)) return {};
  const Text unit = unit_of(item, axis && axis->turns());
  return fmt::format("{} is {:.6g} {} ('{}'); allowed: {:g} to {:g} {}{}", place(item, axis), value, unit,
                     given, item.bounds.low, item.bounds.high, unit, item.bounds.infinite ? ", or inf" : "");
}

SheetResult<SheetValue> sheet_value(const SheetItem& item, const SheetAxis* axis, Text text) {
  SheetResult<double> value = kInfinity;
  if (text != "inf" || !item.bounds.infinite) value = sheet_number(item, axis, text);
  if (!value) return tl::unexpected(std::move(value.error()));
  if (std::string wrong = out_of_bounds(item, axis, text, *value); !wrong.empty())
    return tl::unexpected(std::move(wrong));
  return SheetValue{*value, std::string(text)};
}

}  // namespace kadr::machine
