#include "machine/base/codes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "machine/base/require.h"

namespace kadr {

namespace {

constexpr CodeEntry kTexts[] = {
#define KADR_TEXT(name, title, explanation) {Code::name, #name, title, explanation},
#include "machine/base/code_texts.inc"
#undef KADR_TEXT
};

// A code without a text, or with two, does not compile: -Wswitch and duplicate cases are errors.
constexpr bool has_text(Code code) {
  switch (code) {
#define KADR_TEXT(name, title, explanation) case Code::name:
#include "machine/base/code_texts.inc"
#undef KADR_TEXT
    return true;
  }
  return false;
}
static_assert(has_text(Code::broken_promise));

}  // namespace

std::span<const CodeEntry> all_codes() {
  static const std::vector<CodeEntry> entries = [] {
    std::vector<CodeEntry> list(std::begin(kTexts), std::end(kTexts));
    std::sort(list.begin(), list.end(),
              [](const CodeEntry& a, const CodeEntry& b) { return a.code < b.code; });
    return list;
  }();
  return entries;
}

const CodeEntry& code_entry(Code code) {
  const auto list = all_codes();
  const auto it =
      std::lower_bound(list.begin(), list.end(), code, [](const CodeEntry& e, Code c) { return e.code < c; });
  require(it != list.end() && it->code == code, "every code is listed in machine/base/codes");
  return *it;
}

std::string code_name(Code code) { return fmt::format("K{:04}", static_cast<int>(code)); }

std::optional<Code> parse_code(std::string_view text) {
  if (!text.empty() && (text.front() == 'K' || text.front() == 'k')) text.remove_prefix(1);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  for (const CodeEntry& e : all_codes())
    if (static_cast<int>(e.code) == number) return e.code;
  return std::nullopt;
}

}  // namespace kadr
