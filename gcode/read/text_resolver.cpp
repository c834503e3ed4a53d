#include "gcode/read/text_resolver.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "machine/base/confinement.h"

namespace kadr::gcode {
namespace {

namespace fs = std::filesystem;

FoundText refuse(std::string reason, std::string help =
                                         "put the file below the program's folder, or name its "
                                         "folder with --subs") {
  return {{}, std::move(reason), std::move(help), {}, false};
}

FoundText open_text(const InputFile& file, std::uint64_t most_bytes) {
  try {
    return {open_program(file, most_bytes), {}, {}, {}, false};
  } catch (const UnreadableText& e) {
    return {{}, e.what(), {}, {}, e.code() == std::errc::file_too_large};
  }
}

}  // namespace

SourceText open_program(const InputFile& file, std::uint64_t most_bytes) {
  try {
    return SourceText::open(file, most_bytes);
  } catch (const UnreadableText& e) {
    if (e.code() != std::errc::file_too_large) throw;
    throw UnreadableText(file.path, std::errc::file_too_large, e.reason() + " (--limit file_bytes=N)");
  }
}

FolderTexts FolderTexts::beside(const std::string& program, const std::vector<std::string>& others,
                                std::uint64_t most_bytes, std::vector<std::string> allowed) {
  std::vector<std::string> folders;
  const fs::path path = program;
  if (path != "-") folders.push_back(path.has_parent_path() ? path.parent_path().string() : ".");
  folders.insert(folders.end(), others.begin(), others.end());
  return FolderTexts(std::move(folders), most_bytes, std::move(allowed));
}

FoundText FolderTexts::find(std::string_view name) const {
  if (name.find('/') != std::string_view::npos || name.find("..") != std::string_view::npos)
    return refuse("the name holds a path");
  for (const std::string& folder : folders_) {
    std::error_code error;
    const InputFile wanted(std::string(name) + ".ngc", InputFolders{folder, allowed_});
    if (!fs::exists(wanted.path, error)) continue;
    switch (place_of(wanted)) {
      case InputPlace::inside:
        return open_text(wanted, most_bytes_);
      case InputPlace::outside:
        return refuse(
            wanted.path + " is a link that leads out of its folder",
            "put the file below the program's folder, or allow the folder that it is in with --allow DIR");
      case InputPlace::missing:
        return refuse(wanted.path + " is not a plain file");
    }
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
