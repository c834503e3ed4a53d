#include "tests/storm/isolation.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <csignal>
#include <deque>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "tests/storm/draw.h"

namespace kadr::storm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kBatch = 25;             // seeds of a process
constexpr rlim_t kMostMemory = rlim_t{3} << 30;  // of address space
constexpr auto kLongestSilence = std::chrono::seconds(240);

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

std::string written(const SeedResult& result) {
  std::string text;
  const Checked& c = result.checked;
  text += fmt::format("end {}\ncost {} {}\n", one_line(c.end), c.cpu_s, c.ticks);
  for (const auto& [what, count] : c.met) text += fmt::format("met {} {}\n", count, what);
  for (const std::string& feature : result.features) text += "has " + one_line(feature) + "\n";
  if (c.finding)
    text += fmt::format("finding {} {}\n", static_cast<int>(c.finding->invariant), one_line(c.finding->text));
  return text + fmt::format("done {}\n", result.seed);
}

/// Takes one line of what written() made.
void read_line(const std::string& line, SeedResult& result) {
  const auto space = line.find(' ');
  const std::string key = line.substr(0, space),
                    rest = space == std::string::npos ? "" : line.substr(space + 1);
  std::istringstream words(rest);
  if (key == "end") result.checked.end = rest;
  if (key == "cost") words >> result.checked.cpu_s >> result.checked.ticks;
  if (key == "has") result.features.push_back(rest);
  if (key == "met") {
    std::int64_t count = 0;
    words >> count;
    std::string what;
    std::getline(words >> std::ws, what);
    result.checked.met[what] = count;
  }
  if (key == "finding") {
    std::size_t number = 0;
    words >> number;
    std::string text;
    std::getline(words >> std::ws, text);
    if (number < std::size(kInvariants.words))
      result.checked.finding = Finding{kInvariants.words[number].value, text};
  }
}

void bound_memory() {
  const rlimit memory{kMostMemory, kMostMemory}, core{0, 0};
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CORE, &core);
}

/// So much processor time from now on.
void bound_time(int most_cpu_s) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  rlimit limit{};
  ::getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur =
      static_cast<rlim_t>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) + static_cast<rlim_t>(most_cpu_s);
  ::setrlimit(RLIMIT_CPU, &limit);
}

void put(int fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(fd, text.data() + at, text.size() - at);
    if (n <= 0) ::_exit(120);
    at += static_cast<std::size_t>(n);
  }
}

Finding of_status(int status, bool silent) {
  if (silent) return {Invariant::time_bounded, "the process stands still"};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return {Invariant::time_bounded, "more processor time than is allowed"};
  if (WIFSIGNALED(status)) return {Invariant::no_crash, fmt::format("signal {}", WTERMSIG(status))};
  return {Invariant::no_crash, fmt::format("the process ends with {}", WEXITSTATUS(status))};
}

/// A process that looks at some cases; what it says is read as it comes.
class Worker {
 public:
  template <class Body>
  explicit Worker(Body&& body) : last_word_(Clock::now()) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("no process");
    if (pid_ == 0) {
      ::close(ends[0]);
      bound_memory();
      body(ends[1]);
      ::_exit(0);
    }
    ::close(ends[1]);
    fd_ = ends[0];
  }
  int fd() const { return fd_; }

  /// Reads what there is. @return false at the end
  bool read(const std::function<void(const std::string& line)>& take) {
    char buffer[1 << 14];
    const ssize_t n = ::read(fd_, buffer, sizeof buffer);
    if (n <= 0) return false;
    last_word_ = Clock::now();
    text_.append(buffer, static_cast<std::size_t>(n));
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1))
      take(text_.substr(0, end));
    return true;
  }
  /// Ends a process that says nothing any more.
  void end_silence() {
    if (silent_ || Clock::now() - last_word_ < kLongestSilence) return;
    silent_ = true;
    ::kill(pid_, SIGKILL);
  }
  /// @return nothing if it ended well
  Verdict finish() {
    ::close(fd_);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    if (!silent_ && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    return of_status(status, silent_);
  }

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
  bool silent_ = false;
  std::string text_;
  Clock::time_point last_word_;
};

