// The storm: random machines, programs, timelines and faults of the world, one case a seed, and invariants that hold of
// all of them. tools/storm builds and calls it; docs/HACKING.md tells what it is for.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/storm/report.h"
#include "tests/storm/shrink.h"

namespace {

using namespace kadr::storm;
namespace fs = std::filesystem;

constexpr std::string_view kUsage =
    "usage: storm --seeds A..B [--jobs N] [--minutes M] [--findings DIR] [--world PER_MILLE]\n"
    "       storm --replay FOLDER ...   cases of folders, or of the folders in them\n"
    "       storm --show SEED DIR       writes the case of a seed\n"
    "       storm --self-test           plants defects and demands that they are found and shrunk\n"
    "options: --program KADR --failing-calls LIBRARY (what the world does, does it to that kadr), "
    "--shrink-minutes M\n";

/// Of the first cases. A change of what is drawn changes it; a compiler or a machine does not.
constexpr std::uint64_t kHashedSeeds = 500, kCases = 0x07fa5e3cf18808a3;

struct Options {
  StormOptions storm;
  std::string findings = "storm-findings";
  double shrink_minutes = 3;
  std::vector<std::string> replay;
  std::string show;
  std::uint64_t shown_seed = 0;
  bool self_test = false;
};

[[noreturn]] void usage() {
  fmt::print(stderr, "{}", kUsage);
  std::exit(2);
}

template <class T>
T number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) usage();
  return value;
}

Options read_options(int argc, char** argv) {
  Options options;
  options.storm.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  int at = 1;
  const auto next = [&]() -> std::string_view {
    if (at >= argc) usage();
    return argv[at++];
  };
  while (at < argc) {
    const std::string_view option = next();
    if (option == "--seeds") {
      const std::string_view range = next();
      const auto dots = range.find("..");
      if (dots == range.npos) usage();
      options.storm.first = number<std::uint64_t>(range.substr(0, dots));
      options.storm.last = number<std::uint64_t>(range.substr(dots + 2));
    } else if (option == "--jobs") {
      options.storm.jobs = number<int>(next());
    } else if (option == "--minutes") {
      options.storm.minutes = number<double>(next());
    } else if (option == "--shrink-minutes") {
      options.shrink_minutes = number<double>(next());
    } else if (option == "--world") {
      options.storm.world_per_mille = number<int>(next());
    } else if (option == "--findings") {
      options.findings = next();
    } else if (option == "--program") {
      options.storm.check.program = fs::absolute(next()).string();
    } else if (option == "--failing-calls") {
      options.storm.check.failing_calls = fs::absolute(next()).string();
    } else if (option == "--show") {
      options.shown_seed = number<std::uint64_t>(next());
      options.show = next();
    } else if (option == "--self-test") {
      options.self_test = true;
    } else if (option == "--replay") {
      while (at < argc) options.replay.emplace_back(next());
      if (options.replay.empty()) usage();
    } else {
      usage();
    }
  }
  return options;
}

/// A folder in memory where the system has one; removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const char* set = std::getenv("TMPDIR");
    std::string base = set ? set : fs::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
    std::string pattern = base + "/kadr_storm_XXXXXX";
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no folder in " + base);
    path_ = pattern;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string text_of(const Finding& finding) {
  return fmt::format("{}: {}", kInvariants.word(finding.invariant), finding.text);
}

/// Shrinks the case of a finding and writes it into a folder of its own.
void keep(std::uint64_t seed, const Finding& finding, const Options& options, const std::string& scratch) {
  CheckOptions check = options.storm.check;
  check.scratch = scratch + "/shrink";
  const StormCase whole = make_case(seed, has_fault(seed, options.storm));
  const int tries = whole.has(kFaultFile) ? 3 : 1;
  StormCase small = shrunk(whole, finding.invariant, seed, check, options.shrink_minutes, tries);
  small.files["README.md"] =
      fmt::format("# Seed {}\n\n{}: {}.\n\n{}\n", seed, kInvariants.word(finding.invariant),
                  kInvariants.sentence(finding.invariant), finding.text);
  const std::string folder = fmt::format("{}/{}", options.findings, seed);
  fs::remove_all(folder);
  write_case(small, folder);
  fmt::print("finding: seed {}, {}\n  {} lines in {}\n", seed, text_of(finding), small.lines(), folder);
  std::fflush(stdout);
}

