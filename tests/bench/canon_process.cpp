#include <benchmark/benchmark.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

/// `kadr canon` as a whole process, its trace to /dev/null: lines per second and peak memory on a program of
/// a million short moves with an arc each 50 lines (30 MB), on ten times that, and on one of loops and
/// parameters. Beside it, where it is installed, `rs274 -g` on the same files.
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLines = 1'000'000;

/// Files of this run, removed at its end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / fmt::format("kadr_bench_{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};
const Folder& folder() {
  static const Folder f;
  return f;
}

std::string short_moves(std::int64_t lines) {
  const std::string path = folder().file(fmt::format("short_{}.ngc", lines));
  if (fs::exists(path)) return path;
  std::ofstream out(path, std::ios::binary);
  std::uint64_t random = 42;
  const auto next = [&random](double scale) {
    random = random * 6364136223846793005ULL + 1442695040888963407ULL;
    return scale * static_cast<double>(random >> 40) / static_cast<double>(1 << 24);
  };
  out << "G21 G90 G94 G17\nF1200 G0 X0 Y0 Z0\n";
  double x = 0, y = 0;
  for (std::int64_t i = 2; i < lines - 1; ++i) {
    x += next(1.0) - 0.5;
    y += next(1.0) - 0.5;
    if (i % 50 == 0) {
      out << fmt::format("G3 I{:.4f} J{:.4f} F{:.0f}\n", 2.5, next(1.0), 600 + next(600));
    } else {
      out << fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f}\n", 100 + x, 100 + y, -next(2.0));
    }
  }
  out << "M2\n";
  return path;
}

/// 200,000 passes of a loop of four lines that compute, one that calls, and a subroutine of three.
constexpr std::int64_t kPasses = 200'000;
constexpr std::int64_t kLinesPerPass = 8;
std::string parametric() {
  const std::string path = folder().file("parametric.ngc");
  std::ofstream(path, std::ios::binary)
      << "F1200\nO100 sub\nG1 X[#1*COS[#2]] Y[#1*SIN[#2]]\nO100 endsub\n#5=0 #<radius>=10\n"
      << fmt::format("O1 while [#5 LT {}]\n", kPasses)
      << "#5=[#5+1]\n#6=[#5 MOD 360]\nO100 call [#<radius>] [#6]\nO1 endwhile\nM2\n";
  return path;
}

struct Usage {
  double wall_s = 0;
  double cpu_s = 0;
  double peak_mb = 0;
  bool good = false;
};

/// Runs a program in `folder()`, output thrown away.
Usage run(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::string place = folder().file("");
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, fd);
    if (::chdir(place.c_str()) == 0) ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || ::wait4(child, &status, 0, &used) != child) return {};
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          .cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime),
          .peak_mb = static_cast<double>(used.ru_maxrss) / 1024,
          .good = WIFEXITED(status) && WEXITSTATUS(status) == 0};
}

/// One program by kadr, then once by rs274: seconds of both, and how many times faster kadr is.
void compare(benchmark::State& state, const std::string& file, std::int64_t lines) {
  double wall_s = 0, cpu_s = 0, peak_mb = 0;
  for (auto _ : state) {
    const Usage used = run({KADR_PROGRAM, "canon", file});
    if (!used.good) state.SkipWithError("kadr canon failed");
    state.SetIterationTime(used.wall_s);
    wall_s += used.wall_s;
    cpu_s += used.cpu_s;
    peak_mb = std::max(peak_mb, used.peak_mb);
  }
  const double runs = static_cast<double>(state.iterations());
  const double n = static_cast<double>(lines);
  state.counters["lines_per_s"] = n * runs / wall_s;
  state.counters["lines_per_cpu_s"] = n * runs / cpu_s;
  state.counters["peak_mb"] = peak_mb;
  const Usage other = run({"rs274", "-g", file});
  if (!other.good) return;
  state.counters["rs274_lines_per_s"] = n / other.wall_s;
  state.counters["rs274_peak_mb"] = other.peak_mb;
  state.counters["times_rs274"] = other.wall_s * runs / wall_s;
}

void short_moves_30_mb(benchmark::State& state) { compare(state, short_moves(kLines), kLines); }
BENCHMARK(short_moves_30_mb)->UseManualTime()->Unit(benchmark::kMillisecond);

void short_moves_300_mb(benchmark::State& state) { compare(state, short_moves(10 * kLines), 10 * kLines); }
BENCHMARK(short_moves_300_mb)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(1);

void loops_and_parameters(benchmark::State& state) { compare(state, parametric(), kPasses * kLinesPerPass); }
BENCHMARK(loops_and_parameters)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
