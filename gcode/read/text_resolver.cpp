#include "gcode/read/text_resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace kadr::gcode {
namespace {

namespace fs = std::filesystem;

/// True if `path` is below `folder`, both without symbolic links.
bool lies_below(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

FoundText refuse(std::string reason) {
  return {{},
          std::move(reason),
          "put the file below the program's folder, or name its folder with --subs",
          {},
          false};
}

FoundText open_text(const std::string& path, std::uint64_t most_bytes) {
  try {
    return {SourceText::open(path, most_bytes), {}, {}, {}, false};
  } catch (const UnreadableText& e) {
    const bool too_large = e.code() == std::errc::file_too_large;
    return {{}, fmt::format("{}{}", e.what(), too_large ? " (--limit file_bytes=N)" : ""), {}, {}, too_large};
  }
}

}  // namespace

FolderTexts FolderTexts::beside(const std::string& program, const std::vector<std::string>& others,
                                std::uint64_t most_bytes) {
  std::vector<std::string> folders;
  const fs::path path = program;
  if (path != "-") folders.push_back(path.has_parent_path() ? path.parent_path().string() : ".");
  folders.insert(folders.end(), others.begin(), others.end());
  return FolderTexts(std::move(folders), most_bytes);
}

FoundText FolderTexts::find(std::string_view name) const {
  if (name.find('/') != std::string_view::npos || name.find("..") != std::string_view::npos)
    return refuse("the name holds a path");
  for (const std::string& folder : folders_) {
    std::error_code error;
    const fs::path wanted = fs::path(folder) / (std::string(name) + ".ngc");
    if (!fs::exists(wanted, error)) continue;
    const fs::path root = fs::canonical(folder, error);
    const fs::path real = error ? fs::path() : fs::canonical(wanted, error);
    if (error) return refuse(wanted.string() + ": " + error.message());
    if (!lies_below(real, root)) return refuse(wanted.string() + " is a link that leads out of its folder");
    if (!fs::is_regular_file(real, error)) return refuse(wanted.string() + " is not a plain file");
    return open_text(wanted.string(), most_bytes_);
  }
  std::string looked;
  for (const std::string& folder : folders_) looked += (looked.empty() ? "" : ", ") + folder;
  return {{},
          {},
          {},
          looked.empty() ? "a program from standard input has no folder; --subs names one"
                         : fmt::format("kadr looked for {}.ngc in {}", name, looked),
          false};
}

FoundText MemoryTexts::find(std::string_view name) const {
  if (const auto text = texts_.find(name); text != texts_.end())
    return {SourceText(text->first + ".ngc", text->second), {}, {}, {}, false};
  if (behind_) return behind_->find(name);
  return {{}, {}, {}, fmt::format("{}.ngc is not among the files at hand", name), false};
}

}  // namespace kadr::gcode
