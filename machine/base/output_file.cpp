#include "machine/base/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <utility>

#include "machine/base/hash.h"
#include "machine/base/input_files.h"
#include "machine/base/terminal_text.h"
#include "machine/base/write_all.h"

namespace kadr {
namespace {

namespace fs = std::filesystem;

/// Whole blocks of a log reach the kernel together.
constexpr std::size_t kBuffer_bytes = std::size_t{1} << 18;
constexpr int kMostLinks = 40;
/// Each attempt but the last lost a race against a writer that came or went.
constexpr int kAttempts = 100;

bool same(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// "FILE.part", the end of a long name replaced by a hash of it: a name has at most NAME_MAX bytes.
std::string part_of(const std::string& file) {
  constexpr std::string_view kPart = ".part";
  constexpr std::size_t kHash = 17;  // "-" and 16 digits
  const std::string name = fs::path(file).filename().string();
  if (name.size() + kPart.size() <= NAME_MAX) return file + std::string(kPart);
  Hash64 hash;
  hash.bytes(name.data(), name.size());
  const std::size_t kept = file.size() - name.size() + NAME_MAX - kHash - kPart.size();
  return file.substr(0, kept) + "-" + hash_text(hash.digest()) + std::string(kPart);
}

/// What `path` is, links followed; nullopt if there is no such file.
std::optional<struct stat> status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

/// True if `path`, no link followed, is the file of this descriptor.
bool names(const std::string& path, int fd) {
  struct stat own {
  }, named{};
  return ::fstat(fd, &own) == 0 && ::lstat(path.c_str(), &named) == 0 && same(own, named);
}

/// True if `path`, links followed, is the file of this descriptor.
bool leads_to(const std::string& path, int fd) {
  struct stat own {};
  const auto status = status_of(path);
  return status && ::fstat(fd, &own) == 0 && same(*status, own);
}

/// The descriptor of standard output or standard error if that is what `status` names, and it can be written; else -1.
int standard_stream(const struct stat& status) {
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat stream {};
    if (::fstat(fd, &stream) != 0 || !same(stream, status)) continue;
    if ((::fcntl(fd, F_GETFL) & O_ACCMODE) != O_RDONLY) return fd;
  }
  return -1;
}

/// The file that a path leads to through its links; it need not exist.
tl::expected<std::string, int> follow(const std::string& path) {
  fs::path file = path;
  std::error_code error;
  for (int links = 0; links < kMostLinks; ++links) {
    if (!fs::is_symlink(fs::symlink_status(file, error))) return file.string();
    const fs::path target = fs::read_symlink(file, error);
    if (error) return tl::unexpected(error.value());
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  return tl::unexpected(ELOOP);
}

/// `-` names standard output; a file of that name is ./-
constexpr std::string_view kStandardOutput = "-";

bool is_stream(const struct stat& status) {
  return S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode) || standard_stream(status) >= 0;
}

std::optional<OutputFault> refusal_of(const std::string& path, const struct stat& status, OutputRules rules) {
  const auto refuse = [&](std::string reason) { return OutputFault{path, std::move(reason)}; };
  if (!rules.overwrite) return refuse(std::strerror(EEXIST));
  if (!rules.own_input && is_input_file(status)) return refuse("this output would overwrite an input");
  if (is_stream(status)) return std::nullopt;
  if (S_ISDIR(status.st_mode)) return refuse("is a folder");
  if (!S_ISREG(status.st_mode)) return refuse("is neither a regular file, nor a pipe or character device");
  if (!rules.own_input && is_output_file(status))
    return refuse("this output would overwrite another one of this command");
  if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) return refuse(std::strerror(errno));
  return std::nullopt;
}

/// Gives a new file mode, group and owner of the one that it replaces. Where the system refuses, it belongs to who
/// wrote it; another group gets what all others have.
void keep_permissions(int fd, const struct stat& replaced) {
  struct stat own {};
  if (::fstat(fd, &own) != 0) return;
  mode_t mode = replaced.st_mode & 0777;
  constexpr auto kSameOwner = static_cast<uid_t>(-1);
  constexpr auto kSameGroup = static_cast<gid_t>(-1);
  if (own.st_gid != replaced.st_gid && ::fchown(fd, kSameOwner, replaced.st_gid) != 0)
    mode = (mode & ~mode_t{070}) | ((mode & mode_t{07}) << 3U);
  if (::fchmod(fd, mode) != 0) errno = 0;
  if (own.st_uid != replaced.st_uid && ::fchown(fd, replaced.st_uid, kSameGroup) != 0) errno = 0;
}

/// A file that is left over from a writer that was killed, or belongs to one at work; `taken`: an input or output.
enum class Leftover : std::uint8_t { removed, busy, not_a_file, taken };

Leftover remove_leftover(const std::string& part) {
  constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY;
  // NFS locks only what is open to write; what others left may be only read
  int fd = ::open(part.c_str(), O_RDWR | kFlags);
  if (fd < 0 && errno == EACCES) fd = ::open(part.c_str(), O_RDONLY | kFlags);
  if (fd < 0) return errno == ENOENT ? Leftover::removed : Leftover::not_a_file;
  struct stat own {
  }, named{};
  Leftover found = Leftover::removed;
  if (::fstat(fd, &own) != 0 || !S_ISREG(own.st_mode))
    found = Leftover::not_a_file;
  else if (is_input_file(own) || is_output_file(own))
    found = Leftover::taken;
  else if (::flock(fd, LOCK_EX | LOCK_NB) != 0)
    found = errno == EWOULDBLOCK ? Leftover::busy : Leftover::not_a_file;
  else if (::lstat(part.c_str(), &named) == 0 && same(own, named) && ::unlink(part.c_str()) != 0)
    found = Leftover::not_a_file;
  ::close(fd);
  return found;
}

/// Hands the entry of a new name to the disk. A file system that has no such call is taken as it is.
bool sync_folder(const fs::path& file) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return errno == EACCES;
  const bool synced = ::fsync(fd) == 0 || errno == EINVAL;
  const int reason = errno;
  ::close(fd);
  errno = reason;
  return synced;
}

