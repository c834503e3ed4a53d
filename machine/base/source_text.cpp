#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <utility>

#include "machine/base/confinement.h"
#include "machine/base/diagnostic.h"
#include "machine/base/input_files.h"

namespace kadr {

// an index of all lines would grow with the file
constexpr std::uint32_t kIndexStride = 256;
constexpr std::size_t kIndexStride_bytes = std::size_t{1} << 16;

namespace {

constexpr std::size_t kPiece_bytes = std::size_t{1} << 16;

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd > STDERR_FILENO) ::close(fd);
  }
};

[[noreturn]] void fail(const std::string& path) {
  const auto code = static_cast<std::errc>(errno);
  throw UnreadableText(path, code, std::make_error_code(code).message());
}

[[noreturn]] void refuse_size(const std::string& path, const std::string& size, std::uint64_t most_bytes) {
  throw UnreadableText(path, std::errc::file_too_large,
                       fmt::format("{} bytes; at most {} are read", size, most_bytes));
}

struct stat status_of(int fd, const std::string& path) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) fail(path);
  return status;
}

/// Only a regular file has an end that is known before it is read.
void require_regular(const struct stat& status, const std::string& path) {
  if (S_ISREG(status.st_mode)) return;
  if (S_ISDIR(status.st_mode))
    throw UnreadableText(path, std::errc::is_a_directory,
                         std::make_error_code(std::errc::is_a_directory).message());
  throw UnreadableText(path, std::errc::invalid_argument,
                       S_ISFIFO(status.st_mode) ? "is a pipe, not a file; `-` reads standard input"
                                                : "is a device or socket, not a file");
}

/// Appends what can be read, at most `most_bytes` + 1 bytes if that is not 0.
void read_rest(int fd, const std::string& path, std::uint64_t most_bytes, std::string& text) {
  for (;;) {
    const std::size_t have = text.size();
    if (most_bytes != 0 && have > most_bytes) return;
    // a file that is no larger than it was needs no more than what was reserved; a pipe gives little at a time, and
    // clearing all that is reserved for each piece would take the square of its bytes
    const std::size_t room = text.capacity() > have ? text.capacity() - have : kPiece_bytes;
    const std::size_t wanted = std::min(room, kPiece_bytes);
    text.resize(have + wanted);
    const ssize_t got = ::read(fd, text.data() + have, wanted);
    text.resize(have + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return;
    if (got < 0 && errno != EINTR) fail(path);
  }
}

bool same_content(const struct stat& a, const struct stat& b) {
  return a.st_size == b.st_size && a.st_mtim.tv_sec == b.st_mtim.tv_sec &&
         a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

std::string read_file(int fd, const std::string& path, std::uint64_t most_bytes) {
  const struct stat before = status_of(fd, path);
  require_regular(before, path);
  note_input_file(before);
  const auto size = static_cast<std::uint64_t>(before.st_size);
  if (most_bytes != 0 && size > most_bytes) refuse_size(path, std::to_string(size), most_bytes);
  std::string text;
  text.reserve(size + 1);
  read_rest(fd, path, most_bytes, text);
  // files of the kernel have no size until they are read
  const bool whole = text.size() == size || size == 0;
  if (!whole || !same_content(before, status_of(fd, path)))
    throw UnreadableText(path, std::errc::io_error, "changed while it was read");
  if (most_bytes != 0 && text.size() > most_bytes)
    refuse_size(path, fmt::format("more than {}", most_bytes), most_bytes);
  return text;
}

std::string read_input(const std::string& path, std::uint64_t most_bytes) {
  note_input_file(status_of(STDIN_FILENO, path));
  std::string text;
  read_rest(STDIN_FILENO, path, most_bytes, text);
  if (most_bytes != 0 && text.size() > most_bytes)
    refuse_size(path, fmt::format("more than {}", most_bytes), most_bytes);
  return text;
}

}  // namespace

UnreadableText::UnreadableText(const std::string& path, std::errc code, std::string reason)
    : std::system_error(std::make_error_code(code)),
      reason_(std::move(reason)),
      what_(fmt::format("{}: {}", path == "-" ? "standard input" : path, reason_)) {}

SourceText::SourceText(std::string name, std::string text)
    : name_(std::move(name)), text_(std::make_unique<const std::string>(std::move(text))) {}

SourceText SourceText::open(const InputFile& file, std::uint64_t most_bytes) {
  const std::string& path = file.path;
  if (path == "-" && !file.folders) return {path, read_input(path, most_bytes)};
  const Descriptor opened{open_input(file)};
  if (opened.fd < 0) fail(path);
  return {path, read_file(opened.fd, path, most_bytes)};
}

SourceText SourceText::open(const std::string& path, std::uint64_t most_bytes) {
  return open(InputFile(path), most_bytes);
}

SourceText::SourceText(SourceText&&) noexcept = default;
SourceText& SourceText::operator=(SourceText&&) noexcept = default;
SourceText::~SourceText() = default;

namespace {

/// Index behind the line feed that ends the line at `at`; npos if none does.
std::size_t next_line(std::string_view text, std::size_t at) {
  const std::size_t newline = text.find('\n', at);
  return newline == std::string_view::npos ? newline : newline + 1;
}

}  // namespace

void SourceText::index_lines() const {
  line_starts_.push_back({});
  LineStart line;
  while ((line.at = next_line(text(), line.at)) != std::string_view::npos) {
    ++line.number;
    const LineStart& known = line_starts_.back();
    if (line.number - known.number >= kIndexStride || line.at - known.at >= kIndexStride_bytes)
      line_starts_.push_back(line);
  }
}

std::string_view SourceText::line(std::uint32_t number) const {
  if (line_starts_.empty()) index_lines();
  if (number == 0) return {};
  const auto behind =
      std::upper_bound(line_starts_.begin(), line_starts_.end(), number,
                       [](std::uint32_t wanted, const LineStart& start) { return wanted < start.number; });
  LineStart start = *std::prev(behind);
  for (; start.number < number; ++start.number) {
    start.at = next_line(text(), start.at);
    if (start.at == std::string_view::npos) return {};
  }
  const std::size_t end = std::min(text().find('\n', start.at), text().size());
  std::string_view line = text().substr(start.at, end - start.at);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::uint32_t SourceSet::add(SourceText text) {
  texts_.push_back(std::make_unique<SourceText>(std::move(text)));
  return static_cast<std::uint32_t>(texts_.size() - 1);
}

}  // namespace kadr
