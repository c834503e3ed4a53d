#include "tests/storm/world.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include "emulator/log/log_info.h"

namespace kadr::storm {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::array kAllowedCodes{0, 1, 2, 3, 130, 143};
constexpr auto kLongest = std::chrono::seconds(60);
constexpr const char* kOutput = "out.lcmlog";

/// What is different about one run of kadr.
struct Disturbance {
  std::vector<std::string> environment;
  std::int64_t file_bytes = -1;  ///< bound of files; -1: none
  int closed = 0;                ///< descriptors, a bit each
  int signal = 0;                ///< sent after `after_s`
  double after_s = 0;
};

struct Ended {
  int code = -1, signal = 0;
  double wall_s = 0;
  bool hung = false;
};

class Kadr {
 public:
  Kadr(const WorldOptions& options, const Disturbance& disturbance)
      : begin_(Clock::now()), disturbance_(disturbance) {
    std::vector<std::string> words{options.program, "run", "-s", options.folder, "-o", kOutput, "-q"};
    if (options.until_s != machine::kInfinity) {
      words.push_back("--until");
      words.push_back(fmt::format("{}", options.until_s));
    }
    pid_ = ::fork();
    if (pid_ == 0) become(options, words);
  }

  bool running() {
    if (ended_ || pid_ < 0) return false;
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      finish(status);
      return false;
    }
    const auto now = Clock::now();
    const std::chrono::duration<double> so_far = now - begin_;
    if (disturbance_.signal != 0 && so_far.count() >= disturbance_.after_s) {
      ::kill(pid_, disturbance_.signal);
      disturbance_.signal = 0;
    }
    if (now - begin_ > kLongest) {
      end_.hung = true;
      ::kill(pid_, SIGKILL);
    }
    return true;
  }

  Ended wait(const std::function<void()>& meanwhile = {}) {
    while (running()) {
      if (meanwhile) meanwhile();
      ::usleep(100);
    }
    return end_;
  }

 private:
  [[noreturn]] void become(const WorldOptions& options, const std::vector<std::string>& words) const {
    if (::chdir(options.scratch.c_str()) != 0) ::_exit(125);
    const int nothing = ::open("/dev/null", O_RDWR);
    const int errors = ::open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(nothing, 0);
    ::dup2(nothing, 1);
    ::dup2(errors, 2);
    for (int fd = 3; fd < 64; ++fd) ::close(fd);
    for (int fd = 0; fd < 3; ++fd)
      if (disturbance_.closed >> fd & 1) ::close(fd);
    std::signal(SIGXFSZ, SIG_DFL);
    if (disturbance_.file_bytes >= 0) {
      const auto bytes = static_cast<rlim_t>(disturbance_.file_bytes);
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    const auto pointers = [](const std::vector<std::string>& texts) {
      std::vector<char*> list;
      for (const std::string& text : texts) list.push_back(const_cast<char*>(text.c_str()));
      list.push_back(nullptr);
      return list;
    };
    ::execve(options.program.c_str(), pointers(words).data(), pointers(disturbance_.environment).data());
    ::_exit(126);
  }
  void finish(int status) {
    ended_ = true;
    end_.wall_s = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (WIFEXITED(status)) end_.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
  }

  Clock::time_point begin_;
  Disturbance disturbance_;
  pid_t pid_ = -1;
  bool ended_ = false;
  Ended end_;
};

class World {
 public:
  World(const StormCase& storm_case, const WorldOptions& options) : case_(storm_case), options_(options) {}

  Verdict check() {
    const Ended alone = run({});
    whole_ = output();
    if (auto wrong = look(alone, "alone", true)) return wrong;
    code_ = alone.code;
    wall_s_ = alone.wall_s;
    const bool runs = code_ == 0 || code_ == 3;
    if (runs != fs::exists(place(kOutput)))
      return Finding{Invariant::whole_or_nothing,
                     fmt::format("exit code {} and {} log", code_, runs ? "no" : "a")};
    if (runs && !options_.library_log.empty() && whole_ != read_file(options_.library_log))
      return Finding{Invariant::program_equal, "the program's log is not the library's"};
    return disturb();
  }

 private:
  std::string place(const std::string& name) const { return options_.scratch + "/" + name; }
  std::string output() const { return read_file(place(kOutput)); }

  Ended run(const Disturbance& disturbance, const std::function<void()>& meanwhile = {}) {
    fs::remove_all(options_.scratch);
    fs::create_directories(options_.scratch);
    return Kadr(options_, disturbance).wait(meanwhile);
  }

