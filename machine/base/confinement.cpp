#include "machine/base/confinement.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include "machine/base/diagnostic.h"

namespace kadr {
namespace {

namespace fs = std::filesystem;

constexpr int kReadFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

/// A lookup that failed for want of memory or descriptors says nothing about where a file lies.
void refuse_fault(const std::error_code& error, const fs::path& path) {
  if (error == std::errc::not_enough_memory) throw std::bad_alloc();
  for (const std::errc fault :
       {std::errc::too_many_files_open, std::errc::too_many_files_open_in_system, std::errc::io_error})
    if (error == fault) throw std::system_error(error, path.string());
}

/// True if `path` is below `folder`, both without links.
bool lies_below(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

bool lies_within(const fs::path& real, const InputFolders& folders) {
  const auto holds = [&](const std::string& folder) {
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? "." : folder, error);
    refuse_fault(error, folder);
    return !error && lies_below(real, root);
  };
  return holds(folders.own) || std::any_of(folders.allowed.begin(), folders.allowed.end(), holds);
}

}  // namespace

std::string InputFolders::text() const {
  std::string text = own.empty() ? "the current folder" : own;
  for (const std::string& folder : allowed) text += ", " + folder;
  return text;
}

InputFile::InputFile(const std::string& name, InputFolders below)
    : path((fs::path(below.own) / name).string()), folders(std::move(below)) {}

std::string InputFile::name() const {
  if (!folders) return path == "-" ? "stdin" : path.substr(path.rfind('/') + 1);
  const std::string own = (fs::path(folders->own) / "").string();
  return path.starts_with(own) ? path.substr(own.size()) : path;
}

InputPlace place_of(const InputFile& file) {
  std::error_code error;
  const fs::path absolute = fs::absolute(file.path, error);
  const fs::path real = error ? fs::path() : fs::weakly_canonical(absolute, error);
  refuse_fault(error, file.path);
  if (error) return InputPlace::missing;
  if (file.folders && !lies_within(real, *file.folders)) return InputPlace::outside;
  const bool regular = fs::is_regular_file(real, error);
  refuse_fault(error, file.path);
  return regular ? InputPlace::inside : InputPlace::missing;
}

std::string missing_text(const InputFile& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file.path, error).type();
  const bool found = type != fs::file_type::none && type != fs::file_type::not_found;
  if (!found || type == fs::file_type::unknown) return "there is no file " + file.path;
  const char* kind = type == fs::file_type::directory ? "folder"
                     : type == fs::file_type::fifo    ? "pipe"
                                                      : "device or socket";
  return fmt::format("{} is a {}, not a file", file.path, kind);
}

int open_without_links(const std::string& path) {
  int at = ::open("/", O_PATH | O_DIRECTORY | O_CLOEXEC);
  const fs::path parts = fs::path(path).relative_path();
  for (auto part = parts.begin(); at >= 0 && part != parts.end();) {
    const fs::path name = *part++;
    const int flags = part == parts.end() ? kReadFlags : O_PATH | O_DIRECTORY | O_CLOEXEC;
    const int next = ::openat(at, name.c_str(), flags | O_NOFOLLOW);
    const int fault = errno;
    ::close(at);
    errno = fault;
    at = next;
  }
  return at;
}

int open_input(const InputFile& file) {
  if (!file.folders) return ::open(file.path.c_str(), kReadFlags);
  std::error_code error;
  const fs::path real = fs::canonical(file.path, error);
  refuse_fault(error, file.path);
  if (error) {
    errno = error.value();
    return -1;
  }
  if (!lies_within(real, *file.folders))
    throw UnreadableText(
        file.path, std::errc::operation_not_permitted,
        fmt::format("lies outside {}; --allow DIR allows files below another folder", file.folders->text()));
  return open_without_links(real.string());
}

}  // namespace kadr
