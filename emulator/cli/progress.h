#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "emulator/cli/arguments.h"

namespace kadr::cli {

/// A progress line on standard error. On a terminal it is redrawn ten times a second
/// after the first 0.3 s and erased at the end; elsewhere a plain line every 10 s.
class ProgressLine {
 public:
  enum class Elsewhere : std::uint8_t { plain, nothing };  ///< not on a terminal, unless asked for
  ProgressLine(const OutputOptions& options, Elsewhere elsewhere);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { erase(); }
  /// Shows the line if it is due; its text is only made then.
  /// @param bar, plain  std::string(), for a terminal and else
  template <class Bar, class Plain>
  void update(const Bar& bar, const Plain& plain) {
    if (due()) show(kind_ == Kind::bar ? bar() : plain());
  }
  void erase();
  double wall_s() const;

 private:
  enum class Kind : std::uint8_t { none, bar, plain };
  bool due() const { return kind_ != Kind::none && wall_s() >= next_s_; }
  void show(const std::string& text);

  Kind kind_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double next_s_;
  bool drawn_ = false;
};

/// Progress of a run. The only place besides the summary's last line with wall-clock figures.
class Progress {
 public:
  Progress(const OutputOptions& options, std::uint32_t lines)
      : line_(options, ProgressLine::Elsewhere::plain), lines_(lines) {}
  /// @param done  part of the path length done, 0..1
  void update(double done, std::uint32_t line, double sim_s);
  void erase() { line_.erase(); }
  double wall_s() const { return line_.wall_s(); }

 private:
  ProgressLine line_;
  std::uint32_t lines_;
};

/// "run  ███████░░░░░  58 %  line 701/1190  12.4 s of machine  41x real time  ETA 0:03"
std::string progress_bar(double done, std::uint32_t line, std::uint32_t lines, double sim_s, double wall_s);
/// "tube  certified: pass 3  ███████░░░░░  58 %"; below 0: without the bar
std::string stage_bar(std::string_view stage, double done);
/// "kadr: run 58 % line 701/1190 sim 12.4 s"
std::string progress_line(double done, std::uint32_t line, std::uint32_t lines, double sim_s);

}  // namespace kadr::cli
