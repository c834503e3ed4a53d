#include "machine/owner_codes.h"

#include <fmt/format.h>

#include <charconv>

namespace kadr::machine {
namespace {

constexpr int kLargestCode = 99'999;
constexpr int kTenths = 10;

}  // namespace

std::optional<CodeName> parse_code_name(std::string_view text) {
  if (text.size() < 2) return {};
  CodeName code;
  if (text.front() == 'G' || text.front() == 'g') {
    code.letter = 'G';
  } else if (text.front() != 'M' && text.front() != 'm') {
    return {};
  }
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data() + 1, end, code.number);
  if (error != std::errc() || code.number < 0 || code.number > kLargestCode || text[1] == '-') return {};
  if (code.letter == 'G') code.number *= kTenths;
  if (at == end) return code;
  const bool decimal = code.letter == 'G' && end - at == 2 && at[0] == '.' && at[1] >= '0' && at[1] <= '9';
  if (!decimal) return {};
  code.number += at[1] - '0';
  return code;
}

std::string code_text(const CodeName& code) {
  if (code.letter == 'M') return fmt::format("M{}", code.number);
  if (code.number % kTenths == 0) return fmt::format("G{}", code.number / kTenths);
  return fmt::format("G{}.{}", code.number / kTenths, code.number % kTenths);
}

}  // namespace kadr::machine