struct Range {
  std::uint64_t first, last;
};

/// One process of the storm and what it has not done yet.
struct Job {
  Worker worker;
  Range left;
  SeedResult under_way;
};

}  // namespace

Checked isolated_check(const StormCase& storm_case, std::uint64_t seed, const CheckOptions& options) {
  SeedResult result;
  Worker worker([&](int fd) {
    bound_time(options.most_cpu_s);
    SeedResult own;
    own.checked = check_case(storm_case, seed, options);
    put(fd, written(own));
  });
  pollfd source{worker.fd(), POLLIN, 0};
  for (;;) {
    if (::poll(&source, 1, 500) == 0)
      worker.end_silence();
    else if (!worker.read([&](const std::string& line) { read_line(line, result); }))
      break;
  }
  if (auto wrong = worker.finish(); wrong && !result.checked.finding) result.checked.finding = wrong;
  return result.checked;
}

bool has_fault(std::uint64_t seed, const StormOptions& options) {
  return mixed(seed ^ 0x5EED) % 1000 < static_cast<std::uint64_t>(options.world_per_mille);
}

void storm(const StormOptions& options, const std::function<void(const SeedResult&)>& take) {
  const auto end = Clock::now() + std::chrono::duration<double>(60 * options.minutes);
  const auto begin_job = [&](Range range, int number) {
    CheckOptions check = options.check;
    check.scratch += fmt::format("/job{}", number);
    return Job{Worker([&, check](int fd) {
                 for (std::uint64_t seed = range.first; seed <= range.last; ++seed) {
                   if (options.minutes > 0 && Clock::now() > end) break;
                   bound_time(check.most_cpu_s);
                   SeedResult result;
                   result.seed = seed;
                   const StormCase storm_case = make_case(seed, has_fault(seed, options));
                   result.features = features_of(storm_case);
                   result.checked = check_case(storm_case, seed, check);
                   put(fd, written(result));
                 }
               }),
               range,
               {}};
  };
  std::uint64_t next = options.first;
  std::deque<Range> again;  // what a process that failed has left
  std::vector<std::optional<Job>> jobs(static_cast<std::size_t>(options.jobs));
  for (;;) {
    const bool late = options.minutes > 0 && Clock::now() > end;
    std::vector<pollfd> sources;
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (!jobs[i] && !late) {
        Range range{1, 0};
        if (!again.empty()) {
          range = again.front();
          again.pop_front();
        } else if (next <= options.last) {
          range = {next, std::min(options.last, next + kBatch - 1)};
          next = range.last + 1;
        }
        if (range.first <= range.last) jobs[i].emplace(begin_job(range, static_cast<int>(i)));
      }
      if (!jobs[i]) continue;
      sources.push_back({jobs[i]->worker.fd(), POLLIN, 0});
      which.push_back(i);
    }
    if (sources.empty()) break;
    ::poll(sources.data(), sources.size(), 500);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      std::optional<Job>& job = jobs[which[k]];
      job->worker.end_silence();
      if (sources[k].revents == 0) continue;
      const bool open = job->worker.read([&](const std::string& line) {
        if (!line.starts_with("done ")) return read_line(line, job->under_way);
        std::from_chars(line.data() + 5, line.data() + line.size(), job->under_way.seed);
        job->left.first = job->under_way.seed + 1;
        take(job->under_way);
        job->under_way = {};
      });
      if (open) continue;
      if (auto wrong = job->worker.finish()) {
        SeedResult result;
        result.seed = job->left.first;
        result.features = features_of(make_case(result.seed, has_fault(result.seed, options)));
        result.checked.end = "ended by the system";
        result.checked.finding = wrong;
        take(result);
        if (job->left.first < job->left.last) again.push_back({job->left.first + 1, job->left.last});
      }
      job.reset();
    }
  }
}

}  // namespace kadr::storm
