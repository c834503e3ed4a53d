#include "rs274_writer.h"

#include <fmt/format.h>

#include <cctype>

namespace kadr::gcode::test {

std::string Writer::number(double low, double high) const {
  return fmt::format("{:.3f}", random.real(low, high));
}

std::string Writer::spelled_number(double low, double high) const {
  const double value = random.real(low, high);
  switch (random.below(7)) {
    case 0:
      return fmt::format("{:.0f}", value);
    case 1:
      return fmt::format("{:.0f}.", value);
    case 2:
      return fmt::format("{}.{:02}", value < 0 ? "-" : "", random.below(100));
    case 3:
      return fmt::format("{:+.2f}", value);
    case 4:
      return fmt::format("{}00{:.1f}", value < 0 ? "-" : "", value < 0 ? -value : value);
    default:
      return fmt::format("{:.3f}", value);
  }
}

std::string Writer::word_value() {
  switch (random.below(6)) {
    case 0:
      return fmt::format("[[{}] MOD 50]", expression(2));
    case 1:
      return fmt::format("[[{}] MOD {} - 20]", expression(1), number(1, 40));
    case 2:
      return random.chance(0.5) ? "-SIN[" + expression(1) + "]" : " COS[" + expression(1) + "]";
    default:
      return spelled_number(-50, 50);
  }
}

std::string Writer::expression(int depth) {
  if (depth <= 0) return operand(0);
  const std::string left = operand(depth - 1), right = operand(depth - 1);
  switch (random.below(10)) {
    case 0:
      return left + "*" + right;
    case 1:
      return fmt::format("{}/[ABS[{}]+1]", left, right);
    case 2:
      return fmt::format("{} {} [ABS[{}]+0.5]", left, respelled("MOD"), right);
    case 3:
      return fmt::format("[[{}] MOD 5 + 0.5]**[[{}] MOD 3]", left, right);
    case 4: {
      static const std::vector<std::string> kComparisons = {"EQ", "NE", "GT", "GE", "LT", "LE"};
      return fmt::format("{} {} {}", left, respelled(pick(kComparisons)), right);
    }
    case 5: {
      static const std::vector<std::string> kLogic = {"AND", "OR", "XOR"};
      return fmt::format("{} {} {}", left, respelled(pick(kLogic)), right);
    }
    case 6:
    case 7:
      return left + "-" + right;
    default:
      return left + " + " + right;
  }
}

std::string Writer::operand(int depth) {
  const std::string inner = depth > 0 ? expression(depth - 1) : spelled_number(-9, 9);
  switch (random.below(18)) {
    case 0:
      return fmt::format("[{}]", inner);
    case 1:
      return fmt::format("-[{}]", inner);
    case 2:
      return fmt::format("{}[ABS[{}]]", respelled("SQRT"), inner);
    case 3:
      return fmt::format("{}[ABS[{}]+1]", respelled("LN"), inner);
    case 4:
      return fmt::format("{}[[{}] MOD 5]", respelled("EXP"), inner);
    case 5:
      // not a round number up to its last bit, where MOD, FIX or EQ would jump
      return fmt::format("[{}[COS[{}]]+0.0137]", random.chance(0.5) ? "ACOS" : "ASIN", inner);
    case 6:
      return fmt::format("{}[[{}] MOD 80]", respelled("TAN"), inner);
    case 7:
      return fmt::format("{}[{}]", random.chance(0.5) ? "SIN" : "cos", inner);
    case 8:
      return fmt::format("[ATAN[{}]/[{}]+0.0137]", inner, spelled_number(-9, 9));
    case 9:
      return fmt::format("{}[{}]", pick({"ROUND", "FIX", "FUP", "ABS", "round", "fix"}), inner);
    case 10:
    case 11:
    case 12:
      return parameter();
    case 13:
      return fmt::format("EXISTS[#<{}>]", pick({"_one", "two", "_feed", "never_set", "long name"}));
    default:
      return spelled_number(-9, 9);
  }
}

std::string Writer::parameter() {
  if (!named.empty() && random.chance(0.4)) return "#<" + respelled(pick(named)) + ">";
  switch (random.below(6)) {
    case 0:
      return fmt::format("#{}", 31 + random.below(5));
    case 1:
      return fmt::format("#[{}+{}]", 31 + random.below(3), random.below(3));
    case 2:
      return fmt::format("-#{}", 1 + random.below(5));
    case 3:
      return fmt::format("#{}", pick({"5220", "5400", "5210", "5420", "5423"}));
    default:
      return fmt::format("#{}", 1 + random.below(5));
  }
}

std::string Writer::settable_parameter() {
  if (random.chance(0.4)) {
    const std::string name = pick({"_one", "two", "_three", "long name", "_g4", "x"});
    named.push_back(name);
    return "#<" + respelled(name) + ">";
  }
  return random.chance(0.5) ? fmt::format("#{}", 1 + random.below(5))
                            : fmt::format("#{}", 31 + random.below(5));
}

std::string Writer::respelled(const std::string& text) const {
  if (random.chance(0.6)) return text;
  std::string other;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    other += static_cast<char>(random.chance(0.5) ? std::toupper(u) : std::tolower(u));
    if (random.chance(0.1)) other += ' ';
  }
  return other;
}

}  // namespace kadr::gcode::test
