#include "machine/file/technology.h"

#include <fmt/format.h>

#include <charconv>

#include "machine/file/machine_keys.h"

namespace kadr::machine {
namespace {

constexpr int kMostOutputs = 64;

/// "M62 P1", blanks and case as in a program.
std::optional<TechnologyRule> parse_code(std::string_view text) {
  std::string code;
  for (const char c : text)
    if (c != ' ') code += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  if (code.size() < 5) return {};
  const std::string_view kind = std::string_view(code).substr(0, 4),
                         number = std::string_view(code).substr(4);
  TechnologyRule rule;
  rule.analog = kind == "M67E";
  rule.on = kind != "M63P";
  if (!rule.analog && rule.on && kind != "M62P") return {};
  const auto [end, wrong] = std::from_chars(number.data(), number.data() + number.size(), rule.number);
  const bool whole = wrong == std::errc() && end == number.data() + number.size();
  if (!whole || rule.number < 0 || rule.number >= kMostOutputs) return {};
  return rule;
}

}  // namespace

double read_technology_limit(TableReader& keys) {
  TechnologyRule rule;
  return read_key(keys, rule, kTechnologyLimit).value;
}

TechnologyRule read_technology_rule(TableReader& keys) {
  TechnologyRule rule;
  const auto on = keys.text(kTechnologyOn.name);
  if (const auto known = parse_code(on.value)) {
    rule = *known;
  } else if (on.valid) {
    Diagnostic d = file_diagnostic(Code::machine_technology, on.span, fmt::format("is '{}'", on.value));
    d.notes.push_back(
        fmt::format("allowed: M62 P, M63 P or M67 E with a number from 0 to {}", kMostOutputs - 1));
    d.help = "name the code that changes an output with the motion, e.g. on = \"M62 P1\"";
    keys.context().diagnostics.add(std::move(d));
  }
  rule.max_u_s = read_technology_limit(keys);
  return rule;
}

std::string technology_code(const TechnologyRule& rule) {
  return fmt::format("{}{}", rule.analog ? "M67 E" : rule.on ? "M62 P" : "M63 P", rule.number);
}

}  // namespace kadr::machine
