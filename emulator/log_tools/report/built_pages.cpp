#include "emulator/log_tools/report/built_pages.h"

#include <fmt/format.h>

#include "emulator/text/text.h"
#include "machine/base/require.h"

namespace kadr::log_tools {

std::string_view page_missing(std::string_view name) {
  for (const BuiltPage& page : built_pages())
    if (page.name == name) return page.missing;
  require(false, "a page of that name");
  return {};
}

std::string plain_note(std::string_view name) {
  const std::string_view why = page_missing(name);
  return why.empty() ? "" : text::xml_text(fmt::format("; this build has no interactive page: {}", why));
}

std::string pages_text() {
  std::string built, left_out;
  std::string_view why;
  for (const BuiltPage& page : built_pages()) {
    std::string& list = page.missing.empty() ? built : left_out;
    list += (list.empty() ? "" : ", ") + std::string(page.name);
    // the last page needs most: its reason holds the others'
    if (!page.missing.empty()) why = page.missing;
  }
  if (left_out.empty()) return built;
  return (built.empty() ? "" : built + "; ") + "without " + left_out + ": " + std::string(why);
}

}  // namespace kadr::log_tools
