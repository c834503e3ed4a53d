#include <doctest/doctest.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "log_support.h"

/// A writer that is killed, interrupted, or runs out of disk at a random moment leaves a log that is readable
/// up to its last whole event and says that it was cut. Each 30 times (KADR_COUNT), moments by KADR_SEED.
using namespace kadr;
using namespace kadr::log;
using test::Random;
using test::TestFolder;

namespace {

constexpr int kInterruptedExit = 130, kDiskFullExit = 50, kNoNamespaceExit = 77, kWrongExit = 1;

volatile std::sig_atomic_t interrupted = 0;

/// Writes ticks until `ends` says so or a write fails; runs in a child process and never returns.
/// @param report  where the tick up to which the log is valid is written on an error
[[noreturn]] void write_until(const std::string& path, const machine::MachineModel& machine, int report) {
  auto log = open_lcm_log({path, ""});
  if (!log) ::_exit(kWrongExit);
  test::FakeRun run(machine);
  tl::expected<void, LogError> done = (*log)->begin(test::log_header(machine));
  std::int64_t ticks = 0;
  test::Totals totals(machine);
  for (; done && !interrupted; ++ticks) {
    const TickRecord& record = run.advance();
    totals.add(run.batch());
    done = (*log)->tick(record, run.batch());
  }
  if (done) {
    RunSummary summary = test::log_summary(machine, ticks, totals);
    summary.outcome = log::Outcome::interrupted;
    done = (*log)->end(summary);
    ::_exit(done ? kInterruptedExit : kWrongExit);
  }
  const std::int64_t valid = done.error().valid_until.value;
  const bool full =
      done.error().reason == "No space left on device" || done.error().reason == "File too large";
  // after one failure every write fails: nothing is written after the gap
  test::FakeRun again(machine);
  const TickRecord& record = again.advance();
  const bool stays = !(*log)->tick(record, again.batch()).has_value() || !(*log)->end({}).has_value();
  log->reset();  // closes the file
  if (::write(report, &valid, sizeof valid) != sizeof valid) ::_exit(kWrongExit);
  ::_exit(full && stays && done.error().path == path + ".part" ? kDiskFullExit : kWrongExit);
}

struct Child {
  pid_t id = -1;
  int report = -1;  // read end
  int wait() const {
    int status = 0;
    ::waitpid(id, &status, 0);
    return status;
  }
  std::optional<std::int64_t> reported() const {
    std::int64_t value = 0;
    if (::read(report, &value, sizeof value) != sizeof value) return std::nullopt;
    return value;
  }
  ~Child() {
    if (report >= 0) ::close(report);
  }
};

template <class F>
Child fork_child(F&& body) {
  int ends[2] = {-1, -1};
  REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
  const pid_t id = ::fork();
  REQUIRE(id >= 0);
  if (id == 0) {
    ::close(ends[0]);
    // a failed check must not let the child run on through the other tests
    try {
      body(ends[1]);
    } catch (...) {
    }
    ::_exit(kWrongExit);
  }
  ::close(ends[1]);
  return {id, ends[0]};
}

void wait_for_bytes(const std::string& path) {
  struct stat status {};
  for (int i = 0; i < 20'000 && !(::stat(path.c_str(), &status) == 0 && status.st_size > 0); ++i)
    ::usleep(500);
  REQUIRE(status.st_size > 0);
}

struct CutLog {
  LogState state;
  std::int64_t valid_until;
  std::string detail;
};

CutLog read_cut(const std::string& path) {
  auto reader = LogReader::open(path);
  REQUIRE_MESSAGE(reader.has_value(), (reader ? "" : reader.error().reason));
  for (LogMessage m; reader->next(m);) {
  }
  return {reader->end().state, reader->end().valid_until.value, reader->end().detail};
}

void write_text(const char* path, const std::string& text) {
  const int file = ::open(path, O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  if (::write(file, text.data(), text.size()) < 0) std::perror(path);
  ::close(file);
}

/// Mounts a disk of the given size at a folder, for this process and its children only. False if not allowed.
bool mount_small_disk(const std::string& folder, std::int64_t bytes) {
  const uid_t user = ::geteuid();
  const gid_t group = ::getegid();
  if (::unshare(user == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER) != 0) return false;
  if (user != 0) {
    write_text("/proc/self/setgroups", "deny");
    write_text("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
    write_text("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
  }
  const std::string size = "size=" + std::to_string(bytes);
  return ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("none", folder.c_str(), "tmpfs", 0, size.c_str()) == 0;
}

}  // namespace

TEST_CASE("kill -9 at 30 random moments leaves a log that is readable and says that it was cut") {
  Random random(test::from_environment("KADR_SEED", 5));
  const auto machine = test::log_machine(3);
  std::int64_t longest = 0;
  for (std::uint64_t run = 0; run < test::from_environment("KADR_COUNT", 30); ++run) {
    const TestFolder folder;
    const std::string path = folder / "a.lcmlog";
    const Child child = fork_child([&](int report) { write_until(path, machine, report); });
    wait_for_bytes(path + ".part");
    ::usleep(static_cast<useconds_t>(random.between(0, 30'000)));
    ::kill(child.id, SIGKILL);
    const int status = child.wait();
    REQUIRE(WIFSIGNALED(status));
    REQUIRE_FALSE(std::filesystem::exists(path));
    const CutLog log = read_cut(path + ".part");
    REQUIRE(log.state == LogState::cut_off);
    REQUIRE(log.detail.substr(0, 8) == "cut off:");
    REQUIRE(test::holds_fake_run(path + ".part", machine));
    longest = std::max(longest, log.valid_until);
  }
  CHECK(longest > 0);
}

TEST_CASE("SIGINT at 30 random moments closes the log as interrupted; its exact data go to the last tick") {
  Random random(test::from_environment("KADR_SEED", 6));
  const auto machine = test::log_machine(3);
  for (std::uint64_t run = 0; run < test::from_environment("KADR_COUNT", 30); ++run) {
    const TestFolder folder;
    const std::string path = folder / "a.lcmlog";
    const Child child = fork_child([&](int report) {
      std::signal(SIGINT, [](int) { interrupted = 1; });
      write_until(path, machine, report);
    });
    wait_for_bytes(path + ".part");
    ::usleep(static_cast<useconds_t>(random.between(0, 20'000)));
    ::kill(child.id, SIGINT);
    const int status = child.wait();
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == kInterruptedExit);
    REQUIRE_FALSE(std::filesystem::exists(path));
    const CutLog log = read_cut(path + ".part");
    REQUIRE(log.state == LogState::interrupted);
    REQUIRE(log.detail.substr(0, 20) == "interrupted at tick ");
    REQUIRE(test::holds_fake_run(path + ".part", machine));
  }
}

TEST_CASE(
    "a file size limit at 30 random sizes stops the log with its reason; what it says is valid can be read") {
  Random random(test::from_environment("KADR_SEED", 7));
  const auto machine = test::log_machine(3);
  std::int64_t longest = 0;
  for (std::uint64_t run = 0; run < test::from_environment("KADR_COUNT", 30); ++run) {
    const TestFolder folder;
    const std::string path = folder / "a.lcmlog";
    const auto limit = static_cast<rlim_t>(random.between(1500, 500'000));
    const Child child = fork_child([&](int report) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit bound{limit, limit};
      if (::setrlimit(RLIMIT_FSIZE, &bound) != 0) ::_exit(kWrongExit);
      write_until(path, machine, report);
    });
    const int status = child.wait();
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == kDiskFullExit);
    const auto reported = child.reported();
    REQUIRE(reported.has_value());
    REQUIRE(std::filesystem::file_size(path + ".part") <= limit);
    const CutLog log = read_cut(path + ".part");
    REQUIRE(log.state == LogState::cut_off);
    REQUIRE(log.valid_until >= *reported);
    REQUIRE(test::holds_fake_run(path + ".part", machine));
    longest = std::max(longest, *reported);
  }
  CHECK(longest > 0);
}

TEST_CASE("a full disk of 30 random sizes stops the log with its reason; what it says is valid can be read") {
  Random random(test::from_environment("KADR_SEED", 8));
  const auto machine = test::log_machine(3);
  std::uint64_t filled = 0;
  const auto count = test::from_environment("KADR_COUNT", 30);
  for (std::uint64_t run = 0; run < count; ++run) {
    const TestFolder folder;
    const std::int64_t bytes = 4096 * random.between(1, 100);
    // a disk of its own for the child, seen by nobody else and gone with it; so it reads its log back itself
    const Child child = fork_child([&](int) {
      if (!mount_small_disk(folder.path(), bytes)) ::_exit(kNoNamespaceExit);
      const std::string path = folder / "a.lcmlog";
      const Child writer = fork_child([&](int report) { write_until(path, machine, report); });
      const int status = writer.wait();
      if (!WIFEXITED(status) || WEXITSTATUS(status) != kDiskFullExit) ::_exit(kWrongExit);
      const auto reported = writer.reported();
      const CutLog log = read_cut(path + ".part");
      const bool good = reported && log.state == LogState::cut_off && log.valid_until >= *reported &&
                        test::holds_fake_run(path + ".part", machine);
      ::_exit(good ? 0 : kWrongExit);
    });
    const int status = child.wait();
    REQUIRE(WIFEXITED(status));
    if (WEXITSTATUS(status) == kNoNamespaceExit) break;
    REQUIRE(WEXITSTATUS(status) == 0);
    ++filled;
  }
  if (filled == 0) MESSAGE("not tested: this host lets nobody mount a small disk (user namespaces are off)");
  CHECK((filled == 0 || filled == count));
}