/// rename(), but never over a file that has come to that name meanwhile.
bool rename_to_new(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // this file system does not know that flag
  struct stat there {};
  if (::lstat(to.c_str(), &there) == 0) {
    errno = EEXIST;
    return false;
  }
  return ::rename(from.c_str(), to.c_str()) == 0;
}

}  // namespace

std::optional<OutputFault> output_refusal(const std::string& path, OutputRules rules) {
  if (path == kStandardOutput) return std::nullopt;
  struct stat link {};
  if (!rules.overwrite && ::lstat(path.c_str(), &link) == 0) return OutputFault{path, std::strerror(EEXIST)};
  const auto status = status_of(path);
  if (!status) {
    if (errno == ENOENT) return std::nullopt;
    return OutputFault{path, std::strerror(errno)};
  }
  return refusal_of(path, *status, rules);
}

std::string written_as(const std::string& path) {
  if (path == kStandardOutput) return path;
  const auto status = status_of(path);
  if (status && is_stream(*status)) return path;
  return part_of(follow(path).value_or(path));
}

bool is_standard_output(const std::string& path) {
  return path == kStandardOutput || leads_to(path, STDOUT_FILENO);
}
bool is_standard_error(const std::string& path) { return leads_to(path, STDERR_FILENO); }

tl::expected<OutputFile, OutputFault> OutputFile::open(const std::string& path, OutputRules rules) {
  OutputFile output(path, rules);
  if (auto refused = output_refusal(path, rules)) return tl::unexpected(std::move(*refused));
  if (path == kStandardOutput) {
    if (auto fault = output.open_stream(STDOUT_FILENO)) return tl::unexpected(std::move(*fault));
    return output;
  }
  const auto status = status_of(path);
  if (status && is_stream(*status)) {
    if (auto fault = output.open_stream(standard_stream(*status))) return tl::unexpected(std::move(*fault));
    return output;
  }
  auto file = follow(path);
  if (!file) return tl::unexpected(OutputFault{path, std::strerror(file.error())});
  // what replaces a file is as private as that was, from its first moment
  if (auto fault = output.open_part(std::move(*file), status ? 0600U : 0666U))
    return tl::unexpected(std::move(*fault));
  if (status) keep_permissions(output.fd_, *status);
  return output;
}

std::optional<OutputFault> OutputFile::open_stream(int descriptor) {
  // standard output has a place of its own in a file, and may be what can't be opened again
  fd_ = descriptor >= 0 ? ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)
                        : ::open(path_.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (fd_ < 0) return OutputFault{path_, std::strerror(errno)};
  struct stat status {};
  if (::fstat(fd_, &status) != 0 || (descriptor < 0 && !is_stream(status)))
    return OutputFault{path_, "was replaced by another file while it was opened"};
  terminal_ = ::isatty(fd_) != 0;
  return std::nullopt;
}

