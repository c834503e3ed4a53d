#pragma once
#include <span>
#include <string_view>

/// How this program was built, for `kadr version` alone: nothing here reaches a log, a page or a summary,
/// which depend on their inputs only.
namespace kadr::cli {

struct LibraryVersion {
  std::string_view name;
  std::string_view version;  ///< of the headers it was compiled with
};

std::string_view build_compiler();  ///< "gcc 12.2.0"
std::string_view build_flags();     ///< "Release, -O3"; "Release, -O3, hardened"
std::span<const LibraryVersion> build_libraries();
/// "a659377", "v0.1.0-5-ga659377-dirty": the output of `git describe` for the sources; "unknown" without git.
std::string_view build_commit();

}  // namespace kadr::cli
