#include "tests/cli/run_kadr.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace kadr::test {
namespace {

namespace fs = std::filesystem;

const std::string kProgram = std::string(KADR_BINARY_DIR) + "/kadr";

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    read = ends[0];
    write = ends[1];
  }
};

/// In the child: everything a launch asks for, then the program itself.
[[noreturn]] void become(const Launch& launch, int in, int out, int err) {
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  if (::chdir(launch.folder.c_str()) != 0) ::_exit(125);
  if (launch.file_size_limit >= 0) {
    const auto bytes = static_cast<rlim_t>(launch.file_size_limit);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  const std::string& program = launch.program.empty() ? kProgram : launch.program;
  std::vector<char*> arguments{const_cast<char*>(program.c_str())};
  for (const std::string& a : launch.arguments) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> environment;
  for (const std::string& e : launch.environment) environment.push_back(const_cast<char*>(e.c_str()));
  environment.push_back(nullptr);
  ::execve(program.c_str(), arguments.data(), environment.data());
  ::_exit(126);
}

/// Reads the available output; false at the end.
bool drain(int fd, std::string& text) {
  char buffer[1 << 16];
  const ssize_t got = ::read(fd, buffer, sizeof buffer);
  if (got <= 0) return got < 0 && (errno == EINTR || errno == EAGAIN);
  text.append(buffer, static_cast<std::size_t>(got));
  return true;
}

/// Opens a pseudo-terminal; both ends are -1 if there is none.
struct Terminal {
  int own = -1, child = -1;
};
Terminal open_terminal() {
  Terminal t;
  t.own = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (t.own >= 0 && ::grantpt(t.own) == 0 && ::unlockpt(t.own) == 0)
    t.child = ::open(::ptsname(t.own), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (t.child < 0 && t.own >= 0) ::close(std::exchange(t.own, -1));
  return t;
}

}  // namespace

bool lacks_terminals() {
  const Terminal t = open_terminal();
  for (const int fd : {t.own, t.child})
    if (fd >= 0) ::close(fd);
  if (t.own < 0) MESSAGE("skipped: this system has no pseudo-terminals (/dev/pts is not mounted)");
  return t.own < 0;
}

Finished run_kadr(const Launch& launch) {
  Pipe in, out, err;
  int terminal = -1, child_terminal = -1;
  if (launch.terminal) {
    const Terminal t = open_terminal();
    REQUIRE(t.own >= 0);
    terminal = t.own;
    child_terminal = t.child;
  }
  int file = -1;
  if (!launch.stdout_path.empty()) {
    file = ::open(launch.stdout_path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    REQUIRE(file >= 0);
  }
  const int child_out = launch.terminal ? child_terminal : file >= 0 ? file : out.write;
  const int child_err = launch.terminal ? child_terminal : err.write;
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) become(launch, launch.terminal_input ? child_terminal : in.read, child_out, child_err);
  for (const int fd : {in.read, out.write, err.write, file, child_terminal})
    if (fd >= 0) ::close(fd);
  // a program that does not read all of its input must not end this one
  std::signal(SIGPIPE, SIG_IGN);
  if (!launch.input.empty()) {
    const ssize_t written =
        ::write(launch.terminal_input ? terminal : in.write, launch.input.data(), launch.input.size());
    (void)written;
  }
  ::close(in.write);

  Finished done;
  const auto begin = std::chrono::steady_clock::now();
  pollfd sources[2] = {{launch.terminal ? terminal : out.read, POLLIN, 0}, {err.read, POLLIN, 0}};
  bool open[2] = {true, true};
  while (open[0] || open[1]) {
    ::poll(sources, 2, launch.watch ? 1 : 50);
    std::string* texts[2] = {&done.out, &done.err};
    for (int i = 0; i < 2; ++i) {
      if (open[i] && sources[i].revents != 0 && !drain(sources[i].fd, *texts[i])) {
        open[i] = false;
        sources[i].fd = -1;
      }
    }
    if (launch.watch && (open[0] || open[1])) launch.watch(child);
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(60)) ::kill(child, SIGKILL);
  }
  for (const int fd : {out.read, err.read, terminal})
    if (fd >= 0) ::close(fd);
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  done.peak_MB = static_cast<double>(used.ru_maxrss) * 1024 / 1e6;
  if (WIFEXITED(status)) done.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) done.signal = WTERMSIG(status);
  return done;
}

Finished call(std::vector<std::string> arguments, const std::string& folder, const std::string& input) {
  Launch launch;
  launch.arguments = std::move(arguments);
  launch.folder = folder;
  launch.input = input;
  return run_kadr(launch);
}

Finished shell(const std::string& command, const std::string& folder) {
  Launch launch;
  launch.program = "/bin/bash";
  launch.arguments = {"-c", command};
  launch.folder = folder;
  launch.environment = {"PATH=" KADR_BINARY_DIR ":/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8",
                        "HOME=" + folder};
  return run_kadr(launch);
}

bool has_program(const std::string& name) {
  if (shell("command -v " + name).code == 0) return true;
  MESSAGE("skipped: ", name, " is not installed");
  return false;
}

Scratch::Scratch() {
  const std::string base = std::string(KADR_BINARY_DIR) + "/scratch";
  fs::create_directories(base);
  std::string pattern = base + "/cli_XXXXXX";
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("mkdtemp " + pattern);
  path_ = pattern;
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Scratch::write(const std::string& name, const std::string& text) const {
  std::ofstream(file(name), std::ios::binary) << text;
  return name;
}

bool Scratch::has(const std::string& name) const { return fs::exists(file(name)); }

void Scratch::remove(const std::string& name) const { fs::remove(file(name)); }

std::string Scratch::read(const std::string& name) const {
  std::ostringstream text;
  text << std::ifstream(file(name), std::ios::binary).rdbuf();
  return text.str();
}

void check_golden(const std::string& name, const std::string& text) {
  const std::string path = std::string(KADR_SOURCE_DIR) + "/tests/golden/cli/" + name;
  const std::string head =
      "# made by test_cli (KADR_REGENERATE=1 rewrites it); what follows is compared byte for byte\n";
  if (const char* regenerate = std::getenv("KADR_REGENERATE"); regenerate && *regenerate == '1') {
    std::ofstream(path, std::ios::binary) << head << text;
    return;
  }
  std::ostringstream golden;
  golden << std::ifstream(path, std::ios::binary).rdbuf();
  INFO("golden file ", path);
  CHECK(head + text == golden.str());
}

std::uint64_t seed_or(std::uint64_t seed) {
  const char* text = std::getenv("KADR_SEED");
  return text ? std::strtoull(text, nullptr, 10) : seed;
}

int count_or(int count) {
  const char* text = std::getenv("KADR_COUNT");
  return text ? std::atoi(text) : count;
}

}  // namespace kadr::test
