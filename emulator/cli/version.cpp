#include <fmt/format.h>

#include "emulator/cli/build_info.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/log/log_types.h"
#include "emulator/log_tools/report/built_pages.h"

namespace kadr::cli {
namespace {

/// true, or why this build lacks the page.
text::Json pages() {
  text::Json list = text::Json::object();
  for (const log_tools::BuiltPage& page : log_tools::built_pages())
    list[std::string(page.name)] = page.missing.empty() ? text::Json(true) : text::Json(page.missing);
  return list;
}

}  // namespace

int print_version(const Arguments&, Console& console) {
  if (console.options().json) {
    text::Json libraries = text::Json::object();
    for (const LibraryVersion& l : build_libraries()) libraries[std::string(l.name)] = l.version;
    console.document({{"kadr", KADR_VERSION},
                      {"commit", build_commit()},
                      {"compiler", build_compiler()},
                      {"build", build_flags()},
                      {"libraries", std::move(libraries)},
                      {"log_format", log::kLogFormat},
                      {"pages", pages()}});
    return kYes;
  }
  std::string libraries;
  for (const LibraryVersion& l : build_libraries())
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", l.name, l.version);
  console.data(fmt::format(
      "kadr {}\ncommit {}\ncompiler {}\nbuild {}\nlibraries {}\nlog format {}\npages {}\n", KADR_VERSION,
      build_commit(), build_compiler(), build_flags(), libraries, log::kLogFormat, log_tools::pages_text()));
  return kYes;
}

}  // namespace kadr::cli