int run_storm(const Options& options, const std::string& scratch) {
  using Clock = std::chrono::steady_clock;
  Report report;
  std::uint64_t findings = 0;
  StormOptions storm_options = options.storm;
  storm_options.check.scratch = scratch;
  const auto begin = Clock::now();
  auto told = begin;
  std::vector<std::pair<std::uint64_t, Finding>> found;
  storm(storm_options, [&](const SeedResult& result) {
    report.add(result);
    if (result.checked.finding) {
      ++findings;
      found.emplace_back(result.seed, *result.checked.finding);
      fmt::print("seed {}: {}\n", result.seed, text_of(*result.checked.finding));
      std::fflush(stdout);
    }
    if (Clock::now() - told < std::chrono::seconds(20)) return;
    told = Clock::now();
    fmt::print(stderr, "{} seeds, {} findings, {:.0f} s\n", report.seeds(), findings,
               std::chrono::duration<double>(told - begin).count());
  });
  // of each invariant a few are shrunk: they are mostly one fault
  constexpr int kShrunkOfEach = 6;
  std::map<Invariant, int> shrunk_of;
  for (const auto& [seed, finding] : found)
    if (++shrunk_of[finding.invariant] <= kShrunkOfEach) keep(seed, finding, options, scratch);
  fmt::print("{}{} seeds, {} findings\n", report.text(), report.seeds(), findings);
  return findings == 0 ? 0 : 1;
}

std::vector<std::string> cases_under(const std::vector<std::string>& paths) {
  std::vector<std::string> folders;
  for (const std::string& path : paths) {
    if (fs::exists(fs::path(path) / kScenarioFile)) {
      folders.push_back(path);
      continue;
    }
    for (const auto& entry : fs::directory_iterator(path))
      if (fs::exists(entry.path() / kScenarioFile)) folders.push_back(entry.path().string());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

int replay(const Options& options, const std::string& scratch) {
  CheckOptions check = options.storm.check;
  check.scratch = scratch + "/replay";
  int findings = 0;
  const std::vector<std::string> folders = cases_under(options.replay);
  for (const std::string& folder : folders) {
    Verdict finding;
    std::string end;
    // another number chooses other checks of those that not every seed has
    for (std::uint64_t seed = 0; seed < 3 && !finding; ++seed) {
      const Checked checked = isolated_check(read_case(folder), seed, check);
      finding = checked.finding;
      end = checked.end;
    }
    fmt::print("{} {}: {}\n", finding ? "FAILED" : "passed", folder, finding ? text_of(*finding) : end);
    if (finding) ++findings;
  }
  fmt::print("{} cases, {} findings\n", folders.size(), findings);
  return findings == 0 && !folders.empty() ? 0 : 1;
}

/// Seeds until a planted defect is met.
std::uint64_t first_with(const CheckOptions& check, Invariant invariant) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Checked checked = isolated_check(make_case(seed, false), seed, check);
    if (checked.finding && checked.finding->invariant == invariant) return seed;
  }
  return 0;
}

int self_test(const Options& options, const std::string& scratch) {
  CheckOptions check = options.storm.check;
  check.scratch = scratch + "/self";
  check.most_cpu_s = 2;
  int wrong = 0;
  const auto demand = [&](bool kept, const std::string& what) {
    fmt::print("{}  {}\n", kept ? "passed" : "FAILED", what);
    if (!kept) ++wrong;
  };
  check.planted = Planted::arc;
  const std::uint64_t seed = first_with(check, Invariant::planted);
  demand(seed != 0, "a planted defect is found");
  if (seed == 0) return 1;
  const StormCase whole = make_case(seed, false);
  const StormCase small = shrunk(whole, Invariant::planted, seed, check, options.shrink_minutes);
  const std::string program = small.text(kProgramFile);
  fmt::print("{}", program);
  demand(std::count(program.begin(), program.end(), '\n') <= 3, "its program shrinks to at most 3 lines");
  demand(2 * small.lines() <= whole.lines(),
         fmt::format("its case of {} lines shrinks to {}, at most half", whole.lines(), small.lines()));
  const auto is = [&](Planted planted, Invariant invariant) {
    check.planted = planted;
    const Checked checked = isolated_check(small, seed, check);
    return checked.finding && checked.finding->invariant == invariant;
  };
  demand(is(Planted::arc, Invariant::planted), "what is left shows the defect");
  demand(is(Planted::crash, Invariant::no_crash), "a crash is a finding, and the storm goes on");
  demand(is(Planted::hang, Invariant::time_bounded), "a hang is a finding, and the storm goes on");
  const std::uint64_t cases = hash_of_cases(kHashedSeeds);
  demand(cases == kCases, fmt::format("seeds are the cases that they are everywhere ({:016x})", cases));
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = read_options(argc, argv);
    const ScratchFolder scratch;
    if (options.self_test) return self_test(options, scratch.path());
    if (!options.replay.empty()) return replay(options, scratch.path());
    if (!options.show.empty()) {
      write_case(make_case(options.shown_seed, has_fault(options.shown_seed, options.storm)), options.show);
      return 0;
    }
    if (options.storm.last < options.storm.first) usage();
    return run_storm(options, scratch.path());
  } catch (const std::exception& e) {
    fmt::print(stderr, "storm: {}\n", e.what());
    return 2;
  }
}
