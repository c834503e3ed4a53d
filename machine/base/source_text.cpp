#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "machine/base/diagnostic.h"
#include "machine/base/input_files.h"
#include "machine/base/require.h"

namespace kadr {

// smaller files are copied: an editor that truncates a mapped file would kill us with SIGBUS
constexpr std::size_t kMapFrom_bytes = std::size_t{4} << 20;
constexpr std::size_t kIndexStride = 256;  // lines; an index of all lines would grow with the file

struct SourceText::Storage {
  std::string owned;
  void* mapped = nullptr;
  std::size_t mapped_size = 0;

  Storage() = default;
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;
  ~Storage() {
    if (mapped) ::munmap(mapped, mapped_size);
  }
};

namespace {

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd > STDERR_FILENO) ::close(fd);
  }
};

[[noreturn]] void fail(const std::string& path) {
  throw std::system_error(errno, std::generic_category(), path);
}

std::string read_all(int fd, const std::string& path, std::size_t size_hint) {
  std::string text;
  text.reserve(size_hint + 1);
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(fd, buffer, sizeof buffer);
    if (got > 0) {
      text.append(buffer, static_cast<std::size_t>(got));
    } else if (got == 0) {
      return text;
    } else if (errno != EINTR) {
      fail(path);
    }
  }
}

}  // namespace

SourceText::SourceText(std::string name, std::string text)
    : name_(std::move(name)), storage_(std::make_unique<Storage>()) {
  storage_->owned = std::move(text);
  text_ = storage_->owned;
}

SourceText SourceText::open(const std::string& path) {
  const bool input = path == "-";
  const Descriptor file{input ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.fd < 0) fail(path);
  struct stat status {};
  if (::fstat(file.fd, &status) != 0) fail(path);
  note_input_file(status);
  const auto size = static_cast<std::size_t>(status.st_size);
  const bool whole_file = S_ISREG(status.st_mode) && (!input || ::lseek(file.fd, 0, SEEK_CUR) == 0);
  if (!whole_file || size < kMapFrom_bytes) return {path, read_all(file.fd, path, whole_file ? size : 0)};

  SourceText source(path, {});
  void* mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
  if (mapped == MAP_FAILED) fail(path);
  ::madvise(mapped, size, MADV_SEQUENTIAL);
  source.storage_->mapped = mapped;
  source.storage_->mapped_size = size;
  source.text_ = {static_cast<const char*>(mapped), size};
  return source;
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

void SourceText::let_go(std::size_t begin, std::size_t end) const {
  if (storage_->mapped == nullptr) return;
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  begin -= begin % page;
  end = std::min(end, text_.size());
  end -= end % page;
  // only a hint: a system that ignores it is slower, not wrong
  if (begin < end) ::madvise(static_cast<char*>(storage_->mapped) + begin, end - begin, MADV_DONTNEED);
}

std::string_view SourceText::line(std::uint32_t number) const {
  if (line_starts_.empty()) {
    std::size_t line_index = 0;
    std::size_t held = 0;
    for (std::size_t at = 0; at != std::string_view::npos; at = next_line(text_, at)) {
      if (line_index++ % kIndexStride == 0) line_starts_.push_back(at);
      if (at - held >= kWindow_bytes) {
        let_go(held, at);
        held = at;
      }
    }
  }
  if (number == 0 || (number - 1) / kIndexStride >= line_starts_.size()) return {};
  std::size_t begin = line_starts_[(number - 1) / kIndexStride];
  for (std::size_t left = (number - 1) % kIndexStride; left > 0; --left) {
    begin = next_line(text_, begin);
    if (begin == std::string_view::npos) return {};
  }
  const std::size_t end = std::min(text_.find('\n', begin), text_.size());
  std::string_view line = text_.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::uint32_t SourceSet::add(SourceText text) {
  texts_.push_back(std::make_unique<SourceText>(std::move(text)));
  return static_cast<std::uint32_t>(texts_.size() - 1);
}

}  // namespace kadr