std::optional<OutputFault> OutputFile::open_part(std::string file, unsigned mode) {
  file_ = std::move(file);
  part_ = part_of(file_);
  const std::string shown = rules_.keeps_part ? part_ : path_;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    fd_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (fd_ >= 0) {
      // a file system without locks still has O_EXCL
      const bool locked = ::flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
      if (locked && names(part_, fd_)) return std::nullopt;
      // another writer has taken it for a leftover before it was locked
      ::close(std::exchange(fd_, -1));
      continue;
    }
    if (errno != EEXIST) return OutputFault{shown, std::strerror(errno)};
    switch (remove_leftover(part_)) {
      case Leftover::removed:
        continue;
      case Leftover::busy:
        return OutputFault{path_, fmt::format("another kadr is writing it: {} is locked", part_)};
      case Leftover::taken:
        return OutputFault{
            path_, fmt::format("this output would overwrite an input or another output: it is written as {}",
                               part_)};
      case Leftover::not_a_file:
        return OutputFault{
            path_, fmt::format("it is written as {} first, and what has that name can't be replaced", part_)};
    }
  }
  return OutputFault{path_, fmt::format("others are writing it: {} never became free", part_)};
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      rules_(other.rules_),
      file_(std::move(other.file_)),
      part_(std::move(other.part_)),
      fd_(std::exchange(other.fd_, -1)),
      terminal_(other.terminal_),
      buffer_(std::move(other.buffer_)),
      fault_(std::move(other.fault_)) {}

OutputFile::~OutputFile() {
  if (fd_ < 0) return;
  if (rules_.keeps_part || part_.empty()) {
    // a file that ends early holds what was written, but nothing behind a gap
    if (!fault_) put(buffer_);
  } else if (names(part_, fd_)) {
    ::unlink(part_.c_str());
  }
  ::close(fd_);
}

bool OutputFile::put(std::string_view bytes) noexcept {
  if (!terminal_) return write_all(fd_, bytes);
  try {
    return write_all(fd_, shown_text(bytes));
  } catch (const std::bad_alloc&) {
    errno = ENOMEM;
    return false;
  }
}

OutputFile::Done OutputFile::fail(int number) {
  return fail(rules_.keeps_part && !part_.empty() ? part_ : path_,
              number == 0 ? "unknown error" : std::strerror(number));
}

OutputFile::Done OutputFile::fail(const std::string& where, std::string reason) {
  fault_ = OutputFault{where, std::move(reason)};
  return tl::unexpected(*fault_);
}

OutputFile::Done OutputFile::write(std::string_view bytes) {
  if (fault_) return tl::unexpected(*fault_);
  if (buffer_.size() + bytes.size() > kBuffer_bytes)
    if (auto done = flush(); !done) return done;
  if (bytes.size() < kBuffer_bytes) {
    buffer_ += bytes;
    return {};
  }
  return put(bytes) ? Done{} : fail(errno);
}

OutputFile::Done OutputFile::flush() {
  if (fault_) return tl::unexpected(*fault_);
  if (!put(buffer_)) return fail(errno);
  buffer_.clear();
  return {};
}

/// The names must still mean what they meant when the file was opened: a long run gives others time.
OutputFile::Done OutputFile::check_name() {
  if (!names(part_, fd_))
    return fail(path_, fmt::format("{} was moved or replaced while it was written", part_));
  struct stat named {};
  if (::lstat(file_.c_str(), &named) != 0) return {};
  if (S_ISLNK(named.st_mode)) return fail(path_, "became a link while it was written");
  if (auto refused = refusal_of(path_, named, rules_)) return fail(path_, refused->reason);
  if (is_stream(named)) return fail(path_, "became a pipe or device while it was written");
  return {};
}

OutputFile::Done OutputFile::close() {
  const int fd = std::exchange(fd_, -1);
  return ::close(fd) == 0 ? Done{} : fail(errno);
}

OutputFile::Done OutputFile::leave() {
  if (auto done = flush(); !done) return done;
  if (!part_.empty() && ::fsync(fd_) != 0 && errno != EINVAL) return fail(errno);
  return close();
}

OutputFile::Done OutputFile::finish() {
  if (part_.empty()) return leave();
  if (auto done = flush(); !done) return done;
  if (::fsync(fd_) != 0 && errno != EINVAL) return fail(errno);
  if (auto done = check_name(); !done) return done;
  const bool renamed =
      rules_.overwrite ? ::rename(part_.c_str(), file_.c_str()) == 0 : rename_to_new(part_, file_);
  if (!renamed) return fail(path_, std::strerror(errno));
  // from here on the file is whole under its name; the lock goes with the descriptor
  part_.clear();
  struct stat own {};
  if (::fstat(fd_, &own) == 0) note_output_file(own);
  if (!sync_folder(file_)) return fail(path_, std::strerror(errno));
  return close();
}

}  // namespace kadr
