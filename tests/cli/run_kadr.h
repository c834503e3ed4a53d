#pragma once
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Runs the built program as a user does: own process, own folder, own environment.
namespace kadr::test {

/// Output and exit code of a finished program.
struct Finished {
  int code = -1;       ///< exit code; -1 if a signal ended it
  int signal = 0;      ///< number of that signal
  std::string out;     ///< standard output
  std::string err;     ///< standard error
  double peak_MB = 0;  ///< most memory that it had at once (not less than this process has)
};

struct Launch {
  std::string program;  ///< path; empty: the build folder's kadr
  std::vector<std::string> arguments;
  std::string folder = ".";
  std::string input;                     ///< standard input
  std::vector<std::string> environment;  ///< "NAME=value", besides PATH
  std::int64_t file_size_limit = -1;     ///< bytes (ulimit -f); -1: none
  std::string stdout_path;               ///< standard output goes there instead of `out`
  bool terminal = false;                 ///< standard output and error are one terminal (both in `out`)
  bool terminal_input = false;           ///< with `terminal`: `input` is typed there
  /// Called about every millisecond while the program runs; may send it signals.
  std::function<void(pid_t)> watch;
};

/// True where the system has no pseudo-terminals (a bare root without /dev/pts); then the case is marked as skipped.
bool lacks_terminals();

/// Starts build folder's kadr and waits for its end, at most 60 s (then it is killed).
Finished run_kadr(const Launch& launch);
/// The same for the plain case.
Finished call(std::vector<std::string> arguments, const std::string& folder = ".",
              const std::string& input = {});

/// A command line of bash, with the build folder's kadr in PATH.
Finished shell(const std::string& command, const std::string& folder = ".");
/// True if PATH has such a program; else the case is marked as skipped, saying why.
bool has_program(const std::string& name);

/// A new empty folder, removed at the end.
class Scratch {
 public:
  Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();
  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  /// Writes a file and returns its name (without the folder).
  std::string write(const std::string& name, const std::string& text) const;
  bool has(const std::string& name) const;
  void remove(const std::string& name) const;
  std::string read(const std::string& name) const;

 private:
  std::string path_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Compares with tests/golden/cli/NAME below its first line; KADR_REGENERATE=1 rewrites the file instead.
void check_golden(const std::string& name, const std::string& text);

/// KADR_SEED and KADR_COUNT, or what is given here.
std::uint64_t seed_or(std::uint64_t seed);
int count_or(int count);

}  // namespace kadr::test
