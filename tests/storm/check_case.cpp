#include "tests/storm/check_case.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <ctime>
#include <exception>
#include <filesystem>

#include "machine/base/require.h"
#include "tests/storm/draw.h"
#include "tests/storm/world.h"

namespace kadr::storm {
namespace {

// far above what a case takes, far below what a user would call a hang
constexpr double kMost_s = 4, kMostPerTick_s = 1e-3;
constexpr long kMostMemory_kB = 400'000;

double cpu_s() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class CaseCheck {
 public:
  CaseCheck(const StormCase& storm_case, std::uint64_t seed, const CheckOptions& options)
      : case_(storm_case), seed_(seed), options_(options), folder_(options.scratch + "/case") {}

  Checked check() {
    std::filesystem::remove_all(options_.scratch);
    write_case(case_, folder_);
    const double begin_s = cpu_s();
    look();
    out_.cpu_s = cpu_s() - begin_s;
    const double allowed_s = kMost_s + kMostPerTick_s * static_cast<double>(out_.ticks);
    if (out_.cpu_s > allowed_s)
      tell(Finding{Invariant::time_bounded,
                   fmt::format("{:.3g} s of processor time for {} control ticks, allowed {:.3g} s",
                               out_.cpu_s, out_.ticks, allowed_s)});
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    if (usage.ru_maxrss > kMostMemory_kB)
      tell(Finding{Invariant::memory_bounded, fmt::format("{} MB of memory", usage.ru_maxrss / 1000)});
    return std::move(out_);
  }

 private:
  /// Keeps the first finding. @return true if there is one
  bool tell(Verdict verdict) {
    if (!out_.finding && verdict) out_.finding = std::move(verdict);
    return out_.finding.has_value();
  }
  void met(const char* what) { ++out_.met[what]; }

  void look() {
    try {
      in_process();
    } catch (const BrokenPromise& e) {
      tell(Finding{Invariant::no_broken_promise, e.what()});
    } catch (const std::exception& e) {
      tell(Finding{Invariant::no_broken_promise, fmt::format("an exception: {}", e.what())});
    }
    if (!out_.finding && case_.has(kFaultFile) && !options_.program.empty()) {
      met("world");
      const bool one_order = !prepared_ || prepared_->diagnostics.list().size() <= 1;
      tell(check_world(case_, {folder_, options_.scratch + "/world", options_.program, options_.failing_calls,
                               run_ && one_order ? run_->log_path : std::string(),
                               prepared_ ? prepared_->until_s : machine::kInfinity}));
    }
  }

  void in_process() {
    prepared_ = prepare_case(folder_, kScenarioFile);
    if (!prepared_->job) {
      out_.end = "refused: " + prepared_->refusal;
      return;
    }
    if (options_.planted != Planted::nothing)
      if (const auto planted = check_planted(*prepared_)) {
        if (options_.planted == Planted::crash) std::raise(SIGSEGV);
        while (options_.planted == Planted::hang) std::atomic_signal_fence(std::memory_order_seq_cst);
        tell(planted);
        return;
      }
    if (tell(check_verify(*prepared_))) return;
    run_ = run_case(*prepared_, options_.scratch + "/a.lcmlog", 1);
    out_.end = std::string(run_->summary.outcome.text());
    out_.ticks = run_->summary.control_ticks.value;
    if (tell(check_end(*prepared_, *run_)) || tell(check_log(*prepared_, *run_)) || tell(check_diff(*run_)) ||
        tell(check_threads(*prepared_, *run_, options_.scratch)) ||
        tell(check_replay_of_pulses(*prepared_, *run_)))
      return;
    if (prepared_->given.most_override && tell(other_timeline())) return;
    if (run_->whole() && prepared_->given.most_override) met("live");
    if (tell(check_live(*prepared_, *run_, seed_))) return;
    std::optional<double> apart_um;
    if (tell(check_integrators(*prepared_, *run_, apart_um))) return;
    if (apart_um) met(*apart_um <= 1e-6 ? "integrators, within 1e-6 um" : "integrators, within 1e-5 um");
    if (mixed(seed_ + 1) % 3 == 0) {
      met("replay of inputs");
      tell(check_replay_of_inputs(case_, *run_, options_.scratch));
    }
  }

  Verdict other_timeline() {
    StormCase without = case_;
    if (!case_.has(kOtherFile)) {
      // nobody asks for anything: the scenario up to its first step
      const std::string& text = case_.files.at(kScenarioFile);
      write_file(folder_ + "/" + kOtherFile, without_steps(text));
    }
    const auto other = prepare_case(folder_, kOtherFile);
    if (!case_.has(kOtherFile)) std::filesystem::remove(folder_ + "/" + kOtherFile);
    if (!other->job) {
      // a step may lie behind the path's end
      if (case_.has(kOtherFile)) return {};
      return Finding{Invariant::same_steps, "refused without a timeline: " + other->refusal};
    }
    const FinishedRun run = run_case(*other, options_.scratch + "/other.lcmlog", 1);
    if (run.whole() && run_->whole()) met("two timelines");
    if (auto wrong = check_end(*other, run)) return wrong;
    return check_same_steps(*run_, run);
  }

  static std::string without_steps(const std::string& text) {
    std::string kept, part;
    bool input = false, step = false;
    const auto take = [&] {
      if (!step || input) kept += part;
      part.clear();
      input = step = false;
    };
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
      const std::string line = text.substr(at, end - at + 1);
      if (line.starts_with("[")) {
        take();
        step = line.starts_with("[[step]]");
      }
      if (line.starts_with("input") || line.starts_with("analog_input")) input = true;
      part += line;
      at = end + 1;
    }
    take();
    return kept;
  }

  const StormCase& case_;
  const std::uint64_t seed_;
  const CheckOptions& options_;
  const std::string folder_;
  Checked out_;
  std::unique_ptr<PreparedCase> prepared_;
  std::optional<FinishedRun> run_;
};

}  // namespace

Checked check_case(const StormCase& storm_case, std::uint64_t seed, const CheckOptions& options) {
  return CaseCheck(storm_case, seed, options).check();
}

}  // namespace kadr::storm
