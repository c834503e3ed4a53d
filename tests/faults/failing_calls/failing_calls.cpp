// A library for LD_PRELOAD: the n-th call of one kind fails, does half of its work, or is where the program is killed.
// What the tests of tests/faults set:
//   KADR_FAULT_CALL   the kind: write short_write open rename fsync ftruncate flock unlink fchmod fchown close mmap malloc,
//                     or any: each of them, and the end of each write
//   KADR_FAULT_AT     which call of that kind fails, from 1; those before main() do not count
//   KADR_FAULT_KILL   set: SIGKILL in place of a failure; of a write half is done then
//   KADR_FAULT_MARK   a file that is made when it has failed; without it the program made fewer calls
//   KADR_FAULT_COUNT  a file for the number of calls of that kind, written when the program ends
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
}

namespace {

std::atomic<bool> begun{false};  // main() has been entered
std::atomic<long> calls{0};

/// Neither allocates nor goes through the calls of this library.
void write_file(const char* path, const char* text) {
  const long made = ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (made < 0) return;
  ::syscall(SYS_write, made, text, std::strlen(text));
  ::syscall(SYS_close, made);
}

/// Counts a call. True for the one that is to fail.
bool counts(const char* kind) {
  if (!begun) return false;
  const char* wanted = std::getenv("KADR_FAULT_CALL");
  if (!wanted || (std::strcmp(kind, wanted) != 0 && std::strcmp("any", wanted) != 0)) return false;
  const long call = ++calls;
  const char* at = std::getenv("KADR_FAULT_AT");
  if (!at || call != std::atol(at)) return false;
  if (const char* mark = std::getenv("KADR_FAULT_MARK")) write_file(mark, "");
  return true;
}

bool kills() { return std::getenv("KADR_FAULT_KILL") != nullptr; }

/// True for the call that is to fail, if the program lives to see it.
bool fails(const char* kind) {
  if (!counts(kind)) return false;
  if (kills()) ::kill(::getpid(), SIGKILL);
  return true;
}

__attribute__((destructor)) void tell_count() {
  const char* file = std::getenv("KADR_FAULT_COUNT");
  if (!file) return;
  char text[32];
  std::snprintf(text, sizeof text, "%ld", calls.load());
  write_file(file, text);
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
  if (size > 1 && counts("short_write")) {
    size /= 2;
    if (kills()) {
      ::syscall(SYS_write, fd, data, size);
      ::kill(::getpid(), SIGKILL);
    }
  }
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
int fchown(int fd, uid_t owner, gid_t group) noexcept {
  return fails("fchown") ? failed(EPERM) : next<int(int, uid_t, gid_t)>("fchown")(fd, owner, group);
}
// as of a disk that finds no room at last: the descriptor is gone all the same
int close(int fd) {
  const int done = next<int(int)>("close")(fd);
  return fails("close") ? failed(EIO) : done;
}

#define KADR_FAILING_MAP(name)                                                                               \
  void* name(void* at, size_t size, int protection, int flags, int fd, off_t offset) noexcept {              \
    if (fails("mmap")) {                                                                                     \
      errno = ENOMEM;                                                                                        \
      return MAP_FAILED;                                                                                     \
    }                                                                                                        \
    return next<void*(void*, size_t, int, int, int, off_t)>(#name)(at, size, protection, flags, fd, offset); \
  }
KADR_FAILING_MAP(mmap)
KADR_FAILING_MAP(mmap64)

// operator new of the C++ library calls malloc
void* malloc(size_t size) noexcept {
  if (!fails("malloc")) return __libc_malloc(size);
  errno = ENOMEM;
  return nullptr;
}
void* calloc(size_t count, size_t size) noexcept {
  if (!fails("malloc")) return __libc_calloc(count, size);
  errno = ENOMEM;
  return nullptr;
}
void* realloc(void* old, size_t size) noexcept {
  if (!fails("malloc")) return __libc_realloc(old, size);
  errno = ENOMEM;
  return nullptr;
}

using Main = int(int, char**, char**);
using Start = int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*);

static Main* true_main;
static int main_begins(int count, char** words, char** environment) {
  begun = true;
  return true_main(count, words, environment);
}
int __libc_start_main(Main* main_function, int count, char** words, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  true_main = main_function;
  return next<Start>("__libc_start_main")(main_begins, count, words, init, fini, rtld_fini, stack_end);
}

}  // extern "C"
