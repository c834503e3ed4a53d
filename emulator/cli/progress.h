#pragma once
#include <chrono>
#include <cstdint>
#include <string>

#include "emulator/cli/arguments.h"

namespace kadr::cli {

/// Progress of a run on standard error. On a terminal one line, ten times a second after the first 0.3 s,
/// erased at the end; elsewhere a plain line every 10 s. The only place besides the summary's last line with
/// wall-clock figures.
class Progress {
 public:
  Progress(const OutputOptions& options, std::uint32_t lines);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { erase(); }
  /// @param done  part of the path length done, 0..1
  void update(double done, std::uint32_t line, double sim_s);
  void erase();
  double wall_s() const;

 private:
  enum class Kind : std::uint8_t { none, bar, plain };
  Kind kind_;
  std::uint32_t lines_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double next_s_;
  bool drawn_ = false;
};

/// "run  ███████░░░░░  58 %  line 701/1190  12.4 s of machine  41x real time  ETA 0:03"
std::string progress_bar(double done, std::uint32_t line, std::uint32_t lines, double sim_s, double wall_s);
/// "kadr: run 58 % line 701/1190 sim 12.4 s"
std::string progress_line(double done, std::uint32_t line, std::uint32_t lines, double sim_s);

}  // namespace kadr::cli
