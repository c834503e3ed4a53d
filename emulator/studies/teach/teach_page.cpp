#include "emulator/studies/teach/teach_page.h"

#include <fmt/format.h>

#include "machine/base/require.h"

namespace kadr::studies {
namespace {

constexpr std::string_view kStart = "<!--START-->";

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// A word of an address: commas part words, and a polynomial has blanks.
std::string encoded(const std::string& word) {
  std::string out;
  for (const char c : word)
    out += plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

std::string teach_address(const std::vector<std::string>& words, const std::vector<std::string>& methods) {
  if (words.empty()) return {};
  std::string out = methods.size() > 1 ? "compare" : "";
  for (const auto* list : {&words, &methods})
    for (const std::string& word : *list) out += (out.empty() ? "" : ",") + encoded(word);
  return out;
}

std::string render_teach_page(const std::string& address) {
  std::string page(teach_template());
  const auto at = page.find(kStart);
  require(at != std::string::npos, "the page's template has a place for its beginning");
  page.replace(at, kStart.size(),
               fmt::format("<script type=\"application/json\" id=\"start\">\"{}\"</script>", address));
  return page;
}

}  // namespace kadr::studies
