// A library for LD_PRELOAD: the n-th call of one kind fails, or does half of its work. What the tests of tests/faults set:
//   KADR_FAULT_CALL  the kind: write short_write open rename fsync ftruncate flock unlink fchmod
//   KADR_FAULT_AT    which call of that kind fails, from 1
//   KADR_FAULT_MARK  a file that is made when it has failed; without it the program made fewer calls
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

/// True for the call that is to fail.
bool fails(const char* kind) {
  const char* wanted = std::getenv("KADR_FAULT_CALL");
  const char* at = std::getenv("KADR_FAULT_AT");
  const char* mark = std::getenv("KADR_FAULT_MARK");
  if (!wanted || !at || !mark || std::strcmp(kind, wanted) != 0 || ++calls != std::atol(at)) return false;
  const long made = ::syscall(SYS_openat, AT_FDCWD, mark, O_WRONLY | O_CREAT, 0600);
  if (made >= 0) ::syscall(SYS_close, made);
  return true;
}

int failed(int number) {
  errno = number;
  return -1;
}

/// The same function of the next library, the C library's.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* data, size_t size) {
  if (fails("write")) return failed(ENOSPC);
  if (size > 1 && fails("short_write")) size /= 2;
  return next<ssize_t(int, const void*, size_t)>("write")(fd, data, size);
}

// the mode is read whether it was given or not, as the kernel does
#define KADR_FAILING_OPEN(name)                                        \
  int name(const char* path, int flags, ...) {                         \
    va_list rest;                                                      \
    va_start(rest, flags);                                             \
    const mode_t mode = va_arg(rest, mode_t);                          \
    va_end(rest);                                                      \
    if (fails("open")) return failed(EIO);                             \
    return next<int(const char*, int, ...)>(#name)(path, flags, mode); \
  }
KADR_FAILING_OPEN(open)
KADR_FAILING_OPEN(open64)

// what a fortified program calls where no mode is given
int __open_2(const char* path, int flags) {
  return fails("open") ? failed(EIO) : next<int(const char*, int)>("__open_2")(path, flags);
}
int __open64_2(const char* path, int flags) {
  return fails("open") ? failed(EIO) : next<int(const char*, int)>("__open64_2")(path, flags);
}

int rename(const char* from, const char* to) noexcept {
  return fails("rename") ? failed(EIO) : next<int(const char*, const char*)>("rename")(from, to);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (fails("rename")) return failed(EIO);
  return next<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder,
                                                                              to, flags);
}
int fsync(int fd) { return fails("fsync") ? failed(EIO) : next<int(int)>("fsync")(fd); }
int ftruncate(int fd, off_t size) noexcept {
  return fails("ftruncate") ? failed(EIO) : next<int(int, off_t)>("ftruncate")(fd, size);
}
// flock() under another name in here, since <fcntl.h> has a type of that name
int lock_file(int fd, int operation) noexcept __asm__("flock");
int lock_file(int fd, int operation) noexcept {
  return fails("flock") ? failed(ENOLCK) : next<int(int, int)>("flock")(fd, operation);
}
int unlink(const char* path) noexcept {
  return fails("unlink") ? failed(EIO) : next<int(const char*)>("unlink")(path);
}
int fchmod(int fd, mode_t mode) noexcept {
  return fails("fchmod") ? failed(EPERM) : next<int(int, mode_t)>("fchmod")(fd, mode);
}

}  // extern "C"
