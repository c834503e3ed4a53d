#include <fmt/format.h>

#include "emulator/cli/build_info.h"
#include "emulator/cli/commands.h"
#include "emulator/cli/exit_codes.h"
#include "emulator/log/log_types.h"
#include "emulator/log_tools/report/built_pages.h"

namespace kadr::cli {
namespace {

/// true, or why this build lacks the page.
emulator::Json pages() {
  emulator::Json list = emulator::Json::object();
  for (const emulator::BuiltPage& page : emulator::built_pages())
    list[std::string(page.name)] = page.missing.empty() ? emulator::Json(true) : emulator::Json(page.missing);
  return list;
}

}  // namespace

int print_version(const Arguments&, Console& console) {
  if (console.options().json) {
    emulator::Json libraries = emulator::Json::object();
    for (const LibraryVersion& l : build_libraries()) libraries[std::string(l.name)] = l.version;
    console.document({{"kadr", KADR_VERSION},
                      {"commit", build_commit()},
                      {"compiler", build_compiler()},
                      {"build", build_flags()},
                      {"libraries", std::move(libraries)},
                      {"log_format", emulator::kLogFormat},
                      {"pages", pages()}});
    return kYes;
  }
  std::string libraries;
  for (const LibraryVersion& l : build_libraries())
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", l.name, l.version);
  console.data(
      fmt::format("kadr {}\ncommit {}\ncompiler {}\nbuild {}\nlibraries {}\nlog format {}\npages {}\n",
                  KADR_VERSION, build_commit(), build_compiler(), build_flags(), libraries,
                  emulator::kLogFormat, emulator::pages_text()));
  return kYes;
}

}  // namespace kadr::cli