  Verdict disturb() {
    std::istringstream words(case_.text(kFaultFile));
    std::string fault, kind;
    double number = 0;
    words >> fault;
    Disturbance d;
    if (fault == "kill" || fault == "signal") {
      d.signal = SIGKILL;
      if (fault == "signal") words >> d.signal;
      words >> number;
      d.after_s = number * wall_s_;
      return look(run(d), fault, false, d.signal);
    }
    if (fault == "fsize") {
      words >> number;
      d.file_bytes = static_cast<std::int64_t>(number * static_cast<double>(whole_.size()));
      return look(run(d), fault, false);
    }
    if (fault == "closed") {
      words >> d.closed;
      return look(run(d), fault, false);
    }
    if (fault == "call" && !options_.failing_calls.empty()) {
      words >> kind >> number;
      d.environment = {"LD_PRELOAD=" + options_.failing_calls, "KADR_FAULT_CALL=" + kind,
                       fmt::format("KADR_FAULT_AT={}", number), "KADR_FAULT_MARK=" + place("mark")};
      return look(run(d), fault + " " + kind, false);
    }
    if (fault == "race") return race();
    if (fault == "change") {
      words >> kind;
      return change(kind == "cut");
    }
    return {};
  }

  Verdict race() {
    fs::remove_all(options_.scratch);
    fs::create_directories(options_.scratch);
    Kadr first(options_, {}), second(options_, {});
    const Ended a = first.wait(), b = second.wait();
    if (auto wrong = codes(a, "race")) return wrong;
    if (auto wrong = codes(b, "race")) return wrong;
    if (a.code != code_ && b.code != code_)
      return Finding{Invariant::exit_code,
                     fmt::format("of two runs with one -o none succeeds: {} and {}", a.code, b.code)};
    return files("race", true, false);
  }

  /// Another program with the same name comes and goes.
  Verdict change(bool cut) {
    const std::string program = options_.folder + "/" + kProgramFile, text = case_.text(kProgramFile);
    const std::string other = text + "(another)\n";
    std::string other_whole;
    if (!cut) {
      write_file(program, other);
      (void)run({});
      other_whole = output();
    }
    int turn = 0;
    const Ended ended = run({}, [&] {
      ++turn;
      if (cut) {
        write_file(program, turn % 2 ? text.substr(0, text.size() / 2) : text);
        return;
      }
      write_file(program + ".new", turn % 2 ? text : other);
      fs::rename(program + ".new", program);
    });
    fs::remove(program + ".new");
    write_file(program, text);
    if (auto wrong = codes(ended, "change")) return wrong;
    if (!fs::exists(place(kOutput))) return {};
    if (cut) {
      const auto info = log::log_info(place(kOutput));
      if (info && info->content_hash_agrees().value_or(false)) return {};
    } else if (output() == whole_ || output() == other_whole) {
      return {};
    }
    return Finding{Invariant::whole_or_nothing, "a log of a program that changes is neither's"};
  }

  Verdict codes(const Ended& ended, const std::string& fault, int sent = 0) const {
    if (ended.hung) return Finding{Invariant::time_bounded, fault + ": kadr does not end within a minute"};
    // before kadr takes signals, and after, they end it: to a shell that is the same code
    if (ended.signal != 0 && ended.signal == sent) return {};
    if (ended.signal != 0)
      return Finding{Invariant::exit_code, fmt::format("{}: kadr ends by signal {}", fault, ended.signal)};
    if (std::find(kAllowedCodes.begin(), kAllowedCodes.end(), ended.code) == kAllowedCodes.end())
      return Finding{Invariant::exit_code,
                     fmt::format("{}: kadr ends with {}: {}", fault, ended.code, last_error())};
    return {};
  }
  std::string last_error() const {
    std::string text = read_file(place("err.txt")).substr(0, 300);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }

  /// @param whole  the output must be there
  Verdict files(const std::string& fault, bool whole, bool alone) const {
    if (whole && !fs::exists(place(kOutput)) && (code_ == 0 || code_ == 3))
      return Finding{Invariant::program_equal, fault + ": success without a log"};
    if (!alone && fs::exists(place(kOutput)) && output() != whole_)
      return Finding{Invariant::whole_or_nothing,
                     fault + ": a log under its name is not that of an undisturbed run"};
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(options_.folder))
      names.insert(entry.path().filename().string());
    for (const auto& [name, text] : case_.files)
      if (names.erase(name) == 0 || read_file(options_.folder + "/" + name) != text)
        return Finding{Invariant::inputs_unchanged, fault + ": " + name + " is not as it was"};
    if (!names.empty()) return Finding{Invariant::inputs_unchanged, fault + ": a new file " + *names.begin()};
    return {};
  }

  Verdict look(const Ended& ended, const std::string& fault, bool alone, int sent = 0) const {
    if (auto wrong = codes(ended, fault, sent)) return wrong;
    return files(fault, !alone && (ended.code == 0 || ended.code == 3), alone);
  }

  const StormCase& case_;
  const WorldOptions& options_;
  std::string whole_;
  int code_ = 0;
  double wall_s_ = 0;
};

}  // namespace

Verdict check_world(const StormCase& storm_case, const WorldOptions& options) {
  return World(storm_case, options).check();
}

}  // namespace kadr::storm
